// ServerClock: the server's time as seen from here, from nothing but the ticks of snapshots and
// when they arrived, and the moment of it to draw.
//
// The estimate is the time of a snapshot that arrives now after its usual flight, so half a round
// trip behind the server's own. The moment to draw is further behind, by what losses and jitter
// call for (interpolation_delay.h). Both only ever move on, at the pace of real time give or take
// PacedClock::kMaxPaceChange, with these exceptions: either steps ahead when it is more than
// PacedClock::kLostS behind; the estimate stands still when it is as far ahead; and the moment to
// draw is slowed down further once it has run past the newest snapshot. Times in seconds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "client/core/interpolation_delay.h"
#include "client/core/paced_clock.h"

namespace fts::client {

class ServerClock {
  public:
    // The usual flight is the median of this many; two seconds at 60 Hz.
    static constexpr std::size_t kFlights = 128;
    // Past the newest snapshot the moment to draw runs slower by this share, and no further than
    // kMaxAheadS: where nothing is known there is nothing to show.
    static constexpr double kStarvedSlowDown = 0.5;
    static constexpr double kMaxAheadS = 0.1;
    // The next snapshot is overdue when it is later than the mean by more than this.
    static constexpr double kOverdueAfterS = 0.001;

    // A snapshot of the server's `server_s`, or a part of one, arrived at local `arrival_s`.
    // Arrivals ascend; what arrives may be older than what was there.
    void hear(double server_s, double arrival_s);
    // As above, and the snapshot is whole, and newer than every one before it.
    void observe(double server_s, double arrival_s);

    bool started() const { return newest_known_; }
    // Expects `started()`, as do the following.
    double estimate_s(double now_s);
    double draw_time_s(double now_s);
    // How far the moment last drawn is behind the estimate.
    double delay_s(double now_s);

    std::uint64_t delay_limited_count() const { return delay_.limited_count(); }
    // Times the moment to draw stepped ahead.
    std::uint64_t step_count() const { return draw_clock_.jump_count(); }

  private:
    double target_s(double now_s) const;

    std::array<double, kFlights> flights_s_{};
    std::size_t heard_ = 0;  // ever
    double flight_s_ = 0.0;  // the median
    bool newest_known_ = false;
    double newest_s_ = 0.0;
    double newest_arrival_s_ = 0.0;
    double drawn_at_s_ = -std::numeric_limits<double>::infinity();
    InterpolationDelay delay_;
    PacedClock estimate_clock_;
    PacedClock draw_clock_;
};

}  // namespace fts::client
