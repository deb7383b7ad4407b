// Where things are put on a platform: away from its edge, and balls away from one another.
// Deterministic for a given state of the generator.
#pragma once

#include <functional>
#include <optional>

#include "common/physics/scene.h"
#include "server/match/random.h"

namespace fts::server {

// The greatest distance to the edge that any point of the platform has.
double inradius_m(const physics::Platform& platform);

// Distance from a point to the surface of the nearest ball; infinite when there is none.
using Clearance = std::function<double(const physics::Vec2d&)>;

// A spot for a ball: of some random ones well inside the platform the one with the most room around
// it, at least `radius_m` plus a gap. Empty when none of them has that room; try again later.
std::optional<physics::Vec2d> find_spawn(const physics::Platform& platform, double radius_m,
                                         const Clearance& clearance, Random& random);

// A random spot at least `margin_m` from the edge (less on a platform too small for it).
physics::Vec2d scatter(const physics::Platform& platform, double margin_m, Random& random);
// The same within `spread_m` of `around_m` as far as the platform allows.
physics::Vec2d scatter_near(const physics::Platform& platform, const physics::Vec2d& around_m,
                            double spread_m, double margin_m, Random& random);

}  // namespace fts::server
