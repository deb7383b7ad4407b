#include "common/physics/region.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace fts::physics {

double Region::area_m2() const {
    if (!round) return extent_m().x() * extent_m().y();
    if (const auto* disc = std::get_if<Disc>(&*round)) {
        return std::numbers::pi * disc->radius_m * disc->radius_m;
    }
    const auto& ring = std::get<Ring>(*round);
    return std::numbers::pi * (ring.outer_radius_m - ring.inner_radius_m) *
           (ring.outer_radius_m + ring.inner_radius_m);
}

bool Region::holds(const Vec2d& centre_m, double radius_m) const {
    if (round) return distance_to_edge_m(*round, centre_m) >= radius_m;
    const Vec2d margin = (centre_m - min_m).cwiseMin(max_m - centre_m);
    return margin.minCoeff() >= (is_periodic ? 0.0 : radius_m);
}

Vec2d Region::nearest_place_m(const Vec2d& centre_m, double radius_m) const {
    if (is_periodic) {
        Vec2d place = centre_m;
        for (int axis = 0; axis < 2; ++axis) {
            if (place[axis] < min_m[axis]) place[axis] += extent_m()[axis];
            if (place[axis] >= max_m[axis]) place[axis] -= extent_m()[axis];
        }
        return place.cwiseMax(min_m).cwiseMin(max_m);
    }
    if (!round) {
        const Vec2d margin = Vec2d::Constant(radius_m);
        return centre_m.cwiseMax(min_m + margin).cwiseMin(max_m - margin);
    }
    const double distance = centre_m.norm();
    const Vec2d direction = distance > 0.0 ? Vec2d(centre_m / distance) : Vec2d::UnitX();
    if (const auto* disc = std::get_if<Disc>(&*round)) {
        return distance + radius_m > disc->radius_m ? Vec2d(direction * (disc->radius_m - radius_m))
                                                    : centre_m;
    }
    const auto& ring = std::get<Ring>(*round);
    if (distance + radius_m > ring.outer_radius_m) {
        return direction * (ring.outer_radius_m - radius_m);
    }
    return distance - radius_m < ring.inner_radius_m
               ? Vec2d(direction * (ring.inner_radius_m + radius_m))
               : centre_m;
}

Vec2d Region::between_m(const Vec2d& from, const Vec2d& to) const {
    Vec2d between = to - from;
    if (!is_periodic) return between;
    const Vec2d extent = extent_m();
    for (int axis = 0; axis < 2; ++axis) {
        if (between[axis] > 0.5 * extent[axis]) between[axis] -= extent[axis];
        if (between[axis] < -0.5 * extent[axis]) between[axis] += extent[axis];
    }
    return between;
}

double Region::reach_m() const {
    return std::max(min_m.cwiseAbs().maxCoeff(), max_m.cwiseAbs().maxCoeff());
}

std::optional<Region> region_of(const Scene& scene) {
    if (scene.periodic) return Region{scene.periodic->min_m, scene.periodic->max_m, true, {}};
    if (scene.platform) {
        if (const auto* rectangle = std::get_if<Rectangle>(&*scene.platform)) {
            return Region{-rectangle->half_extents_m, rectangle->half_extents_m, false, {}};
        }
        const Vec2d corner = Vec2d::Constant(bounding_radius_m(*scene.platform));
        return Region{-corner, corner, false, scene.platform};
    }
    if (scene.walls) return Region{scene.walls->min_m, scene.walls->max_m, false, {}};
    return std::nullopt;
}

}  // namespace fts::physics
