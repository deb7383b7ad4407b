#include "tests/physics/event_lives.h"

#include "tests/physics/scenes.h"

namespace fts::physics {

void expect_collapse_without_overrun(const Scene& scene, int ticks) {
    World<double> world(scene, {.kind = SolverKind::kEvent});
    const double energy_j = world.kinetic_energy_j();
    for (int tick = 0; tick < ticks; ++tick) {
        ASSERT_FALSE(world.step(kTick).overrun) << tick;
        ASSERT_LT(world.deepest_overlap(), 1e-12) << tick;
    }
    EXPECT_LT(world.kinetic_energy_j(), energy_j);
}

void expect_parting_without_overrun(const Scene& scene) {
    World<double> world(scene, {.kind = SolverKind::kEvent});
    World<float> coarse(scene, {.kind = SolverKind::kEvent});
    const double energy_j = world.kinetic_energy_j();
    for (int tick = 0; tick < 300; ++tick) {
        ASSERT_FALSE(world.step(kTick).overrun) << tick;
        ASSERT_FALSE(coarse.step(static_cast<float>(kTick)).overrun) << tick;
    }
    EXPECT_TRUE(all_finite(world));
    EXPECT_TRUE(all_finite(coarse));
    EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-12);
    EXPECT_NEAR(coarse.kinetic_energy_j() / energy_j, 1.0, 1e-4);
}

}  // namespace fts::physics
