// What happened in a step: every collision and fall, in the order they happened, and running sums
// that show what collisions did to energy and momentum.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/physics/body.h"

namespace fts::physics {

// One elastic hit that happened in the last step. `b` is empty when `a` hit a wall.
template <typename Scalar>
struct Contact {
    BodyId a;
    std::optional<BodyId> b;
    Scalar time_s = Scalar(0);      // since the start of the step, [0, h]
    Vec2<Scalar> point_m;           // where the surfaces touched
    Vec2<Scalar> normal;            // unit, from b (or the wall) towards a
    Scalar impulse_ns = Scalar(0);  // > 0, given to a along the normal
    // In a periodic scene that of b is of the image that a touched.
    Vec2<Scalar> position_a_m, position_b_m;
    Vec2<Scalar> velocity_a_before_mps, velocity_a_after_mps;
    Vec2<Scalar> velocity_b_before_mps, velocity_b_after_mps;  // zero for a wall
    Scalar mass_a_kg = Scalar(0), mass_b_kg = Scalar(0);       // b infinite for a wall
    // How far the discs overlapped when the hit was found, in units of the smaller radius: 0 but
    // for round-off where times of impact are exact.
    Scalar penetration = Scalar(0);
    // Above 1: one of so many contacts of one instant that were resolved together; the velocities
    // hold what all of them did.
    std::uint32_t contacts_at_once = 1;
};

// A body that left the platform in the last step; it is no longer in the world.
template <typename Scalar>
struct Fall {
    BodyId id;
    Scalar time_s;
    Vec2<Scalar> position_m;
    Vec2<Scalar> velocity_mps;
};

// Running sums over all collisions since the world was made. A collision with an infinite mass is
// seen from that mass's rest frame, where energy is conserved, and has no momentum to compare.
// Contacts that were resolved together are compared together.
struct CollisionAudit {
    std::uint64_t ball_collisions = 0;
    std::uint64_t wall_collisions = 0;
    // Largest relative change that a single ball-ball collision made to the pair's kinetic energy
    // and (relative to |p1| + |p2|) momentum; exactly conserved up to round-off when restitution
    // is 1.
    double worst_energy_error = 0.0;
    double worst_momentum_error = 0.0;
    double worst_penetration = 0.0;  // in units of the smaller radius
    // Sum of the signed energy changes of all collisions, over the sum of the pairs' energies.
    double energy_change_j = 0.0;
    double energy_seen_j = 0.0;
    // Sets of simultaneous contacts that were not resolved within max_passes() (simultaneous.h).
    // What was left of them came as later events.
    std::uint64_t unfinished_sets = 0;
};

template <typename Scalar>
struct Record {
    std::vector<Contact<Scalar>> contacts;
    std::vector<Fall<Scalar>> falls;
    CollisionAudit audit;

    void begin_step() {
        contacts.clear();
        falls.clear();
    }
};

}  // namespace fts::physics
