// What the event solver does to few bodies and to crowds alike.
#pragma once

#include <cstdint>
#include <span>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/dice.h"

namespace fts::physics {

// Of an inelastic scene, in so many ticks.
void expect_collapse_without_overrun(const Scene& scene, int ticks);

// Of balls that overlap at first, in single precision, too.
void expect_parting_without_overrun(const Scene& scene);

// Of all scenes, one after the other; in the middle of every so many ticks somebody is kicked, and
// a ball comes.
template <typename Scalar>
std::uint64_t hash_after_visits(std::span<const Scene> scenes, int ticks, int every, Dice& dice) {
    std::uint64_t hash = 0;
    for (const Scene& scene : scenes) {
        World<Scalar> world(scene, {.kind = SolverKind::kEvent});
        for (int tick = 0; tick < ticks; ++tick) {
            if (tick % every == every / 2) {
                world.set_velocity(world.ids()[0], dice.in_box(20.0).cast<Scalar>());
                world.add({dice.in_box(9.0), dice.in_box(10.0), 0.4, 1.0});
            }
            world.step(Scalar(1) / Scalar(60));
        }
        EXPECT_GT(world.audit().ball_collisions, 100U);
        hash = hash * 31 + world.state_hash();
    }
    return hash;
}

}  // namespace fts::physics
