// Those about a body, and who of them may meet it: the same with vector instructions as one by one.
#include "common/physics/flight_filter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/time_of_impact.h"
#include "tests/physics/dice.h"

namespace fts::physics {
namespace {

template <typename Scalar>
std::vector<Flight<Scalar>> random_flights(std::size_t count, bool equal_radii, Dice& dice) {
    std::vector<Flight<Scalar>> flights(count);
    for (Flight<Scalar>& flight : flights) {
        flight.position_m = dice.in_box(3.0).cast<Scalar>();
        flight.velocity_mps = dice.in_box(2.0).cast<Scalar>();
        flight.since_s = dice.between(0.0, 0.2);
        flight.radius_m = static_cast<Scalar>(equal_radii ? 0.5 : dice.between(0.1, 0.6));
    }
    return flights;
}

std::uint32_t some_bits(Dice& dice) {
    return static_cast<std::uint32_t>(dice.below(std::uint64_t{1} << 32));
}

// A bound is close that is less than the time by this part.
constexpr double kCloseBound = 1e-3;

template <typename Scalar>
class FlightFilter : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(FlightFilter, Scalars);

template <typename Scalar>
void expect_same_bits(const Scalar* one, const Scalar* other, std::uint32_t k) {
    ASSERT_EQ(std::memcmp(one + k, other + k, sizeof(Scalar)), 0) << k;
}

template <typename Scalar>
void expect_same(const Neighbours<Scalar>& one, const Neighbours<Scalar>& other, bool equal_radii) {
    ASSERT_EQ(one.count, other.count);
    for (std::uint32_t k = 0; k < one.count; ++k) {
        ASSERT_EQ(one.body[k], other.body[k]);
        ASSERT_EQ(std::isnan(one.x_m[k]), std::isnan(other.x_m[k]));
        if (!std::isnan(one.x_m[k])) expect_same_bits(one.x_m, other.x_m, k);
        expect_same_bits(one.y_m, other.y_m, k);
        expect_same_bits(one.x_mps, other.x_mps, k);
        expect_same_bits(one.y_mps, other.y_mps, k);
        expect_same_bits(one.from_s, other.from_s, k);
        if (!equal_radii) expect_same_bits(one.radius_m, other.radius_m, k);
    }
}

template <typename Scalar>
double meeting_s(const Flight<Scalar>& self, const Neighbours<Scalar>& about, std::uint32_t k,
                 const Vec2<Scalar>& shift_m, Scalar its_radius_m, double now_s) {
    const Approach<Scalar> way(self, about, k, shift_m);
    const Scalar wait_s = time_until_contact<Scalar>({way.x_m, way.y_m}, {way.x_mps, way.y_mps},
                                                     self.radius_m + its_radius_m);
    return std::max(now_s, way.from_s + static_cast<double>(wait_s));
}

TYPED_TEST(FlightFilter, sees_the_same_on_every_level_and_leaves_nobody_out_who_meets) {
    using Scalar = TypeParam;
    constexpr std::uint64_t kSeed = 73;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t passed_in_all = 0, close_in_all = 0, met_in_all = 0;
    std::size_t timed_in_all = 0, close_bounds_in_all = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const bool equal_radii = trial % 2 == 0;
        const auto count = static_cast<std::uint32_t>(1 + dice.below(Neighbours<Scalar>::kMost));
        const auto flights = random_flights<Scalar>(count, equal_radii, dice);
        const auto body = static_cast<std::uint32_t>(dice.below(count));
        const auto partner = static_cast<std::uint32_t>(dice.below(2 * count));
        const Vec2<Scalar> shift(static_cast<Scalar>(trial % 3 == 0 ? 1.5 : 0.0), Scalar(0));
        const Flight<Scalar>& self = flights[body];
        std::vector<std::uint32_t> all(count + kGatherSpare, body);
        std::iota(all.begin(), all.begin() + count, 0U);
        Neighbours<Scalar> plain, about;
        const auto& plainly = flight_kernels<Scalar>(SimdLevel::kPlain, equal_radii);
        plainly.gather(flights.data(), all.data(), count, body, partner, self.since_s, plain);
        const double now_s = dice.between(0.0, 0.3);
        Ahead<Scalar> plain_ahead, ahead;
        const std::uint32_t which = trial % 5 == 0 ? some_bits(dice) : ~0U;
        plainly.look_ahead(plain, which, self, shift, now_s, plain_ahead);
        ASSERT_EQ(plain_ahead.any & ~which, 0U) << trial;
        const auto close =
            plainly.close(plain, self.position_m, self.radius_m, static_cast<Scalar>(1.25));
        for (const SimdLevel level : {SimdLevel::kSse2, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
            if (!is_supported(level)) continue;
            const auto& kernels = flight_kernels<Scalar>(level, equal_radii);
            kernels.gather(flights.data(), all.data(), count, body, partner, self.since_s, about);
            expect_same(about, plain, equal_radii);
            kernels.look_ahead(about, which, self, shift, now_s, ahead);
            ASSERT_EQ(ahead.any, plain_ahead.any) << trial;
            ASSERT_EQ(ahead.first & ~ahead.any, 0U) << trial;
            ASSERT_EQ(ahead.first == 0, ahead.any == 0) << trial;
            ASSERT_EQ(kernels.until(ahead, count, kNever<double>), ahead.any) << trial;
            for (std::uint32_t bits = ahead.any; bits != 0; bits &= bits - 1) {
                const auto k = static_cast<std::uint32_t>(std::countr_zero(bits));
                const double time_s = meeting_s(self, plain, k, shift, flights[k].radius_m, now_s);
                ASSERT_EQ(kernels.until(ahead, count, time_s) >> k & 1U, 1U) << trial;
                if (time_s == kNever<double> || level < SimdLevel::kAvx2) continue;
                ++timed_in_all;
                close_bounds_in_all += ahead.earliest_s[k] >= time_s - kCloseBound * time_s ? 1 : 0;
            }
            ASSERT_EQ(
                kernels.close(about, self.position_m, self.radius_m, static_cast<Scalar>(1.25)),
                close)
                << trial;
        }
        passed_in_all += static_cast<std::size_t>(std::popcount(plain_ahead.any));
        close_in_all += static_cast<std::size_t>(std::popcount(close));
        for (std::uint32_t k = 0; k < count; ++k) {
            if (k == body || k == partner) {
                ASSERT_EQ((plain_ahead.any | close) >> k & 1U, 0U);
                continue;
            }
            const double time_s = meeting_s(self, plain, k, shift, flights[k].radius_m, now_s);
            if (time_s == kNever<double> || (which >> k & 1U) == 0) continue;
            ++met_in_all;
            ASSERT_EQ(plain_ahead.any >> k & 1U, 1U) << trial;
        }
    }
    EXPECT_GT(met_in_all, 1000U);
    EXPECT_LT(passed_in_all, 2 * met_in_all);
    EXPECT_GT(close_in_all, 500U);
    if (std::is_same_v<Scalar, double> && is_supported(SimdLevel::kAvx2)) {
        EXPECT_GT(close_bounds_in_all, timed_in_all * 99 / 100);
    }
}

TYPED_TEST(FlightFilter, pairs_meet_at_the_same_time_to_the_last_bit_on_every_level) {
    using Scalar = TypeParam;
    constexpr std::uint64_t kSeed = 74;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t met = 0, missed = 0, at_once = 0, apart = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        auto flights = random_flights<Scalar>(24, trial % 2 == 0, dice);
        // At rest to each other, in one place, just touching.
        flights[1].velocity_mps = flights[0].velocity_mps;
        flights[3].position_m = flights[2].position_m;
        flights[3].since_s = flights[2].since_s;
        flights[5].since_s = flights[4].since_s;
        flights[5].position_m = flights[4].position_m +
                                Vec2<Scalar>(flights[4].radius_m + flights[5].radius_m, Scalar(0));
        std::uint32_t one[kMeetingsAtOnce], other[kMeetingsAtOnce];
        for (std::uint32_t k = 0; k < kMeetingsAtOnce; ++k) {
            one[k] = k < 3 ? 2 * k : static_cast<std::uint32_t>(dice.below(flights.size()));
            other[k] = k < 3 ? 2 * k + 1 : static_cast<std::uint32_t>(dice.below(flights.size()));
        }
        const double now_s = dice.between(0.2, 0.4);
        alignas(64) double expected_s[kMeetingsAtOnce], seen_s[kMeetingsAtOnce];
        const std::uint32_t near = flight_kernels<Scalar>(SimdLevel::kPlain, true)
                                       .meet(flights.data(), one, other, now_s, expected_s);
        for (const SimdLevel level : {SimdLevel::kSse2, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
            if (!is_supported(level)) continue;
            const auto& kernels = flight_kernels<Scalar>(level, trial % 2 == 0);
            ASSERT_EQ(kernels.meet(flights.data(), one, other, now_s, seen_s), near);
            for (std::uint32_t k = 0; k < kMeetingsAtOnce; ++k) {
                expect_same_bits(expected_s, seen_s, k);
            }
        }
        for (std::uint32_t k = 0; k < kMeetingsAtOnce; ++k) {
            const Approach<Scalar> way(flights[one[k]], flights[other[k]]);
            const Scalar wait_s =
                time_until_contact<Scalar>({way.x_m, way.y_m}, {way.x_mps, way.y_mps},
                                           flights[one[k]].radius_m + flights[other[k]].radius_m);
            const double time_s = std::max(now_s, way.from_s + static_cast<double>(wait_s));
            ASSERT_EQ(expected_s[k], time_s) << k;
            (time_s == kNever<double> ? missed : time_s == now_s ? at_once : met) += 1;
            apart += near >> k & 1U;
        }
    }
    for (const std::size_t some : {met, missed, at_once, apart}) EXPECT_GT(some, 1000U);
}

}  // namespace
}  // namespace fts::physics
