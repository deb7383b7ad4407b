#include "client/core/interpolation_delay.h"

#include <algorithm>
#include <cmath>

namespace fts::client {

void InterpolationDelay::observe(double needed_s, double arrival_s) {
    const bool is_first = !measured_;
    const double elapsed_s = is_first ? 0.0 : std::max(0.0, arrival_s - last_arrival_s_);
    measured_ = true;
    last_arrival_s_ = arrival_s;
    double wanted_s = std::max(0.0, needed_s) + kDelayMarginS;
    if (wanted_s > kMaxDelayS) {
        ++limited_count_;
        wanted_s = kMaxDelayS;
    }
    if (is_first || wanted_s >= delay_s_) {
        delay_s_ = wanted_s;
    } else {
        delay_s_ += (wanted_s - delay_s_) * (1.0 - std::exp(-elapsed_s / kDelayFallS));
    }
}

}  // namespace fts::client
