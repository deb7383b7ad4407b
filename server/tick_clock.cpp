#include "server/tick_clock.h"

#include <algorithm>
#include <cmath>

#include "server/limits.h"

namespace fts::server {

int TickClock::due(double now_s) {
    if (!started_) {
        started_ = true;
        origin_s_ = now_s;
        return 0;
    }
    const double elapsed_ticks = std::floor((now_s - origin_s_) / tick_duration_s_);
    const double late = elapsed_ticks - static_cast<double>(ticks_done_);
    if (!(late >= 1.0)) return 0;
    late_ticks_ += static_cast<std::uint64_t>(std::min(late, double{kMaxCatchUpTicks})) - 1;
    if (late <= kMaxCatchUpTicks) {
        ticks_done_ += static_cast<std::int64_t>(late);
        return static_cast<int>(late);
    }
    const double dropped = late - kMaxCatchUpTicks;
    ++overruns_;
    dropped_ticks_ += static_cast<std::uint64_t>(dropped);
    ticks_done_ += static_cast<std::int64_t>(late);
    return kMaxCatchUpTicks;
}

double TickClock::next_tick_s() const {
    return origin_s_ + static_cast<double>(ticks_done_ + 1) * tick_duration_s_;
}

std::optional<std::uint64_t> TickClock::overrun_notice(double now_s) {
    if (dropped_ticks_ == dropped_noticed_) return std::nullopt;
    if (last_notice_s_ && now_s < *last_notice_s_ + kOverrunNoticeEveryS) return std::nullopt;
    last_notice_s_ = now_s;
    const std::uint64_t dropped = dropped_ticks_ - dropped_noticed_;
    dropped_noticed_ = dropped_ticks_;
    return dropped;
}

}  // namespace fts::server
