#include "common/game/input.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace fts::game {
namespace {

TEST(Input, EveryCommandThatCanBeSentThrustsAtMostFully) {
    for (int x = -128; x <= 127; ++x) {
        for (int y = -128; y <= 127; ++y) {
            const InputCommand command{.thrust_x = static_cast<std::int8_t>(x),
                                       .thrust_y = static_cast<std::int8_t>(y)};
            ASSERT_LE(thrust_of(command).norm(), 1.0 + 1e-15) << x << ", " << y;
        }
    }
}

TEST(Input, ADirectionSurvivesTheWayIntoACommandToHalfADegree) {
    constexpr double kHalfADegreeRad = 0.0088;
    for (int i = 0; i < 360; ++i) {
        const double angle_rad = i * 0.017453292519943295;
        const physics::Vec2d wanted(std::cos(angle_rad), std::sin(angle_rad));
        const physics::Vec2d got = thrust_of(command_toward(wanted));
        EXPECT_NEAR(std::atan2(wanted.x() * got.y() - wanted.y() * got.x(), wanted.dot(got)), 0.0,
                    kHalfADegreeRad)
            << i << " degrees";
        EXPECT_NEAR(got.norm(), 1.0, 0.01);
    }
}

TEST(Input, AWishThatIsTooLongKeepsItsDirection) {
    EXPECT_EQ(command_toward({3e9, 0.0}), command_toward({1.0, 0.0}));
    EXPECT_EQ(command_toward({-50.0, 50.0}), command_toward({-1.0, 1.0}));
}

TEST(Input, AWishThatIsNotANumberIsNoThrust) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    EXPECT_EQ(command_toward({nan, nan}), InputCommand{});
    EXPECT_EQ(command_toward({infinite, 0.0}), InputCommand{});
}

}  // namespace
}  // namespace fts::game
