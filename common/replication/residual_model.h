// How whole numbers around zero are coded bit by bit, and what is believed of them before the first
// has come: a normal distribution of known spread, with a tail for what the spread does not know.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/replication/range_coder.h"

namespace fts::replication {

// A spread (standard deviation) as a class: variance_of(0), twice that, and so on.
using Doubt = std::uint8_t;
inline constexpr std::size_t kDoubts = 24;
inline constexpr double kLeastVariance = 1.0 / 64.0;
double variance_of(Doubt doubt);
// The class whose variance is the nearest at or below, within the classes there are.
Doubt doubt_of(double variance);

// Sign and magnitude: zero or not, the sign, how many bits, and of these the first adaptive, the
// others as they are (Elias's gamma code with learned parts). Any 32-bit value can be said.
struct NumberModel {
    static constexpr std::size_t kWidths = 14;  // wider ones share the last

    AdaptiveBit other_than_zero;
    AdaptiveBit negative;
    std::array<AdaptiveBit, kWidths> wider;       // than so many bits
    std::array<AdaptiveBit, kWidths> upper_half;  // of the numbers of one width

    static NumberModel of_spread(Doubt doubt);
    double chance_of_zero() const { return 1.0 - other_than_zero.chance() / 65536.0; }
};

namespace residual_model {

inline constexpr std::size_t kMaxBits = 32;

inline std::size_t slot(std::size_t width) {
    return width < NumberModel::kWidths ? width : NumberModel::kWidths - 1;
}

template <typename Coder>
std::uint32_t code_below_top(Coder& coder, NumberModel& model, std::uint32_t magnitude,
                             std::size_t width) {
    std::uint32_t value = 1;
    std::size_t left = width - 1;
    if (left > 0) {
        --left;
        const bool set = coder.bit(model.upper_half[slot(width)], (magnitude >> left & 1U) != 0);
        value = value << 1 | (set ? 1U : 0U);
    }
    while (left > 0) {
        const auto count = static_cast<std::uint32_t>(
            left < range_coder::kMaxRawBits ? left : range_coder::kMaxRawBits);
        left -= count;
        const std::uint32_t mask = (1U << count) - 1;
        value = value << count | coder.raw(magnitude >> left & mask, count);
    }
    return value;
}

// Above zero.
template <typename Coder>
std::uint32_t code_magnitude(Coder& coder, NumberModel& model, std::uint32_t magnitude) {
    const auto true_width = static_cast<std::size_t>(std::bit_width(magnitude));
    std::size_t width = 1;
    while (width < kMaxBits && coder.bit(model.wider[slot(width)], true_width > width)) ++width;
    return code_below_top(coder, model, magnitude, width);
}

}  // namespace residual_model

// A number that is known not to be zero.
template <typename Coder>
std::int32_t code_other_than_zero(Coder& coder, NumberModel& model, std::int32_t number) {
    const auto bits = static_cast<std::uint32_t>(number);
    const bool negative = coder.bit(model.negative, number < 0);
    const std::uint32_t magnitude =
        residual_model::code_magnitude(coder, model, number < 0 ? 0U - bits : bits);
    return static_cast<std::int32_t>(negative ? 0U - magnitude : magnitude);
}

template <typename Coder>
std::int32_t code_number(Coder& coder, NumberModel& model, std::int32_t number) {
    if (!coder.bit(model.other_than_zero, number != 0)) return 0;
    return code_other_than_zero(coder, model, number);
}

}  // namespace fts::replication
