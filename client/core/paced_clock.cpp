#include "client/core/paced_clock.h"

#include <algorithm>

namespace fts::client {

double PacedClock::follow(double target_s, double now_s, double max_slow_down) {
    if (!started_) {
        started_ = true;
        reading_s_ = target_s;
        last_now_s_ = now_s;
        return reading_s_;
    }
    const double elapsed_s = std::max(0.0, now_s - last_now_s_);
    last_now_s_ = std::max(last_now_s_, now_s);
    const double behind_s = target_s - (reading_s_ + elapsed_s);
    if (behind_s > kLostS) {
        reading_s_ = target_s;
        ++jump_count_;
    } else {
        reading_s_ += elapsed_s +
                      std::clamp(behind_s, -elapsed_s * max_slow_down, elapsed_s * kMaxPaceChange);
    }
    return reading_s_;
}

}  // namespace fts::client
