#include "common/physics/exponential.h"

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace fts::physics {
namespace {

constexpr double kVanishes = 746.0;  // exp(-x) rounds to zero from here on
// ln(2) in two parts, so that small multiples of the first are exact (Cody and Waite).
constexpr double kLn2High = 6.93147180369123816490e-01;
constexpr double kLn2Low = 1.90821492927058770002e-10;

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

// 2/3, 2/5, ... 2/35
constexpr std::array<double, 17> kAreaTangentTerms = [] {
    std::array<double, 17> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = 2.0 / static_cast<double>(2 * i + 3);
    }
    return table;
}();

// -log(1 - lost) for `lost` up to a half: 2 artanh(t) with t = lost / (2 - lost), of a series whose
// rest is below 1e-18 of it. That all parts are positive, and the greatest is `lost` itself, keeps
// the last digit (the arrangement is that of fdlibm's log1p).
double span_of_small_decay(double lost) {
    const double t = lost / (2.0 - lost);
    const double square = t * t;
    double series = 0.0;
    for (std::size_t i = kAreaTangentTerms.size(); i-- > 0;) {
        series = kAreaTangentTerms[i] + series * square;
    }
    const double half_square = 0.5 * lost * lost;
    return lost + (half_square + t * (half_square + series * square));
}

}  // namespace

Decay decay(double x) {
    assert(x >= 0.0);
    if (x >= kVanishes) return {0.0, 1.0 / x};
    if (x == 0.0) return {1.0, 1.0};
    // -x = halvings * ln(2) + r, where r keeps all its digits.
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

double span_of_decay(double lost) {
    assert(lost >= 0.0 && lost <= 1.0);
    if (lost == 1.0) return std::numeric_limits<double>::infinity();
    if (lost <= 0.5) return span_of_small_decay(lost);
    // What is left, exactly: 2^-halvings from 1/2 up to 1, of which again something is lost.
    const double left = 1.0 - lost;
    const int halvings = 1022 - static_cast<int>(std::bit_cast<std::uint64_t>(left) >> 52);
    const double lost_of_rest = 1.0 - left * power_of_two(halvings);
    return halvings * kLn2High + (span_of_small_decay(lost_of_rest) + halvings * kLn2Low);
}

}  // namespace fts::physics
