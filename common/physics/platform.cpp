#include <algorithm>
#include <cmath>

#include "common/physics/scene.h"

namespace fts::physics {
namespace {

// The direction of a point from the origin; the origin itself looks along +x.
Vec2d direction(const Vec2d& point_m) {
    const double distance = point_m.norm();
    return distance > 0.0 ? Vec2d(point_m / distance) : Vec2d::UnitX();
}

double signed_distance(const Disc& disc, const Vec2d& point_m) {
    return disc.radius_m - point_m.norm();
}

double signed_distance(const Rectangle& rectangle, const Vec2d& point_m) {
    const Vec2d inside = rectangle.half_extents_m - point_m.cwiseAbs();
    if (inside.minCoeff() >= 0.0) return inside.minCoeff();
    return -inside.cwiseMin(0.0).norm();
}

double signed_distance(const Ring& ring, const Vec2d& point_m) {
    const double distance = point_m.norm();
    return std::min(ring.outer_radius_m - distance, distance - ring.inner_radius_m);
}

Vec2d nearest_edge_point(const Disc& disc, const Vec2d& point_m) {
    return direction(point_m) * disc.radius_m;
}

Vec2d nearest_edge_point(const Rectangle& rectangle, const Vec2d& point_m) {
    const Vec2d& half = rectangle.half_extents_m;
    const Vec2d inside = half - point_m.cwiseAbs();
    Vec2d nearest = point_m.cwiseMax(-half).cwiseMin(half);
    if (inside.minCoeff() < 0.0) return nearest;
    const int axis = inside.x() <= inside.y() ? 0 : 1;
    nearest[axis] = std::copysign(half[axis], point_m[axis]);
    return nearest;
}

Vec2d nearest_edge_point(const Ring& ring, const Vec2d& point_m) {
    const double middle = 0.5 * (ring.inner_radius_m + ring.outer_radius_m);
    return direction(point_m) *
           (point_m.norm() < middle ? ring.inner_radius_m : ring.outer_radius_m);
}

double outermost(const Disc& disc) {
    return disc.radius_m;
}
double outermost(const Rectangle& rectangle) {
    return rectangle.half_extents_m.norm();
}
double outermost(const Ring& ring) {
    return ring.outer_radius_m;
}

}  // namespace

double distance_to_edge_m(const Platform& platform, const Vec2d& point_m) {
    return std::visit([&](const auto& shape) { return signed_distance(shape, point_m); }, platform);
}

Vec2d nearest_edge_point_m(const Platform& platform, const Vec2d& point_m) {
    return std::visit([&](const auto& shape) { return nearest_edge_point(shape, point_m); },
                      platform);
}

double bounding_radius_m(const Platform& platform) {
    return std::visit([](const auto& shape) { return outermost(shape); }, platform);
}

}  // namespace fts::physics
