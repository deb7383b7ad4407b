// What truly happens in a scene: event-driven dynamics in 113 bits of mantissa, written to be
// believed and not to be fast. It judges the solvers and shares no code with them; only tests and
// studies use it.
//
// Looks at every pair, moves everybody to every event, takes roots from the textbook formula in
// __float128 (long double where that has as many bits). Pairs whose swept boxes are apart by far
// are passed over in double precision. Contacts of one instant are resolved together, as
// generalised reflections (Smith et al. 2012), their non-negative impulses by Gauss-Seidel to
// convergence. Drag is exact: bodies with one drag k move on the same lines in the slower time
// (1 - exp(-k t)) / k. Restitution is 1. Platforms are not modelled.
//
// A scene gives positions in double precision, so what is nearer than kTouchTolerance of the sum of
// radii, or than the round-off of its coordinates, touches. What touches and approaches slower than
// 1e-30 of its speeds rests.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "common/physics/scene.h"

namespace fts::lab {

struct OracleContact {
    std::size_t a = 0;             // as numbered in the scene
    std::optional<std::size_t> b;  // empty: a wall; else b > a
    double time_s = 0.0;           // since the start of the last advance
    physics::Vec2d normal;         // unit, from b (or the wall) towards a
    physics::Vec2d velocity_a_after_mps, velocity_b_after_mps;
};

class Oracle {
  public:
    // Valid but for overlaps, restitution 1, no platform; asserted.
    explicit Oracle(const physics::Scene& scene);
    ~Oracle();
    Oracle(Oracle&&) noexcept;
    Oracle& operator=(Oracle&&) noexcept;

    // False when it stopped after `max_events`, at the time of the last one.
    bool advance(double span_s, std::size_t max_events = 10'000'000);

    // Turns every velocity round, so that what follows is the past again, where nothing drags.
    void reverse();

    // Of the last advance, in the order they happened.
    const std::vector<OracleContact>& contacts() const;
    std::size_t ball_collisions() const;  // since the start
    std::size_t wall_collisions() const;

    // Rounded to double; positions inside a periodic box.
    std::vector<physics::BodyDef> bodies() const;
    // Relative to the start, computed in 113 bits.
    double energy_error() const;
    double momentum_error() const;  // over the sum of |p|; wall impulses left out

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fts::lab
