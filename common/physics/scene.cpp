#include "common/physics/scene.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/physics/number_text.h"

namespace fts::physics {
namespace {

using Verdict = std::optional<SceneError>;

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

// `name` is the boundary's field: walls or periodic.
Verdict check_box(const std::string& name, const Vec2d& min_m, const Vec2d& max_m) {
    const std::string range = "give finite coordinates within " + text_of(kMaxCoordinateM) + " m";
    if (!within(min_m, kMaxCoordinateM)) return refuse(name + ".min_m", text_of(min_m), range);
    if (!within(max_m, kMaxCoordinateM)) return refuse(name + ".max_m", text_of(max_m), range);
    if ((max_m - min_m).minCoeff() > 0.0) return std::nullopt;
    return refuse(
        name + ".max_m", text_of(max_m),
        "give more than " + name + ".min_m, which is " + text_of(min_m) + ", in both coordinates");
}

Verdict check_boundary(const Scene& scene) {
    if (scene.periodic && scene.walls) {
        return refuse("periodic", "given beside walls", "keep one of the two");
    }
    if (scene.periodic && scene.platform) {
        return refuse("periodic", "given beside a platform", "keep one of the two");
    }
    if (scene.walls) {
        if (auto error = check_box("walls", scene.walls->min_m, scene.walls->max_m)) return error;
    }
    if (scene.periodic) {
        const Periodic& box = *scene.periodic;
        if (auto error = check_box("periodic", box.min_m, box.max_m)) return error;
    }
    if (!scene.platform) return std::nullopt;
    return std::visit([](const auto& shape) { return check_shape(shape); }, *scene.platform);
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

Verdict check_inside_periodic(const BodyDef& body, const Periodic& box, const std::string& name) {
    const double width = (box.max_m - box.min_m).minCoeff();
    if (width < kMinPeriodicWidthInRadii * body.radius_m) {
        return refuse(name + ".radius_m", text_of(body.radius_m),
                      "the periodic box is only " + text_of(width) + " m wide; give at most " +
                          text_of(width / kMinPeriodicWidthInRadii) + " m");
    }
    const Vec2d margin = (body.position_m - box.min_m).cwiseMin(box.max_m - body.position_m);
    if (margin.minCoeff() >= 0.0) return std::nullopt;
    return refuse(
        name + ".position_m", text_of(body.position_m),
        "keep it in the periodic box from " + text_of(box.min_m) + " to " + text_of(box.max_m));
}

struct Placed {
    Vec2d position_m;
    double radius_m;
    std::size_t body;
};

// Every body, and of those near a side of a periodic box their images beyond the opposite side.
std::vector<Placed> with_images(const Scene& scene) {
    std::vector<Placed> placed;
    double widest_m = 0.0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        placed.push_back({scene.bodies[i].position_m, scene.bodies[i].radius_m, i});
        widest_m = std::max(widest_m, scene.bodies[i].radius_m);
    }
    if (!scene.periodic) return placed;
    const Vec2d extent = scene.periodic->max_m - scene.periodic->min_m;
    for (int axis = 0; axis < 2; ++axis) {
        const std::size_t count = placed.size();
        for (std::size_t i = 0; i < count; ++i) {
            Placed image = placed[i];
            const double reach = image.radius_m + widest_m;
            if (!(image.position_m[axis] < scene.periodic->min_m[axis] + reach)) continue;
            image.position_m[axis] += extent[axis];
            placed.push_back(image);
        }
    }
    return placed;
}

// Along x, so that only bodies whose extents overlap in x are compared.
Verdict check_overlaps(const Scene& scene) {
    std::vector<Placed> placed = with_images(scene);
    const auto left = [](const Placed& body) { return body.position_m.x() - body.radius_m; };
    std::stable_sort(placed.begin(), placed.end(),
                     [&](const Placed& a, const Placed& b) { return left(a) < left(b); });
    for (std::size_t m = 0; m < placed.size(); ++m) {
        const Placed& body = placed[m];
        const double right = body.position_m.x() + body.radius_m;
        for (std::size_t n = m + 1; n < placed.size() && left(placed[n]) < right; ++n) {
            const Placed& other = placed[n];
            const double reach = body.radius_m + other.radius_m;
            const double distance = (body.position_m - other.position_m).norm();
            if (distance >= reach * (1.0 - kTouchTolerance)) continue;
            const auto [first, second] = std::minmax(body.body, other.body);
            return refuse("body[" + std::to_string(second) + "].position_m",
                          text_of(scene.bodies[second].position_m),
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
    if (scene.periodic) {
        if (auto error = check_inside_periodic(body, *scene.periodic, name)) return error;
    }
    if (scene.platform && distance_to_edge_m(*scene.platform, body.position_m) < 0.0) {
        return refuse(name + ".position_m", text_of(body.position_m),
                      "that is " + text_of(-distance_to_edge_m(*scene.platform, body.position_m)) +
                          " m off the platform; put its centre on it");
    }
    return std::nullopt;
}

std::optional<SceneError> validate(const Scene& scene, Overlaps overlaps) {
    if (!within(scene.restitution, 0.0, 1.0)) {
        return refuse("restitution", text_of(scene.restitution),
                      "give a number from 0 (they stick) to 1 (elastic)");
    }
    if (scene.bodies.size() > kMaxBodies) {
        return refuse("body", std::to_string(scene.bodies.size()) + " entries long",
                      "give at most " + std::to_string(kMaxBodies));
    }
    if (!within(scene.drag_per_s, 0.0, kMaxDragPerS)) {
        return refuse("drag_per_s", text_of(scene.drag_per_s),
                      "give a number from 0 (none) to " + text_of(kMaxDragPerS));
    }
    if (auto error = check_boundary(scene)) return error;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const std::string name = "body[" + std::to_string(i) + "]";
        if (auto error = validate(scene.bodies[i], scene, name)) return error;
    }
    return overlaps == Overlaps::kAccepted ? std::nullopt : check_overlaps(scene);
}

}  // namespace fts::physics
