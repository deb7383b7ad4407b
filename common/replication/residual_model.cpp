#include "common/replication/residual_model.h"

#include <algorithm>
#include <cmath>

#include "common/physics/exponential.h"

namespace fts::replication {
namespace {

// The prior is as sure of itself as if it had seen so many numbers.
constexpr std::uint32_t kPriorWeight = 4;
constexpr double kLeastPrior = 0.3;
// Of what the spread does not know: this part of all numbers, so many times as far.
constexpr double kTail = 0.08;
constexpr double kTailReach = 5.0;

double normal_weight(double number, double variance) {
    return physics::decay(number * number / (2.0 * variance)).factor;
}

// Sums of a distribution of whole numbers: at zero, and of each width on one side.
struct Masses {
    double zero = 0.0;
    std::array<double, NumberModel::kWidths> of_width{}, upper_half_of_width{};
    double all_above_zero = 0.0;
};

void add_normal(Masses& masses, double variance, double share) {
    // A variance of round-off cannot be less, however sure a predictor is.
    const double smoothed = variance + 1.0 / 24.0;
    const auto reach = static_cast<std::uint32_t>(6.0 * std::sqrt(smoothed)) + 2;
    double sum = 1.0;
    for (std::uint32_t n = 1; n <= reach; ++n) sum += 2.0 * normal_weight(n, smoothed);
    masses.zero += share / sum;
    for (std::uint32_t n = 1; n <= reach; ++n) {
        const double mass = share * normal_weight(n, smoothed) / sum;
        const auto width = static_cast<std::size_t>(std::bit_width(n));
        const std::size_t slot = residual_model::slot(width);
        masses.of_width[slot] += mass;
        if (width > 1 && (n >> (width - 2) & 1U) != 0) masses.upper_half_of_width[slot] += mass;
        masses.all_above_zero += mass;
    }
}

// Within limits: what is off by more than its doubt is off by any amount.
AdaptiveBit prior(double part, double of) {
    const double chance = std::clamp(of > 1e-9 ? part / of : 0.5, kLeastPrior, 1.0 - kLeastPrior);
    return {static_cast<std::uint32_t>(chance * 65536.0), kPriorWeight};
}

}  // namespace

double variance_of(Doubt doubt) {
    return std::ldexp(kLeastVariance, doubt);
}

Doubt doubt_of(double variance) {
    if (!(variance > kLeastVariance)) return 0;
    const int doublings = std::ilogb(variance / kLeastVariance);
    const int last = static_cast<int>(kDoubts) - 1;
    return static_cast<Doubt>(doublings < last ? doublings : last);
}

NumberModel NumberModel::of_spread(Doubt doubt) {
    Masses masses;
    add_normal(masses, variance_of(doubt), 1.0 - kTail);
    add_normal(masses, kTailReach * kTailReach * variance_of(doubt), kTail);
    NumberModel model;
    model.other_than_zero = {static_cast<std::uint32_t>(65536.0 * (1.0 - masses.zero)),
                             kPriorWeight};
    model.negative = prior(0.5, 1.0);
    double left = masses.all_above_zero;
    for (std::size_t width = 1; width < kWidths; ++width) {
        const double wider = left - masses.of_width[width];
        model.wider[width] = prior(wider, left);
        model.upper_half[width] = prior(masses.upper_half_of_width[width], masses.of_width[width]);
        left = wider;
    }
    return model;
}

}  // namespace fts::replication
