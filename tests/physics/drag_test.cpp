// A scene with a drag of its own: motion on the same lines, ever slower.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr double kDragPerS = 0.7;

class Drag : public testing::TestWithParam<SolverKind> {
  protected:
    static Scene gas(double drag_per_s) {
        constexpr std::uint64_t kSeed = 51;
        Dice dice(kSeed);
        Scene scene = random_gas({.balls = 40, .half_width_m = 8.0, .max_speed_mps = 8.0}, dice);
        scene.drag_per_s = drag_per_s;
        return scene;
    }
};
INSTANTIATE_TEST_SUITE_P(Solver, Drag,
                         testing::Values(SolverKind::kSeed, SolverKind::kDiscrete,
                                         SolverKind::kSwept, SolverKind::kEvent),
                         name_of);

TEST_P(Drag, takes_its_part_of_the_energy_whatever_collides) {
    World<double> world(gas(kDragPerS), {GetParam()});
    const double energy_j = world.kinetic_energy_j();
    for (int tick = 1; tick <= 240; ++tick) {
        world.step(kTick);
        const double left = std::exp(-2.0 * kDragPerS * kTick * tick);
        ASSERT_NEAR(world.kinetic_energy_j() / (energy_j * left), 1.0, 1e-12) << tick;
    }
    EXPECT_GT(world.audit().ball_collisions, 50U);
    EXPECT_LT(world.audit().worst_energy_error, 1e-13);
}

TEST_P(Drag, lets_a_ball_roll_its_stopping_distance_and_no_farther) {
    Scene scene;
    scene.drag_per_s = 2.0;
    scene.bodies = {{Vec2d::Zero(), Vec2d(3.0, 4.0), 0.5, 1.0}};
    World<double> world(scene, {GetParam()});
    for (int tick = 0; tick < 60 * 60; ++tick) world.step(kTick);
    const auto body = world.body(world.ids().front());
    EXPECT_NEAR(body.position_m.x(), 1.5, 1e-12);
    EXPECT_NEAR(body.position_m.y(), 2.0, 1e-12);
    EXPECT_NEAR(body.velocity_mps.norm() / 5.0, std::exp(-120.0), 1e-64);
}

TEST_P(Drag, is_felt_by_a_body_that_comes_later_and_by_one_that_is_thrown_again) {
    Scene scene;
    scene.drag_per_s = kDragPerS;
    scene.bodies = {{Vec2d::Zero(), Vec2d(1.0, 0.0), 0.5, 1.0}};
    World<double> world(scene, {GetParam()});
    for (int tick = 0; tick < 60; ++tick) world.step(kTick);
    const auto second = world.add({Vec2d(0.0, 5.0), Vec2d(1.0, 0.0), 0.5, 1.0});
    ASSERT_TRUE(second);
    const double kept = std::exp(-kDragPerS);
    EXPECT_NEAR(world.body(world.ids()[0]).velocity_mps.x(), kept, 1e-14);
    EXPECT_EQ(world.body(*second).velocity_mps.x(), 1.0);
    for (int tick = 0; tick < 60; ++tick) world.step(kTick);
    EXPECT_NEAR(world.body(world.ids()[0]).velocity_mps.x(), kept * kept, 1e-14);
    EXPECT_NEAR(world.body(*second).velocity_mps.x(), kept, 1e-14);
    world.set_velocity(*second, Vec2d(2.0, 0.0));
    EXPECT_EQ(world.body(*second).velocity_mps.x(), 2.0);
    EXPECT_NEAR(world.momentum_ns().x(), kept * kept + 2.0, 1e-14);
}

class ExactDrag : public Drag {};
INSTANTIATE_TEST_SUITE_P(Solver, ExactDrag, testing::Values(SolverKind::kSwept, SolverKind::kEvent),
                         name_of);

// With and without drag the same balls hit each other in the same order and with the same angles,
// at the times t and s = (1 - exp(-k t)) / k.
TEST_P(ExactDrag, is_the_same_motion_in_slower_time) {
    World<double> slowed(gas(kDragPerS), {GetParam()}), free(gas(0.0), {GetParam()});
    struct Met {
        BodyId a;
        std::optional<BodyId> b;
        double time_s, impulse_ns;
    };
    std::vector<Met> met_slowed, met_free;
    const auto collect = [](World<double>& world, double from_s, std::vector<Met>& met) {
        for (const auto& contact : world.contacts()) {
            met.push_back({contact.a, contact.b, from_s + contact.time_s, contact.impulse_ns});
        }
    };
    double slow_s = 0.0;
    for (int tick = 0; tick < 60; ++tick) {
        const double next_s = -std::expm1(-kDragPerS * kTick * (tick + 1)) / kDragPerS;
        slowed.step(kTick);
        free.step(next_s - slow_s);
        collect(slowed, kTick * tick, met_slowed);
        collect(free, slow_s, met_free);
        slow_s = next_s;
    }
    ASSERT_GT(met_free.size(), 30U);
    ASSERT_EQ(met_slowed.size(), met_free.size());
    for (std::size_t i = 0; i < met_free.size(); ++i) {
        SCOPED_TRACE(i);
        ASSERT_EQ(met_slowed[i].a, met_free[i].a);
        ASSERT_EQ(met_slowed[i].b, met_free[i].b);
        const double time_s = -std::log1p(-kDragPerS * met_free[i].time_s) / kDragPerS;
        EXPECT_NEAR(met_slowed[i].time_s, time_s, 1e-9);
        EXPECT_NEAR(met_slowed[i].impulse_ns,
                    met_free[i].impulse_ns * std::exp(-kDragPerS * time_s), 1e-8);
    }
    for (const BodyId id : free.ids()) {
        EXPECT_LT((slowed.body(id).position_m - free.body(id).position_m).norm(), 1e-8);
    }
}

}  // namespace
}  // namespace fts::physics
