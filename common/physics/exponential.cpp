#include "common/physics/exponential.h"

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace fts::physics {
namespace {

constexpr double kVanishes = 746.0;  // exp(-x) rounds to zero from here on

// 1/3!, 1/4!, ... 1/15!
constexpr std::array<double, 13> kInverseFactorials = [] {
    std::array<double, 13> table{};
    double factorial = 2.0;
    for (std::size_t i = 0; i < table.size(); ++i) {
        factorial *= static_cast<double>(i + 3);
        table[i] = 1.0 / factorial;
    }
    return table;
}();

// exp(r) - 1 for |r| <= ln(2)/2: its series up to r^15/15!, whose rest is below 1e-20.
double exp_minus_one_near_zero(double r) {
    double tail = 0.0;
    for (std::size_t i = kInverseFactorials.size(); i-- > 0;) {
        tail = kInverseFactorials[i] + tail * r;
    }
    return r + r * r * (0.5 + r * tail);
}

// 2^exponent for normal results.
double power_of_two(int exponent) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

}  // namespace

Decay decay(double x) {
    assert(x >= 0.0);
    if (x >= kVanishes) return {0.0, 1.0 / x};
    if (x == 0.0) return {1.0, 1.0};
    // -x = halvings * ln(2) + r, with ln(2) in two parts so that r keeps all its digits (Cody and
    // Waite).
    constexpr double kLn2High = 6.93147180369123816490e-01;
    constexpr double kLn2Low = 1.90821492927058770002e-10;
    constexpr double kOverLn2 = 1.44269504088896338700e+00;
    const int halvings = static_cast<int>(x * kOverLn2 + 0.5);
    const double r = (halvings * kLn2High - x) + halvings * kLn2Low;
    const double grown = exp_minus_one_near_zero(r);
    // Two steps, since 2^-halvings alone may be below the normal range.
    const int first = halvings < 1000 ? halvings : 1000;
    const double scale = power_of_two(-first);
    const double rest = power_of_two(first - halvings);
    const double lost = halvings == 0 ? -grown : (1.0 - scale) - scale * grown;
    return {(1.0 + grown) * scale * rest, lost / x};
}

}  // namespace fts::physics
