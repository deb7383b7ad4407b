// What is conserved, measured; and a fingerprint of a state.
#pragma once

#include <cstdint>
#include <span>

#include "common/physics/bodies.h"
#include "common/physics/record.h"
#include "common/physics/solver.h"

namespace fts::physics {

// Adds one collision to the running sums.
template <typename Scalar>
void account(const Contact<Scalar>& contact, CollisionAudit& audit);

// Adds contacts that were resolved together: the energy and momentum of all their bodies, each
// counted once, are compared as a whole. With walls or infinite masses momentum is not compared,
// and energy is seen from the rest frame of these, or not compared when they do not share one.
template <typename Scalar>
void account_together(std::span<const Contact<Scalar>> contacts, CollisionAudit& audit);

// Sums over finite masses, in double, ascending by index.
template <typename Scalar>
double kinetic_energy_j(const Bodies<Scalar>& bodies);
template <typename Scalar>
Vec2d momentum_ns(const Bodies<Scalar>& bodies);

// How deep a disc is inside another, or beyond a wall: the deepest of all, in units of the smaller
// radius; 0 when nothing overlaps. What an infinite mass passes through (its like, and walls) does
// not count.
template <typename Scalar>
double deepest_overlap(const Bodies<Scalar>& bodies, const Model<Scalar>& model);

// FNV-1a over the bits of every living body's index, position, velocity, radius and mass.
template <typename Scalar>
std::uint64_t state_hash(const Bodies<Scalar>& bodies);

}  // namespace fts::physics
