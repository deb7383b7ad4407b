// How long a solver's trajectory is the true one: until the first collision of the oracle's that is
// not the next one of both its partners. Collisions of different bodies may come in any order,
// since it changes nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/physics/scene.h"

namespace fts::lab {

// Who hit whom; walls have numbers above every body's.
struct Hit {
    std::uint32_t a = 0, b = 0;
    double time_s = 0.0;
};
inline constexpr std::uint32_t kFirstWall = 0xfffffff0U;

// The wall whose inward normal this is.
std::uint32_t wall_with_normal(const physics::Vec2d& normal);

struct Divergence {
    std::size_t collisions = 0;  // that agree
    bool reached = false;        // false: they agreed as far as both were followed
};

// Both in time order. Hits of the solver's last `grace_s` seconds before `end_s` may be missing
// without being called wrong. Exact hits less than `instant_s` apart are of one instant, and a body
// may have its own of them in any order.
Divergence divergence(const std::vector<Hit>& exact, const std::vector<Hit>& solver,
                      std::size_t bodies, double end_s, double grace_s, double instant_s);

}  // namespace fts::lab
