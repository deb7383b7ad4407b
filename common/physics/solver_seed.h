// The algorithm of "Fear The Sphere" (D. Prorok, 2013) as a solver: in each of n substeps everybody
// moves; then every pair is tested by (1), pushed apart by (2) and (3), and answered by the
// trigonometric response (4) to (21).
//
// A museum, and an oracle for one collision: it takes time as the square of the number of bodies,
// energy is conserved only as well as sines and cosines are, and, like `discrete`, it finds
// collisions late and lets what is fast pass through. Its last bits may differ between machines.
//
// The errata are mended, since as printed nothing would collide: (1) tests the other way round;
// (2), (3) take the shortest path, shared by inverse mass, and no step of one unit along the
// diagonal; (8) to (10) are atan2; and only pairs that approach are answered. See seed_equations.h,
// which keeps the printed forms. What the paper does not speak of is as in solver_discrete.h:
// walls, a periodic box, platforms, restitution. An infinite mass is the limit of (11): 1 against
// 0. A pair whose centres coincide is left alone until it has moved on.
#pragma once

#include <cstdint>
#include <memory>

#include "common/physics/solver.h"

namespace fts::physics {

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_seed_solver(std::uint32_t substeps);

}  // namespace fts::physics
