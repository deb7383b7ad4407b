#include "common/physics/generator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "common/physics/disc_lattice.h"
#include "common/physics/number_text.h"
#include "common/physics/packing.h"
#include "common/physics/splitmix.h"

namespace fts::physics {
namespace {

using Verdict = std::optional<SceneError>;

// Sums of so many even numbers are nearly normal.
constexpr int kEvenNumbersPerComponent = 12;

// Four digits behind the point, never above the value.
std::string at_most(double value) {
    return text_of(std::floor(value * 1e4) / 1e4);
}

SceneError refuse_setting(const std::string& name, const std::string& value,
                          const std::string& remedy) {
    const std::string field = "generator." + name;
    return {field, field + " is " + value + "; " + remedy};
}

double disc_area_m2(double radius_m) {
    return std::numbers::pi * radius_m * radius_m;
}

bool is_point(const Vec2d& min_m, const Vec2d& max_m) {
    return min_m == max_m && min_m.allFinite();
}

// The boundary is not there yet and follows from the packing.
bool makes_boundary(const Scene& scene) {
    if (scene.walls) return is_point(scene.walls->min_m, scene.walls->max_m);
    if (scene.periodic) return is_point(scene.periodic->min_m, scene.periodic->max_m);
    return !scene.platform;
}

Verdict check_radii(const Generator& generator) {
    const auto check = [](const std::string& name, double value) -> Verdict {
        if (value >= kMinRadiusM && value <= kMaxRadiusM) return std::nullopt;
        return refuse_setting(
            name, text_of(value),
            "give a radius from " + text_of(kMinRadiusM) + " to " + text_of(kMaxRadiusM) + " m");
    };
    if (auto error = check("radius_min", generator.radius_min_m)) return error;
    if (auto error = check("radius_max", generator.radius_max_m)) return error;
    if (generator.radius_min_m <= generator.radius_max_m) return std::nullopt;
    return refuse_setting("radius_max", text_of(generator.radius_max_m),
                          "give at least radius_min, which is " + text_of(generator.radius_min_m));
}

Verdict check_numbers(const Generator& generator, const Scene& scene) {
    const std::size_t room = kMaxBodies - std::min(kMaxBodies, scene.bodies.size());
    if (generator.count &&
        (*generator.count < 1 || *generator.count > static_cast<std::int64_t>(room))) {
        return refuse_setting("count", std::to_string(*generator.count),
                              "give a number from 1 to " + std::to_string(room));
    }
    const auto& fraction = generator.packing_fraction;
    if (fraction && !(*fraction > 0.0 && *fraction <= kDensestPacking)) {
        return refuse_setting("packing_fraction", text_of(*fraction),
                              "give a number above 0 and at most " + at_most(kDensestPacking) +
                                  ", to which equal discs fill the plane at best");
    }
    if (auto error = check_radii(generator)) return error;
    if (!(generator.speed_rms_mps >= 0.0 && generator.speed_rms_mps <= 1e-3 * kMaxSpeedMps)) {
        return refuse_setting("speed_rms", text_of(generator.speed_rms_mps),
                              "give a speed from 0 to " + text_of(1e-3 * kMaxSpeedMps) + " m/s");
    }
    const bool needs_both = makes_boundary(scene);
    if (!generator.count && (needs_both || !fraction)) {
        return refuse_setting("count", "missing", "say how many balls to make");
    }
    if (needs_both && !fraction) {
        return refuse_setting(
            "packing_fraction", "missing",
            "say how densely to pack, or give walls, periodic or platform sides to fill");
    }
    return std::nullopt;
}

double covered_m2(const Scene& scene) {
    double sum = 0.0;
    for (const BodyDef& body : scene.bodies) sum += disc_area_m2(body.radius_m);
    return sum;
}

// Fewer than asked for only where the packing is reached first: by as nearly as whole balls can.
std::vector<double> draw_radii(const Generator& generator, double free_m2, SplitMix& random) {
    const std::size_t most =
        generator.count ? static_cast<std::size_t>(*generator.count) : kMaxBodies + 1;
    std::vector<double> radii_m;
    double covered = 0.0;
    while (radii_m.size() < most) {
        const double radius_m = random.between(generator.radius_min_m, generator.radius_max_m);
        const double area_m2 = disc_area_m2(radius_m);
        if (covered + 0.5 * area_m2 > free_m2) break;
        covered += area_m2;
        radii_m.push_back(radius_m);
    }
    return radii_m;
}

void make_boundary(Scene& scene, double area_m2) {
    const Vec2d half = Vec2d::Constant(0.5 * std::sqrt(area_m2));
    if (scene.periodic) {
        const Vec2d centre = scene.periodic->min_m;
        scene.periodic = Periodic{centre - half, centre + half};
        return;
    }
    const Vec2d centre = scene.walls ? scene.walls->min_m : Vec2d(Vec2d::Zero());
    scene.walls = Walls{centre - half, centre + half};
}

// Set when the widest balls do not fit between the sides, however few there are.
Verdict check_width(const Scene& scene, const Generator& generator, bool made) {
    double width_m = 0.0, radii_needed = 0.0;
    if (scene.periodic) {
        width_m = (scene.periodic->max_m - scene.periodic->min_m).minCoeff();
        radii_needed = kMinPeriodicWidthInRadii;
    } else if (scene.walls) {
        width_m = (scene.walls->max_m - scene.walls->min_m).minCoeff();
        radii_needed = 2.0 + kMinWallClearance;
    } else {
        return std::nullopt;
    }
    if (width_m >= radii_needed * generator.radius_max_m) return std::nullopt;
    if (made) {
        const double narrower = width_m / (radii_needed * generator.radius_max_m);
        return refuse_setting("packing_fraction", text_of(*generator.packing_fraction),
                              "so few balls would fill a box of less than " +
                                  text_of(radii_needed) + " radii; give at most " +
                                  at_most(*generator.packing_fraction * narrower * narrower) +
                                  ", or more balls");
    }
    return refuse_setting("radius_max", text_of(generator.radius_max_m),
                          "the sides are only " + text_of(width_m) + " m apart; give at most " +
                              text_of(width_m / radii_needed) + " m");
}

SceneError too_dense(const Generator& generator, const Region& region, std::size_t count,
                     bool made) {
    const std::string number = std::to_string(count);
    const double fraction = generator.packing_fraction.value_or(1.0);
    if (generator.radius_min_m < generator.radius_max_m) {
        const std::string remedy =
            "no room was found for " + number + " balls of such radii; give less";
        return generator.packing_fraction
                   ? refuse_setting("packing_fraction", text_of(fraction), remedy)
                   : refuse_setting("count", number, remedy);
    }
    const double radius_m = generator.radius_max_m;
    if (made) {
        const double ratio = lattice_radius_m(region, count) / radius_m;
        return refuse_setting(
            "packing_fraction", text_of(fraction),
            number + " equal balls fill a square to " +
                at_most(std::min(1.0, ratio * ratio) * fraction) +
                " as this generator packs them; give at most that, or another count");
    }
    const std::size_t capacity = lattice_capacity(region, radius_m);
    const std::string most = "give at most " + std::to_string(capacity) + ", or smaller radii";
    const bool count_decides =
        generator.count && count == static_cast<std::size_t>(*generator.count);
    if (count_decides) {
        return refuse_setting("count", number, "they find no room beside each other; " + most);
    }
    const double reachable =
        static_cast<double>(capacity) * disc_area_m2(radius_m) / region.area_m2();
    return refuse_setting("packing_fraction", text_of(fraction),
                          "the " + number +
                              " balls that it takes find no room beside each other; give at "
                              "most " +
                              at_most(reachable) + ", or smaller radii");
}

double nearly_normal(SplitMix& random) {
    double sum = -0.5 * kEvenNumbersPerComponent;
    for (int i = 0; i < kEvenNumbersPerComponent; ++i) sum += random.uniform();
    return sum;
}

void set_masses(std::vector<BodyDef>& balls, MassRule rule) {
    if (rule == MassRule::kEqual) return;
    double sum_m2 = 0.0;
    for (const BodyDef& ball : balls) sum_m2 += ball.radius_m * ball.radius_m;
    const double mean_m2 = sum_m2 / static_cast<double>(balls.size());
    for (BodyDef& ball : balls) ball.mass_kg = ball.radius_m * ball.radius_m / mean_m2;
}

void set_velocities(std::vector<BodyDef>& balls, double speed_rms_mps, SplitMix& random) {
    Vec2d momentum = Vec2d::Zero();
    double mass_kg = 0.0;
    for (BodyDef& ball : balls) {
        const double x = nearly_normal(random);
        ball.velocity_mps = {x, nearly_normal(random)};
        momentum += ball.mass_kg * ball.velocity_mps;
        mass_kg += ball.mass_kg;
    }
    double squares = 0.0;
    for (BodyDef& ball : balls) {
        if (balls.size() > 1) ball.velocity_mps -= momentum / mass_kg;
        squares += ball.velocity_mps.squaredNorm();
    }
    if (!(squares > 0.0)) return;
    const double scale = speed_rms_mps / std::sqrt(squares / static_cast<double>(balls.size()));
    for (BodyDef& ball : balls) ball.velocity_mps *= scale;
}

Verdict check_drawn(const Generator& generator, std::size_t drawn) {
    if (drawn > kMaxBodies) {
        return refuse_setting("packing_fraction", text_of(*generator.packing_fraction),
                              "that takes more than " + std::to_string(kMaxBodies) +
                                  " balls; give larger radii, less packing, or a count");
    }
    if (drawn > 0) return std::nullopt;
    return refuse_setting("packing_fraction", text_of(*generator.packing_fraction),
                          "that is less than one more ball covers; give more, or smaller radii");
}

}  // namespace

std::variant<Scene, SceneError> fill(Scene scene, const Generator& generator) {
    if (auto error = check_numbers(generator, scene)) return *error;
    const bool made = makes_boundary(scene);
    SplitMix random(generator.seed);
    std::vector<double> radii_m;
    if (made) {
        radii_m = draw_radii(generator, std::numeric_limits<double>::infinity(), random);
        double area_m2 = covered_m2(scene);
        for (const double radius_m : radii_m) area_m2 += disc_area_m2(radius_m);
        make_boundary(scene, area_m2 / *generator.packing_fraction);
    }
    if (auto error = validate(scene, Overlaps::kAccepted)) return *error;
    if (auto error = check_width(scene, generator, made)) return *error;
    const Region region = *region_of(scene);
    if (!made) {
        const double free_m2 =
            generator.packing_fraction
                ? *generator.packing_fraction * region.area_m2() - covered_m2(scene)
                : std::numeric_limits<double>::infinity();
        radii_m = draw_radii(generator, free_m2, random);
    }
    if (auto error = check_drawn(generator, radii_m.size())) return *error;

    const auto places = pack(region, radii_m, scene.bodies, random);
    if (!places) return too_dense(generator, region, radii_m.size(), made);
    std::vector<BodyDef> balls(radii_m.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
        balls[i].position_m = (*places)[i];
        balls[i].radius_m = radii_m[i];
    }
    set_masses(balls, generator.mass);
    set_velocities(balls, generator.speed_rms_mps, random);
    for (const BodyDef& ball : balls) {
        const std::string name = "generator's body[" + std::to_string(scene.bodies.size()) + "]";
        if (auto error = validate(ball, scene, name)) return *error;
        scene.bodies.push_back(ball);
    }
    return scene;
}

}  // namespace fts::physics
