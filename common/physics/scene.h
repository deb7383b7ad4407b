// A scene is what is modelled, as a value: bodies, what bounds them, drag and restitution. It holds
// no state of a running simulation (see world.h) and knows no player, tick rate, byte or clock.
//
// Units: metres, kilograms, seconds. A scene that comes from outside may hold anything; `validate`
// must accept it before a World is made of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace fts::physics {

template <typename Scalar>
using Vec2 = Eigen::Matrix<Scalar, 2, 1>;
using Vec2d = Vec2<double>;

struct BodyDef {
    Vec2d position_m = Vec2d::Zero();
    Vec2d velocity_mps = Vec2d::Zero();
    double radius_m = 0.5;
    // Up to infinity, which no collision moves; such a body passes through walls and its like.
    double mass_kg = 1.0;
};

// Platforms: a body whose centre leaves one falls, at the exact time of the crossing, and is
// removed. All are centred on the origin.
struct Disc {
    double radius_m = 0.0;
};
struct Rectangle {
    Vec2d half_extents_m = Vec2d::Zero();
};
struct Ring {  // a disc with a concentric hole; a body may fall on either side
    double inner_radius_m = 0.0;
    double outer_radius_m = 0.0;
};
using Platform = std::variant<Disc, Rectangle, Ring>;

// Elastic walls that keep each body's disc inside the box.
struct Walls {
    Vec2d min_m = Vec2d::Zero();
    Vec2d max_m = Vec2d::Zero();
};

// A box whose opposite sides are one: what leaves on one side enters on the other. The world keeps
// positions inside it.
struct Periodic {
    Vec2d min_m = Vec2d::Zero();
    Vec2d max_m = Vec2d::Zero();
};

// A periodic scene has neither walls nor a platform.
struct Scene {
    std::vector<BodyDef> bodies;
    std::optional<Walls> walls;
    std::optional<Periodic> periodic;
    std::optional<Platform> platform;
    double restitution = 1.0;  // [0, 1]
    // Linear drag on every body, dv/dt = -drag v, beside what its Control says.
    double drag_per_s = 0.0;  // [0, kMaxDragPerS]
};

// What is wrong with a scene, in words that name field, value and remedy:
// "body[3].radius_m is -1; give a finite radius above 0".
struct SceneError {
    std::string field;
    std::string message;
};

// A game refuses bodies that start inside each other. A study may want them: such a pair collides
// while it approaches and is left alone while it parts.
enum class Overlaps : std::uint8_t { kRefused, kAccepted };

std::optional<SceneError> validate(const Scene& scene, Overlaps overlaps = Overlaps::kRefused);
// One body alone against the scene's boundary; the scene's own bodies are not looked at. `name` is
// how the message calls it.
std::optional<SceneError> validate(const BodyDef& body, const Scene& scene,
                                   const std::string& name);

// What a scene may hold. Within these no square overflows, in single precision either.
inline constexpr double kMaxCoordinateM = 1e9;
inline constexpr double kMaxSpeedMps = 1e9;
inline constexpr double kMinRadiusM = 1e-6;
inline constexpr double kMaxRadiusM = 1e8;
inline constexpr double kMinMassKg = 1e-9;
inline constexpr double kMaxMassKg = 1e15;  // or infinite
inline constexpr std::size_t kMaxBodies = 1'000'000;
// Bodies may touch: an overlap up to this part of the sum of radii is round-off and accepted.
inline constexpr double kTouchTolerance = 1e-12;
// A box must be wider than its largest ball by this part of the ball's radius, or the ball would
// hit both walls without end.
inline constexpr double kMinWallClearance = 0.01;
// A periodic box is wider than so many of its largest radius, so that two balls touch through one
// image only.
inline constexpr double kMinPeriodicWidthInRadii = 4.01;
inline constexpr double kMaxDragPerS = 1e6;

// Signed distance from a point to the nearest edge of the platform, metres; positive inside.
double distance_to_edge_m(const Platform& platform, const Vec2d& point_m);
// The point of the platform's edge nearest to `point_m`.
Vec2d nearest_edge_point_m(const Platform& platform, const Vec2d& point_m);
// Radius of the smallest disc about the origin that holds the whole platform.
double bounding_radius_m(const Platform& platform);

}  // namespace fts::physics
