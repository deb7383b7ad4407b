// PacedClock: a clock that follows a target which may step either way, and itself never goes back.
// It runs a little fast to catch up, slow to be caught up with, and jumps ahead only when
// hopelessly late.
#pragma once

namespace fts::client {

class PacedClock {
  public:
    // At most this share faster and slower than real time while following.
    static constexpr double kMaxSpeedUp = 0.1;
    static constexpr double kMaxSlowDown = 0.5;
    // Further behind than this: jump to the target. Further ahead: stand still.
    static constexpr double kLostS = 0.5;

    // The reading at local time `now_s`, seconds; a `now_s` earlier than the last one counts as
    // that.
    double follow(double target_s, double now_s);

  private:
    bool started_ = false;
    double reading_s_ = 0.0;
    double last_now_s_ = 0.0;
};

}  // namespace fts::client
