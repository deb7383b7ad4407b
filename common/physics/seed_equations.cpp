#include "common/physics/seed_equations.h"

#include <cmath>
#include <numbers>

namespace fts::physics::seed {
namespace {

using Angle = double (*)(double y, double x);

double distance_m(const Ball& first, const Ball& second) {
    return (first.centre_m - second.centre_m).norm();
}

// (4) to (7): a velocity in axes turned by the contact angle.
struct Turned {
    double along_mps = 0.0;
    double across_mps = 0.0;
};

Turned turned(const Vec2d& velocity_mps, double phi_rad, Angle angle) {
    const double speed_mps = velocity_mps.norm();
    const double theta_rad = angle(velocity_mps.y(), velocity_mps.x());
    return {speed_mps * std::cos(theta_rad - phi_rad), speed_mps * std::sin(theta_rad - phi_rad)};
}

// (11) to (13): the collision in one dimension.
double exchanged_mps(double own_mps, double other_mps, double own_kg, double other_kg) {
    return (own_mps * (own_kg - other_kg) + 2.0 * other_kg * other_mps) / (own_kg + other_kg);
}

// (14) to (17): back to the natural axes.
Vec2d turned_back(double along_mps, double across_mps, double phi_rad) {
    const double quarter_rad = phi_rad + std::numbers::pi / 2.0;
    return {along_mps * std::cos(phi_rad) + across_mps * std::cos(quarter_rad),
            along_mps * std::sin(phi_rad) + across_mps * std::sin(quarter_rad)};
}

Velocities collided(const Ball& first, const Ball& second, Angle angle) {
    const Vec2d line = first.centre_m - second.centre_m;
    const double phi_rad = angle(line.y(), line.x());
    const Turned one = turned(first.velocity_mps, phi_rad, angle);
    const Turned two = turned(second.velocity_mps, phi_rad, angle);
    const double one_after =
        exchanged_mps(one.along_mps, two.along_mps, first.mass_kg, second.mass_kg);
    const double two_after =
        exchanged_mps(two.along_mps, one.along_mps, second.mass_kg, first.mass_kg);
    return {turned_back(one_after, one.across_mps, phi_rad),
            turned_back(two_after, two.across_mps, phi_rad)};
}

}  // namespace

bool in_contact_as_printed(const Ball& first, const Ball& second) {
    return first.radius_m + second.radius_m <= distance_m(first, second);
}

bool in_contact(const Ball& first, const Ball& second) {
    return first.radius_m + second.radius_m >= distance_m(first, second);
}

Vec2d pushed_as_printed(const Vec2d& first_centre_m, const Vec2d& second_centre_m) {
    const Vec2d away = first_centre_m - second_centre_m;
    return first_centre_m + away.cwiseQuotient(away.cwiseAbs());
}

std::pair<Vec2d, Vec2d> pushed_apart(const Ball& first, const Ball& second) {
    const double gap_m = distance_m(first, second);
    const double overlap_m = first.radius_m + second.radius_m - gap_m;
    if (!(overlap_m > 0.0) || gap_m == 0.0) return {first.centre_m, second.centre_m};
    const Vec2d way = (first.centre_m - second.centre_m) * (overlap_m / gap_m);
    const double total_kg = first.mass_kg + second.mass_kg;
    return {first.centre_m + way * (second.mass_kg / total_kg),
            second.centre_m - way * (first.mass_kg / total_kg)};
}

double angle_as_printed_rad(double y, double x) {
    return std::atan(y / x);
}

double angle_rad(double y, double x) {
    return std::atan2(y, x);
}

Velocities after_collision_as_printed(const Ball& first, const Ball& second) {
    return collided(first, second, angle_as_printed_rad);
}

Velocities after_collision(const Ball& first, const Ball& second) {
    const bool approach =
        (first.centre_m - second.centre_m).dot(first.velocity_mps - second.velocity_mps) < 0.0;
    if (!approach) return {first.velocity_mps, second.velocity_mps};
    return collided(first, second, angle_rad);
}

}  // namespace fts::physics::seed
