#include "common/physics/scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>

namespace fts::physics {
namespace {

using Verdict = std::optional<SceneError>;

std::string text_of(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

std::string text_of(const Vec2d& value) {
    return std::string("(").append(text_of(value.x())).append(", ").append(text_of(value.y())) +
           ")";
}

SceneError refuse(const std::string& field, const std::string& value, const std::string& remedy) {
    return {field, field + " is " + value + "; " + remedy};
}

// False for NaN, as every comparison below.
bool within(double value, double low, double high) {
    return value >= low && value <= high;
}

bool within(const Vec2d& value, double limit) {
    return within(value.x(), -limit, limit) && within(value.y(), -limit, limit);
}

Verdict check_length(const std::string& field, double value) {
    if (within(value, kMinRadiusM, kMaxCoordinateM)) return std::nullopt;
    return refuse(
        field, text_of(value),
        "give a length from " + text_of(kMinRadiusM) + " to " + text_of(kMaxCoordinateM) + " m");
}

Verdict check_shape(const Disc& disc) {
    return check_length("platform.radius_m", disc.radius_m);
}

Verdict check_shape(const Rectangle& rectangle) {
    if (auto error = check_length("platform.half_extents_m.x", rectangle.half_extents_m.x())) {
        return error;
    }
    return check_length("platform.half_extents_m.y", rectangle.half_extents_m.y());
}

Verdict check_shape(const Ring& ring) {
    if (auto error = check_length("platform.inner_radius_m", ring.inner_radius_m)) return error;
    if (auto error = check_length("platform.outer_radius_m", ring.outer_radius_m)) return error;
    if (ring.inner_radius_m < ring.outer_radius_m) return std::nullopt;
    return refuse("platform.inner_radius_m", text_of(ring.inner_radius_m),
                  "give less than outer_radius_m, which is " + text_of(ring.outer_radius_m));
}

Verdict check_walls(const Walls& walls) {
    const std::string range = "give finite coordinates within " + text_of(kMaxCoordinateM) + " m";
    if (!within(walls.min_m, kMaxCoordinateM)) {
        return refuse("walls.min_m", text_of(walls.min_m), range);
    }
    if (!within(walls.max_m, kMaxCoordinateM)) {
        return refuse("walls.max_m", text_of(walls.max_m), range);
    }
    if ((walls.max_m - walls.min_m).minCoeff() > 0.0) return std::nullopt;
    return refuse(
        "walls.max_m", text_of(walls.max_m),
        "give more than walls.min_m, which is " + text_of(walls.min_m) + ", in both coordinates");
}

Verdict check_values(const BodyDef& body, const std::string& name) {
    if (!within(body.radius_m, kMinRadiusM, kMaxRadiusM)) {
        return refuse(
            name + ".radius_m", text_of(body.radius_m),
            "give a radius from " + text_of(kMinRadiusM) + " to " + text_of(kMaxRadiusM) + " m");
    }
    const bool heavy_for_ever = std::isinf(body.mass_kg) && body.mass_kg > 0.0;
    if (!heavy_for_ever && !within(body.mass_kg, kMinMassKg, kMaxMassKg)) {
        return refuse(name + ".mass_kg", text_of(body.mass_kg),
                      "give a mass from " + text_of(kMinMassKg) + " to " + text_of(kMaxMassKg) +
                          " kg, or inf for a body that collisions do not move");
    }
    if (!within(body.position_m, kMaxCoordinateM)) {
        return refuse(name + ".position_m", text_of(body.position_m),
                      "give finite coordinates within " + text_of(kMaxCoordinateM) + " m");
    }
    if (!within(body.velocity_mps, kMaxSpeedMps)) {
        return refuse(name + ".velocity_mps", text_of(body.velocity_mps),
                      "give finite components within " + text_of(kMaxSpeedMps) + " m/s");
    }
    return std::nullopt;
}

Verdict check_inside_walls(const BodyDef& body, const Walls& walls, const std::string& name) {
    const double width = (walls.max_m - walls.min_m).minCoeff();
    if (width < (2.0 + kMinWallClearance) * body.radius_m) {
        return refuse(name + ".radius_m", text_of(body.radius_m),
                      "the walls are only " + text_of(width) + " m apart; give at most " +
                          text_of(width / (2.0 + kMinWallClearance)) + " m");
    }
    const double reach = body.radius_m * (1.0 - kTouchTolerance);
    const Vec2d margin = (body.position_m - walls.min_m).cwiseMin(walls.max_m - body.position_m);
    if (margin.minCoeff() >= reach) return std::nullopt;
    return refuse(name + ".position_m", text_of(body.position_m),
                  "keep the whole disc of radius " + text_of(body.radius_m) +
                      " m between the walls at " + text_of(walls.min_m) + " and " +
                      text_of(walls.max_m));
}

// Along x, so that only bodies whose extents overlap in x are compared.
Verdict check_overlaps(const std::vector<BodyDef>& bodies) {
    std::vector<std::size_t> order(bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto left = [&](std::size_t i) { return bodies[i].position_m.x() - bodies[i].radius_m; };
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        return left(i) != left(j) ? left(i) < left(j) : i < j;
    });
    for (std::size_t m = 0; m < order.size(); ++m) {
        const BodyDef& body = bodies[order[m]];
        const double right = body.position_m.x() + body.radius_m;
        for (std::size_t n = m + 1; n < order.size() && left(order[n]) < right; ++n) {
            const BodyDef& other = bodies[order[n]];
            const double reach = body.radius_m + other.radius_m;
            const double distance = (body.position_m - other.position_m).norm();
            if (distance >= reach * (1.0 - kTouchTolerance)) continue;
            const auto [first, second] = std::minmax(order[m], order[n]);
            return refuse("body[" + std::to_string(second) + "].position_m",
                          text_of(bodies[second].position_m),
                          text_of(reach - distance) + " m inside body[" + std::to_string(first) +
                              "]; move them to at least " + text_of(reach) + " m apart");
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<SceneError> validate(const BodyDef& body, const Scene& scene,
                                   const std::string& name) {
    if (auto error = check_values(body, name)) return error;
    if (scene.walls) {
        if (auto error = check_inside_walls(body, *scene.walls, name)) return error;
    }
    if (scene.platform && distance_to_edge_m(*scene.platform, body.position_m) < 0.0) {
        return refuse(name + ".position_m", text_of(body.position_m),
                      "that is " + text_of(-distance_to_edge_m(*scene.platform, body.position_m)) +
                          " m off the platform; put its centre on it");
    }
    return std::nullopt;
}

std::optional<SceneError> validate(const Scene& scene) {
    if (!within(scene.restitution, 0.0, 1.0)) {
        return refuse("restitution", text_of(scene.restitution),
                      "give a number from 0 (they stick) to 1 (elastic)");
    }
    if (scene.bodies.size() > kMaxBodies) {
        return refuse("body", std::to_string(scene.bodies.size()) + " entries long",
                      "give at most " + std::to_string(kMaxBodies));
    }
    if (scene.walls) {
        if (auto error = check_walls(*scene.walls)) return error;
    }
    if (scene.platform) {
        const auto check = [](const auto& shape) { return check_shape(shape); };
        if (auto error = std::visit(check, *scene.platform)) return error;
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const std::string name = "body[" + std::to_string(i) + "]";
        if (auto error = validate(scene.bodies[i], scene, name)) return error;
    }
    return check_overlaps(scene.bodies);
}

}  // namespace fts::physics
