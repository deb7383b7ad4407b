// Where a generator may put whole discs: a box, a box whose opposite sides are one, or a platform.
#pragma once

#include <optional>

#include "common/physics/scene.h"

namespace fts::physics {

struct Region {
    Vec2d min_m = Vec2d::Zero();
    Vec2d max_m = Vec2d::Zero();
    bool is_periodic = false;
    std::optional<Platform> round;  // a disc or a ring inside the box

    Vec2d extent_m() const { return max_m - min_m; }
    double area_m2() const;
    bool holds(const Vec2d& centre_m, double radius_m) const;
    // The place nearest to `centre_m` (of its images) at which the region holds the disc, if it
    // holds it anywhere.
    Vec2d nearest_place_m(const Vec2d& centre_m, double radius_m) const;
    // From `from` to the nearest image of `to`.
    Vec2d between_m(const Vec2d& from, const Vec2d& to) const;
    // Greatest distance of a coordinate from zero.
    double reach_m() const;
};

// Of a scene's boundary; empty when it is open. Of walls and a platform it is the platform.
std::optional<Region> region_of(const Scene& scene);

}  // namespace fts::physics
