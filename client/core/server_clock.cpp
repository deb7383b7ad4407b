#include "client/core/server_clock.h"

#include <algorithm>
#include <cassert>

namespace fts::client {

void ServerClock::observe(double server_s, double arrival_s) {
    offsets_s_[count_ % kWindow] = server_s - arrival_s;
    ++count_;
    const auto held = static_cast<std::ptrdiff_t>(std::min(count_, kWindow));
    offset_s_ = *std::max_element(offsets_s_.begin(), offsets_s_.begin() + held);
    // Drawing runs from the previous snapshot towards this one, so it had to be here by the time
    // the previous one was drawn.
    if (count_ > 1) delay_.observe(estimate_s(arrival_s) - last_server_s_, arrival_s);
    last_server_s_ = server_s;
}

double ServerClock::estimate_s(double now_s) const {
    assert(started());
    return now_s + offset_s_;
}

double ServerClock::draw_time_s(double now_s) {
    return draw_clock_.follow(estimate_s(now_s) - delay_s(), now_s);
}

}  // namespace fts::client
