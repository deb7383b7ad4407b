// Where most of a crowd is along one axis: what a grid is fitted to, so that a few who are far away
// do not stretch it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fts::physics {

// Outliers beyond these do not stretch the grid; a uniform crowd lies wholly within the widened
// range.
inline constexpr double kCrowdLowQuantile = 0.05;
inline constexpr double kCrowdHighQuantile = 0.95;
inline constexpr double kCrowdWiden = 0.1;

// Reorders `values`, of which there must be some. q in [0, 1].
template <typename Scalar>
Scalar quantile(std::vector<Scalar>& values, double q) {
    const auto rank = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

template <typename Scalar>
struct CrowdRange {
    Scalar low = Scalar(0), high = Scalar(0);  // the quantiles
    Scalar margin = Scalar(0);                 // by which to widen them on either side
};

// Reorders `values`, of which there must be some.
template <typename Scalar>
CrowdRange<Scalar> crowd_range(std::vector<Scalar>& values) {
    const Scalar low = quantile(values, kCrowdLowQuantile);
    const Scalar high = quantile(values, kCrowdHighQuantile);
    return {low, high, static_cast<Scalar>(kCrowdWiden) * (high - low)};
}

}  // namespace fts::physics
