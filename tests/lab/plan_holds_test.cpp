// What a plan states is what the oracle then finds: the collision error of the planned solver is
// within the bound, and so within the tolerance.
#include <string>

#include <gtest/gtest.h>

#include "common/physics/fidelity.h"
#include "common/physics/generator.h"
#include "server/lab/accuracy.h"

namespace fts::lab {
namespace {

using physics::Generator;
using physics::MassRule;
using physics::Scene;

struct Gas {
    const char* name;
    double packing, speed_rms_mps, radius_max_m;
    MassRule mass;
};

Scene scene_of(const Gas& gas, std::uint64_t seed) {
    Generator generator;
    generator.seed = seed;
    generator.count = 150;
    generator.packing_fraction = gas.packing;
    generator.radius_min_m = 0.5;
    generator.radius_max_m = gas.radius_max_m;
    generator.mass = gas.mass;
    generator.speed_rms_mps = gas.speed_rms_mps;
    const auto filled = physics::fill(Scene(), generator);
    if (const auto* error = std::get_if<physics::SceneError>(&filled)) {
        ADD_FAILURE() << error->message;
        return {};
    }
    return std::get<Scene>(filled);
}

class PlanHolds : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Tolerance, PlanHolds, testing::Values(0.3, 0.1, 0.03, 1e-3, 1e-6, 1e-9));

TEST_P(PlanHolds, in_gases_of_every_density_speed_and_mixture) {
    constexpr Gas kGases[] = {
        {"dilute and slow", 0.05, 0.3, 0.5, MassRule::kEqual},
        {"dilute and fast", 0.05, 30.0, 0.5, MassRule::kEqual},
        {"medium", 0.3, 1.5, 0.5, MassRule::kEqual},
        {"medium and fast", 0.3, 30.0, 0.5, MassRule::kEqual},
        {"medium and very fast", 0.3, 200.0, 0.5, MassRule::kEqual},
        {"dense", 0.6, 1.5, 0.5, MassRule::kEqual},
        {"dense mixture", 0.55, 1.5, 1.5, MassRule::kByArea},
        {"mixture", 0.3, 6.0, 1.5, MassRule::kByArea},
    };
    for (const Gas& gas : kGases) {
        std::string measured;
        for (const bool thrust : {false, true}) {
            SCOPED_TRACE(testing::Message() << gas.name << (thrust ? ", thrusting" : ""));
            const Scene scene = scene_of(gas, 61);
            const physics::Plan plan =
                physics::plan(scene, {.tolerance = GetParam(), .thrust = thrust});
            SCOPED_TRACE(describe(plan));
            EXPECT_EQ(plan.meets_tolerance, plan.error_bound <= GetParam());
            if (describe(plan) == measured) continue;
            measured = describe(plan);
            SamplingLimits limits;
            limits.collisions = 80;
            const auto accuracy =
                measure_accuracy(scene, {plan.solver, plan.scalar}, {.ticks = 300}, limits, nullptr,
                                 [] { return true; });
            ASSERT_TRUE(accuracy);
            ASSERT_TRUE(accuracy->local.collision_error);
            EXPECT_LE(*accuracy->local.collision_error, plan.error_bound);
            if (plan.meets_tolerance) {
                EXPECT_LE(*accuracy->local.collision_error, GetParam());
            }
        }
    }
}

}  // namespace
}  // namespace fts::lab
