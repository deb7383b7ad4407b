#include "common/physics/fidelity.h"

#include <gtest/gtest.h>

#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

Scene crowd(std::size_t balls, double speed_mps) {
    constexpr std::uint64_t kSeed = 7;
    Dice dice(kSeed);
    return random_gas({.balls = balls,
                       .half_width_m = 1.2 * std::sqrt(static_cast<double>(balls)),
                       .max_speed_mps = speed_mps,
                       .min_radius_m = 0.5,
                       .max_radius_m = 0.5},
                      dice);
}

TEST(Fidelity, tolerances_have_names_and_numbers_and_nothing_else) {
    EXPECT_EQ(tolerance_from("auto"), kAutoTolerance);
    EXPECT_EQ(tolerance_from("fast"), kFastTolerance);
    EXPECT_EQ(tolerance_from("exact"), kExactTolerance);
    EXPECT_EQ(tolerance_from("0.001"), 0.001);
    EXPECT_EQ(tolerance_from("1e-9"), 1e-9);
    for (const char* text :
         {"", "0", "1", "-0.1", "nan", "inf", "0.1x", " 0.1", "Fast", "1e-999"}) {
        EXPECT_FALSE(tolerance_from(text)) << text;
    }
}

TEST(Fidelity, a_plan_never_states_more_than_the_tolerance_it_says_it_meets) {
    for (const double speed : {1e-6, 0.1, 1.0, 10.0, 1e3, 1e6}) {
        const Scene scene = crowd(200, speed);
        for (double tolerance = 0.5; tolerance > 1e-16; tolerance /= 7.0) {
            SCOPED_TRACE(testing::Message() << speed << " m/s, tolerance " << tolerance);
            const Plan chosen = plan(scene, {.tolerance = tolerance});
            EXPECT_EQ(chosen.meets_tolerance, chosen.error_bound <= tolerance);
            EXPECT_GE(chosen.solver.substeps, 1U);
            EXPECT_LE(chosen.solver.substeps, kMaxSubsteps);
            EXPECT_FALSE(chosen.broadphase.empty());
            EXPECT_EQ(chosen.reason.back(), '.');
        }
    }
}

TEST(Fidelity, more_tolerance_never_costs_more) {
    for (const double speed : {0.01, 3.0, 100.0}) {
        const Scene scene = crowd(300, speed);
        double cost = 0.0;
        for (double tolerance = 0.9; tolerance > 1e-11; tolerance /= 3.0) {
            const Plan chosen = plan(scene, {.tolerance = tolerance});
            if (!chosen.meets_tolerance) break;
            EXPECT_GE(chosen.cost_ns_per_body_tick, cost);
            cost = chosen.cost_ns_per_body_tick;
        }
    }
}

TEST(Fidelity, single_precision_serves_where_it_is_enough_and_allowed) {
    // Overlaps, which are cheaper in single precision; exact times of impact are not.
    const Scene scene = crowd(400, 1.0);
    const Fidelity fast = {.tolerance = kFastTolerance, .thrust = true};
    EXPECT_EQ(plan(scene, fast).scalar, ScalarKind::kFloat);
    Fidelity wide = fast;
    wide.allow_float = false;
    EXPECT_EQ(plan(scene, wide).scalar, ScalarKind::kDouble);
    EXPECT_EQ(plan(scene, {.tolerance = 1e-9}).scalar, ScalarKind::kDouble);
    Scene far = scene;
    far.walls = {far.walls->min_m + Vec2d(1e7, 0.0), far.walls->max_m + Vec2d(1e7, 0.0)};
    for (BodyDef& body : far.bodies) body.position_m.x() += 1e7;
    EXPECT_EQ(plan(far, fast).scalar, ScalarKind::kDouble);
}

TEST(Fidelity, a_calendar_is_kept_only_where_nobody_thrusts) {
    const Scene scene = crowd(20, 0.5);
    EXPECT_EQ(plan(scene, {.tolerance = 1e-6}).solver.kind, SolverKind::kEvent);
    EXPECT_EQ(plan(scene, {.tolerance = 1e-6, .thrust = true}).solver.kind, SolverKind::kSwept);
}

TEST(Fidelity, few_that_coast_fast_are_looked_at_in_every_tick_and_a_crowd_is_foreseen) {
    constexpr Fidelity kExact = {.tolerance = 1e-9};
    EXPECT_EQ(plan(crowd(100, 1.0), kExact).solver.kind, SolverKind::kEvent);
    EXPECT_EQ(plan(crowd(100, 60.0), kExact).solver.kind, SolverKind::kSwept);
    EXPECT_EQ(plan(crowd(400, 60.0), kExact).solver.kind, SolverKind::kEvent);
}

TEST(Fidelity, exact_is_the_least_error_there_is_and_says_so) {
    const Plan exact = plan(crowd(100, 3.0), {.tolerance = kExactTolerance, .thrust = true});
    EXPECT_EQ(exact.solver.kind, SolverKind::kSwept);
    EXPECT_EQ(exact.scalar, ScalarKind::kDouble);
    EXPECT_TRUE(exact.meets_tolerance);
    EXPECT_GT(exact.error_bound, 0.0);
    EXPECT_LT(exact.error_bound, 1e-11);
}

TEST(Fidelity, a_crowd_may_be_advanced_by_overlaps_where_they_are_close_to_the_contact) {
    const Plan fast = plan(crowd(400, 1.0), {.tolerance = kFastTolerance, .thrust = true});
    EXPECT_EQ(fast.solver.kind, SolverKind::kDiscrete);
    EXPECT_LE(fast.error_bound, kFastTolerance);
    const Plan two = plan(crowd(2, 1.0), {.tolerance = kFastTolerance});
    EXPECT_NE(two.solver.kind, SolverKind::kDiscrete) << "two balls collide too rarely for a mean";
}

TEST(Fidelity, an_empty_scene_has_a_plan_too) {
    EXPECT_TRUE(plan(Scene(), {}).meets_tolerance);
}

}  // namespace
}  // namespace fts::physics
