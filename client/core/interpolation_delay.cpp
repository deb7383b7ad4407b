#include "client/core/interpolation_delay.h"

#include <algorithm>
#include <cmath>

namespace fts::client {

void InterpolationDelay::observe(double needed_s, double arrival_s) {
    const double elapsed_s = measured_ ? std::max(0.0, arrival_s - last_arrival_s_) : 0.0;
    measured_ = true;
    last_arrival_s_ = arrival_s;
    double wanted_s = std::max(0.0, needed_s) + kDelayMarginS;
    if (wanted_s > kMaxDelayS) {
        ++limited_count_;
        wanted_s = kMaxDelayS;
    }
    if (wanted_s >= delay_s_) {
        delay_s_ = wanted_s;
    } else {
        delay_s_ += (wanted_s - delay_s_) * (1.0 - std::exp(-elapsed_s / kDelayFallS));
    }
}

}  // namespace fts::client
