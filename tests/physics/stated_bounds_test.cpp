// The bounds that are stated of the solvers, each at the edge of what it is stated for.
#include <cmath>
#include <iterator>
#include <string>
#include <tuple>
#include <variant>

#include <gtest/gtest.h>

#include "common/physics/generator.h"
#include "common/physics/world.h"
#include "tests/harness/sanitized.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr double kR = 0.5;  // m, the radius of every ball here
constexpr double kBound = 1e-12;

Scene gas_of(std::int64_t balls, double packing, double radii_per_tick) {
    Generator generator;
    generator.seed = 20;
    generator.count = balls;
    generator.packing_fraction = packing;
    generator.radius_min_m = generator.radius_max_m = kR;
    generator.speed_rms_mps = radii_per_tick * kR / kTick;
    return std::get<Scene>(fill({}, generator));
}

class ExactSolver : public testing::TestWithParam<SolverKind> {};

// Each pair alone in its row, meeting at a moment of its own within the first tick. `aside` is the
// impact parameter over the sum of radii.
Scene pairs_in_rows(int pairs, double closing_mps, double most_aside, Dice& dice) {
    Scene scene;
    for (int row = 0; row < pairs; ++row) {
        const double aside_m = 2.0 * kR * dice.between(0.0, most_aside);
        const double touching_m = std::sqrt(4.0 * kR * kR - aside_m * aside_m);
        const double gap_m = touching_m + closing_mps * kTick * dice.between(0.05, 0.95);
        const double y = 6.0 * kR * row;
        const Vec2d velocity(0.5 * closing_mps, 0.0);
        scene.bodies.push_back({Vec2d(-0.5 * gap_m, y), velocity, kR, dice.between(0.5, 2.0)});
        scene.bodies.push_back(
            {Vec2d(0.5 * gap_m, y + aside_m), -velocity, kR, dice.between(0.5, 2.0)});
    }
    return scene;
}

TEST_P(ExactSolver, misses_none_of_13_000_head_on_pairs_that_close_at_up_to_30_radii_a_tick) {
    constexpr int kPairs = 1000;
    constexpr double kClosing[] = {0.05, 0.1, 0.2, 0.5, 1, 2, 3, 5, 7.5, 10, 15, 20, 30};
    static_assert(kPairs * std::size(kClosing) == 13'000);
    constexpr std::uint64_t kSeed = 13;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const double closing : kClosing) {
        SCOPED_TRACE(closing);
        const double closing_mps = closing * kR / kTick;
        World<double> world(pairs_in_rows(kPairs, closing_mps, 0.0, dice), {GetParam(), 1});
        for (int tick = 0; tick < 3; ++tick) ASSERT_FALSE(world.step(kTick).overrun);
        EXPECT_EQ(world.audit().ball_collisions, kPairs);
        for (std::size_t left = 0; left < world.size(); left += 2) {
            const auto a = world.body(world.ids()[left]), b = world.body(world.ids()[left + 1]);
            ASSERT_LT(a.position_m.x(), b.position_m.x()) << "passed through";
            ASSERT_LT(a.velocity_mps.x(), b.velocity_mps.x());
        }
    }
}

TEST_P(ExactSolver, gives_the_velocities_after_one_collision_to_1e_minus_12) {
    constexpr std::uint64_t kSeed = 14;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const double closing : {0.05, 1.0, 30.0}) {
        for (int shot = 0; shot < 300; ++shot) {
            const double closing_mps = closing * kR / kTick;
            const Scene scene = pairs_in_rows(1, closing_mps, 0.9, dice);
            World<double> world(scene, {GetParam(), 1});
            world.step(kTick);
            const BodyDef &first = scene.bodies[0], &second = scene.bodies[1];
            // When they touch, the line of centres rises by the impact parameter.
            const double sine = (second.position_m.y() - first.position_m.y()) / (2.0 * kR);
            const Vec2d normal(std::sqrt(1.0 - sine * sine), sine);
            const Vec2d impulse = 2.0 * closing_mps * normal.x() /
                                  (1.0 / first.mass_kg + 1.0 / second.mass_kg) * normal;
            const Vec2d v1 = first.velocity_mps - impulse / first.mass_kg;
            const Vec2d v2 = second.velocity_mps + impulse / second.mass_kg;
            const auto a = world.body(world.ids()[0]), b = world.body(world.ids()[1]);
            ASSERT_LE((a.velocity_mps - v1).norm(), kBound * closing_mps) << closing;
            ASSERT_LE((b.velocity_mps - v2).norm(), kBound * closing_mps) << closing;
        }
    }
}

TEST_P(ExactSolver, lets_nothing_deeper_into_anything_than_1e_minus_12_r_in_1000_r_of_space) {
    for (const double across : {50.0, 300.0, 1000.0}) {
        SCOPED_TRACE(across);
        // A crowd in the far corner, where places are coarsest, that spreads from there.
        Scene scene = gas_of(300, 0.5, 1.0);
        const Vec2d corner = Vec2d::Constant(across * kR);
        const Vec2d shift = corner - scene.walls->max_m;
        for (BodyDef& body : scene.bodies) body.position_m += shift;
        scene.walls = Walls{Vec2d::Zero(), corner};
        ASSERT_FALSE(validate(scene));
        World<double> world(scene, {GetParam(), 1});
        for (int tick = 0; tick < (harness::kSanitized ? 20 : 200); ++tick) {
            ASSERT_FALSE(world.step(kTick).overrun);
            ASSERT_LE(world.deepest_overlap(), kBound);
        }
        EXPECT_GT(world.audit().ball_collisions, 1000U);
        EXPECT_LE(world.audit().worst_penetration, kBound);
    }
}

INSTANTIATE_TEST_SUITE_P(, ExactSolver, testing::Values(SolverKind::kSwept, SolverKind::kEvent),
                         name_of);

using EnergyCase = std::tuple<SolverKind, double, double>;  // packing, radii a tick
class EnergyOfAGas : public testing::TestWithParam<EnergyCase> {};

TEST_P(EnergyOfAGas, is_the_same_to_1e_minus_12_after_600_ticks) {
    const auto [solver, packing, radii_per_tick] = GetParam();
    World<double> world(gas_of(100, packing, radii_per_tick), {solver, 1});
    const double before_j = world.kinetic_energy_j();
    for (int tick = 0; tick < (harness::kSanitized ? 60 : 600); ++tick) {
        ASSERT_FALSE(world.step(kTick).overrun);
    }
    EXPECT_GT(world.audit().ball_collisions, 0U);
    EXPECT_NEAR(world.kinetic_energy_j() / before_j, 1.0, kBound);
}

std::string name_of_case(const testing::TestParamInfo<EnergyCase>& info) {
    const auto [solver, packing, radii_per_tick] = info.param;
    return std::string(to_string(solver)) + "_" + std::to_string(std::lround(100 * packing)) +
           "_percent_" + (radii_per_tick < 1.0 ? "slow" : "fast");
}
INSTANTIATE_TEST_SUITE_P(
    , EnergyOfAGas,
    testing::Combine(testing::Values(SolverKind::kDiscrete, SolverKind::kSwept, SolverKind::kEvent),
                     testing::Values(0.1, 0.3, 0.6), testing::Values(0.05, 2.0)),
    name_of_case);

}  // namespace
}  // namespace fts::physics
