// Equations (1) to (21) of "Fear The Sphere" (D. Prorok, 2013), as printed, and beside each that
// has an erratum the corrected form. An oracle for one collision of two balls, and a museum:
// `impact.h` is what the simulation uses. Angles come from the C library, so the last bits may
// differ between machines.
//
// Where a printed form divides by zero it does so here as well and yields NaN; the corrected forms
// are finite for every finite input whose centres differ.
#pragma once

#include <utility>

#include "common/physics/scene.h"

namespace fts::physics::seed {

struct Ball {
    Vec2d centre_m;
    Vec2d velocity_mps;
    double radius_m = 0.0;
    double mass_kg = 0.0;  // finite
};

// (1) As printed, the inequality is the wrong way round: it holds while the balls are apart.
bool in_contact_as_printed(const Ball& first, const Ball& second);
bool in_contact(const Ball& first, const Ball& second);

// (2), (3) As printed, each coordinate of the first centre moves by one unit away from the
// second's, which is the diagonal and not the shortest path, and 0/0 where a coordinate is the
// same.
Vec2d pushed_as_printed(const Vec2d& first_centre_m, const Vec2d& second_centre_m);
// Along the line of centres until the balls touch, each by its inverse mass's share of the overlap.
// Balls that do not overlap, or whose centres coincide, stay where they are.
std::pair<Vec2d, Vec2d> pushed_apart(const Ball& first, const Ball& second);

// (8) to (10) As printed, arctan(y/x): loses the quadrant, and 0/0 for a ball at rest. Corrected:
// atan2.
double angle_as_printed_rad(double y, double x);
double angle_rad(double y, double x);

struct Velocities {
    Vec2d first_mps, second_mps;
};
// (18) to (21), the master equations, with (8) to (10) as printed, whether the balls approach or
// part.
Velocities after_collision_as_printed(const Ball& first, const Ball& second);
// With angles by atan2, and only while the balls approach: balls that part keep their velocities.
Velocities after_collision(const Ball& first, const Ball& second);

}  // namespace fts::physics::seed
