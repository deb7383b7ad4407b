#include "client/core/server_clock.h"

#include <algorithm>
#include <cassert>

namespace fts::client {

void ServerClock::hear(double server_s, double arrival_s) {
    flights_s_[heard_ % kFlights] = arrival_s - server_s;
    ++heard_;
    std::array<double, kFlights> flights = flights_s_;
    const auto end = flights.begin() + static_cast<std::ptrdiff_t>(std::min(heard_, kFlights));
    const auto middle = flights.begin() + (end - flights.begin()) / 2;
    std::nth_element(flights.begin(), middle, end);
    flight_s_ = *middle;
}

void ServerClock::observe(double server_s, double arrival_s) {
    assert(!newest_known_ || server_s > newest_s_);
    hear(server_s, arrival_s);
    // Of those that arrive together only the first ends a wait; and one that came before the last
    // frame, but was found only now, came too late for that.
    if (newest_known_ && arrival_s > newest_arrival_s_) {
        delay_.observe(std::max(arrival_s, drawn_at_s_) - newest_s_, flight_s_, arrival_s);
    }
    newest_known_ = true;
    newest_s_ = server_s;
    newest_arrival_s_ = arrival_s;
}

double ServerClock::estimate_s(double now_s) {
    assert(started());
    const double target_s = now_s - flight_s_;
    const bool far_ahead =
        estimate_clock_.started() && estimate_clock_.reading_s() > target_s + PacedClock::kLostS;
    return estimate_clock_.follow(target_s, now_s, far_ahead ? 1.0 : PacedClock::kMaxPaceChange);
}

// While the next snapshot is overdue the moment to draw waits for it, as far as its pace allows:
// that makes up for part of a longer delay, and costs latency only when it is needed.
double ServerClock::target_s(double now_s) const {
    if (!delay_.measured()) return now_s - flight_s_ - kInitialDelayS;
    const double due_age_s = flight_s_ + delay_.mean_excess_s();
    const double overdue_s = now_s - newest_s_ - due_age_s - kOverdueAfterS;
    const double wait_s = std::clamp(overdue_s, 0.0, PacedClock::kLostS);
    return std::min(now_s - delay_.age_to_draw_s() - wait_s, newest_s_ + kMaxAheadS);
}

double ServerClock::draw_time_s(double now_s) {
    assert(started());
    const double ahead_s = draw_clock_.started() ? draw_clock_.reading_s() - newest_s_ : 0.0;
    const double slow_down = ahead_s <= 0.0          ? PacedClock::kMaxPaceChange
                             : ahead_s <= kMaxAheadS ? kStarvedSlowDown
                                                     : 1.0;
    drawn_at_s_ = now_s;
    return draw_clock_.follow(target_s(now_s), now_s, slow_down);
}

double ServerClock::delay_s(double now_s) {
    return estimate_s(now_s) - draw_clock_.reading_s();
}

}  // namespace fts::client
