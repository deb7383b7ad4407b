// PacedClock: a clock that follows a target which may step either way, and itself never goes back.
// It runs a little fast to catch up, a little slow to be caught up with, and jumps ahead only when
// hopelessly late.
#pragma once

#include <cstdint>

namespace fts::client {

class PacedClock {
  public:
    // Faster or slower than real time by at most this share while following.
    static constexpr double kMaxPaceChange = 0.08;
    // Further behind than this: jump to the target.
    static constexpr double kLostS = 0.25;

    // The reading at local time `now_s`, seconds; a `now_s` earlier than the last one counts as
    // that. It may be held back more than usual: `max_slow_down`, up to 1, which is standing still.
    double follow(double target_s, double now_s, double max_slow_down = kMaxPaceChange);

    double reading_s() const { return reading_s_; }
    bool started() const { return started_; }
    // Times it jumped ahead.
    std::uint64_t jump_count() const { return jump_count_; }

  private:
    bool started_ = false;
    double reading_s_ = 0.0;
    double last_now_s_ = 0.0;
    std::uint64_t jump_count_ = 0;
};

}  // namespace fts::client
