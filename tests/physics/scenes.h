// Scenes that several tests look at.
#pragma once

#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "common/physics/scene.h"
#include "common/physics/world.h"
#include "tests/physics/dice.h"
#include "tests/physics/values.h"

namespace fts::physics {

struct Gas {
    std::size_t balls = 32;
    double half_width_m = 10.0;
    double max_speed_mps = 5.0;
    double min_radius_m = 0.3;
    double max_radius_m = 0.6;
    bool walled = true;
};
// Balls at random places that do not overlap, masses from 0.5 to 2 kg.
Scene random_gas(const Gas& gas, Dice& dice);

// A gas inside a closed circle of heavy balls that touch: it cannot get out, and nothing outside
// acts on it.
Scene gas_in_a_ring_of_balls(std::size_t balls, Dice& dice);

// A name for a case of a test that goes through the solvers.
inline std::string name_of(const testing::TestParamInfo<SolverKind>& info) {
    return std::string(to_string(info.param));
}

// Velocities backwards, so that time runs back.
template <typename Scalar>
void reverse(World<Scalar>& world) {
    for (const BodyId id : world.ids()) world.set_velocity(id, -world.body(id).velocity_mps);
}

// How deep the worst pair overlaps, metres; negative when none touches.
template <typename Scalar>
Scalar deepest_penetration_m(const World<Scalar>& world) {
    Scalar deepest = -std::numeric_limits<Scalar>::infinity();
    for (const BodyId a : world.ids()) {
        for (const BodyId b : world.ids()) {
            if (!(b < a)) break;
            const auto first = world.body(a), second = world.body(b);
            const Scalar distance = (first.position_m - second.position_m).norm();
            deepest = std::max(deepest, first.radius_m + second.radius_m - distance);
        }
    }
    return deepest;
}

template <typename Scalar>
bool all_finite(const World<Scalar>& world) {
    for (const BodyId id : world.ids()) {
        const auto body = world.body(id);
        if (!body.position_m.allFinite() || !body.velocity_mps.allFinite()) return false;
    }
    return true;
}

}  // namespace fts::physics
