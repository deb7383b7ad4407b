// The discrete solver: fast, stable and never exact. In each of n substeps everybody moves; then
// every pair that overlaps is looked at once, lower indices first: if it approaches it gets the
// impulse of impact.h along its line of centres, and it is moved apart along that line until it
// touches, each by its inverse mass's share. Then whoever is beyond a wall is put back and
// reflected, and whose centre is off the platform falls, all at the substep's end.
//
// Energy and momentum are conserved to round-off in every collision. What is wrong is where and
// when: a collision comes up to a substep late, and the line of centres is that of the overlap and
// not that of the touch, which turns the velocities by an error of first order in what the balls
// move in a substep, in units of their radius. What moves further than its own size in a substep
// passes through others.
//
// A pair whose centres coincide has no line: it collides as if it had come together head-on along
// its relative velocity, and at rest is parted along x, the lower index towards +x.
//
// The outcome depends on the state alone, not on how pairs are found nor on the vector instructions
// (a level that is supported). One pass over the pairs a
// substep, so that the work is bounded and a drift never overruns; in a dense crowd some overlap is
// left for the next. The largest ball sets the size of the grid's cells, so that a scene of very
// unequal radii is slow.
//
// Works on a copy of its own; see Solver::synchronise. What all bodies share (radius, mass) is not
// looked up for each, and what the scene has not (walls, a periodic box, a platform) is not asked
// for: these are chosen once a drift, from the Model.
#pragma once

#include <cstdint>
#include <memory>

#include "common/physics/simd_level.h"
#include "common/physics/solver.h"

namespace fts::physics {

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_discrete_solver(std::uint32_t substeps,
                                                     SimdLevel level = best_simd_level());

}  // namespace fts::physics
