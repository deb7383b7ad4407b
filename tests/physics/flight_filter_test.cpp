// The filter of those who may meet: the same with vector instructions as one by one.
#include "common/physics/flight_filter.h"

#include <algorithm>
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

template <typename Scalar>
class FlightFilter : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(FlightFilter, Scalars);

TYPED_TEST(FlightFilter, lets_the_same_pass_as_one_by_one_and_nobody_out_who_meets) {
    using Scalar = TypeParam;
    constexpr std::uint64_t kSeed = 73;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t passed_in_all = 0, close_in_all = 0, met_in_all = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const bool equal_radii = trial % 2 == 0;
        const auto count = static_cast<std::uint32_t>(1 + dice.below(14));
        const auto flights = random_flights<Scalar>(count, equal_radii, dice);
        const auto body = static_cast<std::uint32_t>(dice.below(count));
        const auto partner = static_cast<std::uint32_t>(dice.below(2 * count));
        const Vec2<Scalar> shift(static_cast<Scalar>(trial % 3 == 0 ? 1.5 : 0.0), Scalar(0));
        const Filter<Scalar> filter{flights.data(), flights[body], body,        partner,
                                    shift,          equal_radii,   Scalar(1.25)};
        std::vector<std::uint32_t> some(count + kFilterSpare), one_by_one;
        for (std::uint32_t k = 0; k < count; ++k) some[k] = k;
        one_by_one = some;
        const auto passed = filter(some.data(), some.data() + count);
        const auto expected = filter.one_by_one(one_by_one.data(), one_by_one.data() + count);
        const auto kept = static_cast<std::size_t>(passed.end - some.data());
        ASSERT_EQ(kept, static_cast<std::size_t>(expected.end - one_by_one.data())) << trial;
        for (std::size_t k = 0; k < kept; ++k) ASSERT_EQ(some[k], one_by_one[k]) << trial;
        ASSERT_EQ(passed.any_close, expected.any_close) << trial;
        passed_in_all += kept;
        close_in_all += passed.any_close ? 1 : 0;
        for (std::uint32_t other = 0; other < count; ++other) {
            if (other == body || other == partner) continue;
            const Approach<Scalar> way(flights[body], flights[other], shift);
            const Scalar reach_m = flights[body].radius_m + flights[other].radius_m;
            const Scalar wait_s =
                time_until_contact<Scalar>({way.x_m, way.y_m}, {way.x_mps, way.y_mps}, reach_m);
            if (wait_s == kNever<Scalar>) continue;
            ++met_in_all;
            ASSERT_NE(std::find(some.data(), passed.end, other), passed.end) << trial;
        }
    }
    EXPECT_GT(met_in_all, 1000U);
    EXPECT_LT(passed_in_all, 2 * met_in_all);
    EXPECT_GT(close_in_all, 500U);
}

}  // namespace
}  // namespace fts::physics
