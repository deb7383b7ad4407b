// Fixed steps out of passing time. Time is passed in, seconds of any monotonic clock.
//
// Overrun policy: ticks that come late are made up for, at most kMaxCatchUpTicks at once. Time lost
// beyond that is dropped (the game stands still for that long, then goes on at its normal pace; it
// never races to catch up), counted, and put into words at most every kOverrunNoticeEveryS seconds.
#pragma once

#include <cstdint>
#include <optional>

namespace fts::server {

class TickClock {
  public:
    explicit TickClock(double tick_duration_s) : tick_duration_s_(tick_duration_s) {}

    // How many ticks to run now, [0, kMaxCatchUpTicks]. The first call starts the clock. Time that
    // stands still or runs backwards makes no tick due.
    int due(double now_s);
    // When the next tick is due; what a loop sleeps until.
    double next_tick_s() const;

    std::uint64_t overruns() const { return overruns_; }  // calls of `due` that dropped ticks
    std::uint64_t dropped_ticks() const { return dropped_ticks_; }
    // Ticks made up for: run when the one after them was already due.
    std::uint64_t late_ticks() const { return late_ticks_; }

    // Ticks dropped since the last notice, when one is due.
    std::optional<std::uint64_t> overrun_notice(double now_s);

  private:
    double tick_duration_s_;
    bool started_ = false;
    double origin_s_ = 0.0;        // tick n is due at origin + n durations
    std::int64_t ticks_done_ = 0;  // since origin
    std::uint64_t overruns_ = 0;
    std::uint64_t dropped_ticks_ = 0;
    std::uint64_t late_ticks_ = 0;
    std::uint64_t dropped_noticed_ = 0;
    std::optional<double> last_notice_s_;
};

}  // namespace fts::server
