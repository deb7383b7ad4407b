// Every width of vector instructions moves discs, and sees who is fast or outside, as one number at
// a time does: to the last bit, whatever is left over beside whole vectors.
#include "common/physics/crowd_kernels.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr SimdLevel kWideLevels[] = {SimdLevel::kSse2, SimdLevel::kAvx2, SimdLevel::kAvx512};
constexpr std::size_t kMostDiscs = 40;

template <typename Scalar>
class CrowdKernelsOf : public testing::Test {};
using ScalarsOfKernels = testing::Types<double, float>;
TYPED_TEST_SUITE(CrowdKernelsOf, ScalarsOfKernels);

template <typename Scalar>
std::vector<Scalar> numbers_of(Dice& dice, std::size_t count) {
    std::vector<Scalar> numbers(count);
    for (Scalar& number : numbers) number = static_cast<Scalar>(dice.between(-9.0, 9.0));
    return numbers;
}

// The square of a speed; one of each crowd has just that.
template <typename Scalar>
constexpr Scalar kUsual = Scalar(49);

template <typename Scalar>
struct Moved {
    std::vector<Scalar> x_m, y_m;
    std::vector<std::uint32_t> faster;
    Scalar greatest_squared = Scalar(0);
    bool operator==(const Moved&) const = default;
};

template <typename Scalar>
Moved<Scalar> moved_at(SimdLevel level, std::size_t count, std::uint64_t seed) {
    Dice dice(seed);
    Moved<Scalar> moved = {numbers_of<Scalar>(dice, count), numbers_of<Scalar>(dice, count),
                           std::vector<std::uint32_t>(count)};
    auto vx = numbers_of<Scalar>(dice, count), vy = numbers_of<Scalar>(dice, count);
    if (count > 0) {
        vx.back() = Scalar(7);
        vy.back() = Scalar(0);
    }
    const Speeds<Scalar> speeds = crowd_kernels<Scalar>(level).advance(
        {moved.x_m.data(), moved.y_m.data(), vx.data(), vy.data(), count, Scalar(0.01),
         kUsual<Scalar>, moved.faster.data()});
    moved.faster.resize(speeds.faster);
    moved.greatest_squared = speeds.greatest_squared;
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (vx[i] * vx[i] + vy[i] * vy[i] > kUsual<Scalar>) expected.push_back(i);
    }
    EXPECT_EQ(moved.faster, expected);
    return moved;
}

TYPED_TEST(CrowdKernelsOf, move_every_disc_to_the_same_bits) {
    for (std::size_t count = 0; count <= kMostDiscs; ++count) {
        SCOPED_TRACE(count);
        const auto plain = moved_at<TypeParam>(SimdLevel::kPlain, count, count);
        EXPECT_EQ(plain.greatest_squared > TypeParam(0), count > 0);
        for (const SimdLevel level : kWideLevels) {
            if (!is_supported(level)) continue;
            ASSERT_EQ(moved_at<TypeParam>(level, count, count), plain)
                << "level " << static_cast<int>(level);
        }
    }
}

TYPED_TEST(CrowdKernelsOf, see_who_is_outside_where_the_ends_belong_to_the_range) {
    using Scalar = TypeParam;
    const Range2<Scalar> range = {Scalar(-5), Scalar(6), Scalar(-4), Scalar(7)};
    constexpr Scalar kNowhere = std::numeric_limits<Scalar>::quiet_NaN();
    const Scalar beyond = std::nextafter(Scalar(7), Scalar(8));
    const Scalar edges[] = {Scalar(-5), Scalar(6), Scalar(-4), Scalar(7), beyond, kNowhere};
    Dice dice(1);
    for (std::size_t count = 0; count <= kMostDiscs; ++count) {
        SCOPED_TRACE(count);
        auto x_m = numbers_of<Scalar>(dice, count), y_m = numbers_of<Scalar>(dice, count);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (i % 3 == 0) (i % 2 == 0 ? x_m : y_m)[i] = edges[dice.below(std::size(edges))];
            if (!(x_m[i] >= Scalar(-5) && x_m[i] <= Scalar(6) && y_m[i] >= Scalar(-4) &&
                  y_m[i] <= Scalar(7))) {
                expected.push_back(i);
            }
        }
        for (std::uint8_t level = 0; level <= static_cast<std::uint8_t>(SimdLevel::kAvx512);
             ++level) {
            if (!is_supported(SimdLevel{level})) continue;
            std::vector<std::uint32_t> numbers(count);
            numbers.resize(crowd_kernels<Scalar>(SimdLevel{level})
                               .outside(x_m.data(), y_m.data(), count, range, numbers.data()));
            ASSERT_EQ(numbers, expected) << "level " << static_cast<int>(level);
        }
    }
}

}  // namespace
}  // namespace fts::physics
