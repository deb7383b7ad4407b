// The same scene gives the same bits: on every compiler, at every optimisation level, in every run.
#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

// Thrust, drag, walls, hits, falls, bodies that come and go.
template <typename Scalar>
std::uint64_t hash_after_a_busy_life(std::uint64_t seed) {
    Dice dice(seed);
    Scene scene = random_gas({.balls = 50, .half_width_m = 10.0, .max_speed_mps = 10.0}, dice);
    scene.platform = Ring{0.2, 13.5};
    std::erase_if(scene.bodies, [&](const BodyDef& body) {
        return distance_to_edge_m(*scene.platform, body.position_m) < 0.0;
    });
    World<Scalar> world(scene);
    for (int tick = 0; tick < 900; ++tick) {
        if (tick % 20 == 0) {
            for (const BodyId id : world.ids()) {
                const Vec2d thrust = dice.in_box(25.0);
                const double drag = dice.between(0.0, 3.0);
                world.set_control(id, {thrust.cast<Scalar>(), static_cast<Scalar>(drag)});
            }
            world.add({dice.in_box(9.0), dice.in_box(10.0), 0.4, dice.between(0.5, 2.0)});
        }
        world.step(Scalar(1) / Scalar(60));
    }
    EXPECT_GT(world.audit().ball_collisions, 1000U);
    EXPECT_GT(world.audit().wall_collisions, 300U);
    return world.state_hash();
}

// Change these only together with a change of the physics that is meant to change trajectories.
TEST(Determinism, golden_hash_in_double_precision) {
    EXPECT_EQ(hash_after_a_busy_life<double>(2013), 0x4eacca3632cd77fcULL);
}

TEST(Determinism, golden_hash_in_single_precision) {
    EXPECT_EQ(hash_after_a_busy_life<float>(2013), 0xdd15cb77f574c948ULL);
}

TEST(Determinism, two_worlds_made_alike_stay_alike) {
    EXPECT_EQ(hash_after_a_busy_life<double>(77), hash_after_a_busy_life<double>(77));
    EXPECT_NE(hash_after_a_busy_life<double>(77), hash_after_a_busy_life<double>(78));
}

// What a body far away does to the grid must not show in the bits of the others.
TEST(Determinism, bodies_that_are_never_met_do_not_change_the_others) {
    constexpr std::uint64_t kSeed = 21;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = random_gas({.balls = 40, .walled = false}, dice);
    Scene wider = scene;
    for (int i = 0; i < 30; ++i) {
        wider.bodies.push_back({Vec2d(1e6 + 10 * i, -5e5), Vec2d(1e4, 1e4), 3.0, 1.0});
    }
    World<double> alone(scene), accompanied(wider);
    for (int tick = 0; tick < 300; ++tick) {
        alone.step(1.0 / 60.0);
        accompanied.step(1.0 / 60.0);
    }
    EXPECT_GT(alone.audit().ball_collisions, 10U);
    for (const BodyId id : alone.ids()) {
        ASSERT_EQ(alone.body(id).position_m, accompanied.body(id).position_m);
        ASSERT_EQ(alone.body(id).velocity_mps, accompanied.body(id).velocity_mps);
    }
}

}  // namespace
}  // namespace fts::physics
