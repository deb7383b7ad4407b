#include "common/physics/world.h"

#include <gtest/gtest.h>

namespace fts::physics {
namespace {

TEST(World, equal_balls_exchange_their_velocities_head_on) {
    Scene scene;
    scene.bodies.push_back({Vec2d(-2, 0), Vec2d(3, 0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(2, 0), Vec2d(0, 0), 0.5, 1.0});
    World<double> world(scene);
    const StepReport report = world.step(2.0);
    EXPECT_EQ(report.events, 1U);
    EXPECT_DOUBLE_EQ(world.contacts()[0].time_s, 1.0);
    EXPECT_DOUBLE_EQ(world.body(world.ids()[0]).position_m.x(), 1.0);
    EXPECT_DOUBLE_EQ(world.body(world.ids()[1]).position_m.x(), 5.0);
}

}  // namespace
}  // namespace fts::physics
