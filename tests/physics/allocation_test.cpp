// A world that has warmed up asks for no more memory, so that a tick never waits for the allocator.
#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/allocation_count.h"
#include "tests/physics/crowds.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

TEST(Allocation, a_warm_world_asks_for_no_memory) {
    constexpr std::uint64_t kSeed = 51;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    World<double> world(random_gas({.balls = 30, .max_speed_mps = 20.0}, dice));
    for (const BodyId id : world.ids()) world.set_control(id, {dice.in_box(5.0), 0.1});
    for (int tick = 0; tick < 600; ++tick) world.step(1.0 / 60.0);
    const std::uint64_t hits = world.audit().ball_collisions;
    const std::size_t before = allocations();
    EXPECT_GT(before, 0U);
    for (int tick = 0; tick < 300; ++tick) world.step(1.0 / 60.0);
    EXPECT_EQ(allocations(), before);
    EXPECT_GT(world.audit().ball_collisions, hits + 20);
}

TEST(Allocation, a_warm_crowd_in_the_event_solver_asks_for_no_memory) {
    constexpr std::uint64_t kSeed = 52;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const double largest_m : {0.5, 1.5}) {
        SCOPED_TRACE(largest_m);
        World<double> world(random_crowd({.max_radius_m = largest_m}, dice),
                            {.kind = SolverKind::kEvent});
        for (int tick = 0; tick < 1200; ++tick) world.step(1.0 / 60.0);
        const std::uint64_t hits = world.audit().ball_collisions;
        const std::size_t before = allocations();
        for (int tick = 0; tick < 600; ++tick) world.step(1.0 / 60.0);
        EXPECT_EQ(allocations(), before);
        EXPECT_GT(world.audit().ball_collisions, hits + 1000);
    }
}

}  // namespace
}  // namespace fts::physics
