// Equations (1) to (21) of "Fear The Sphere" (D. Prorok, 2013), as printed, and beside each that
// has an erratum the corrected form. An oracle for one collision of two balls, and a museum:
// `impact.h` is what the simulation uses. Angles come from the C library, so the last bits may
// differ between machines.
//
// Where a printed form divides by zero it does so here as well and yields NaN; the corrected forms
// are finite for every finite input whose centres differ. Equations for the second ball that are
// those of the first with the indices exchanged are one function here.
#pragma once

#include <utility>

#include "common/physics/scene.h"

namespace fts::physics::seed {

template <typename Scalar>
struct Ball {
    Vec2<Scalar> centre_m;
    Vec2<Scalar> velocity_mps;
    Scalar radius_m = Scalar(0);
    Scalar mass_kg = Scalar(0);  // finite, and not 0 for both
};

// (1) As printed, the inequality is the wrong way round: it holds while the balls are apart.
template <typename Scalar>
bool in_contact_as_printed(const Ball<Scalar>& first, const Ball<Scalar>& second);
template <typename Scalar>
bool in_contact(const Ball<Scalar>& first, const Ball<Scalar>& second);

// (2), (3) As printed, each coordinate of the first centre moves by one unit away from the
// second's, which is the diagonal and not the shortest path, and 0/0 where a coordinate is the
// same.
template <typename Scalar>
Vec2<Scalar> pushed_as_printed(const Vec2<Scalar>& first_centre_m,
                               const Vec2<Scalar>& second_centre_m);
// Along the line of centres until the balls touch, each by its inverse mass's share of the overlap.
// Balls that do not overlap, or whose centres coincide, stay where they are.
template <typename Scalar>
std::pair<Vec2<Scalar>, Vec2<Scalar>> pushed_apart(const Ball<Scalar>& first,
                                                   const Ball<Scalar>& second);

// (4), (5) of the first ball, (6), (7) of the second: a velocity in axes turned by the contact
// angle.
template <typename Scalar>
struct Turned {
    Scalar along_mps = Scalar(0);   // x_r, the line of centres
    Scalar across_mps = Scalar(0);  // y_r
};
template <typename Scalar>
Turned<Scalar> turned(Scalar speed_mps, Scalar theta_rad, Scalar phi_rad);

// (8) to (10) As printed, arctan(y/x): loses the quadrant, and 0/0 for a ball at rest. Corrected:
// atan2.
template <typename Scalar>
Scalar angle_as_printed_rad(Scalar y, Scalar x);
template <typename Scalar>
Scalar angle_rad(Scalar y, Scalar x);

template <typename Scalar>
struct Angles {
    Scalar phi_rad, theta_1_rad, theta_2_rad;
};
template <typename Scalar>
Angles<Scalar> angles_as_printed(const Ball<Scalar>& first, const Ball<Scalar>& second);
template <typename Scalar>
Angles<Scalar> angles(const Ball<Scalar>& first, const Ball<Scalar>& second);

// (11) A perfectly elastic collision in one dimension; with a restitution e below 1, which the
// paper has not, M1 - M2 becomes M1 - e M2 and 2 M2 becomes (1 + e) M2.
template <typename Scalar>
Scalar exchanged_mps(Scalar own_mps, Scalar other_mps, Scalar own_kg, Scalar other_kg,
                     Scalar restitution = Scalar(1));

// (14), (15) of the first ball, (16), (17) of the second: back to the natural axes.
template <typename Scalar>
Vec2<Scalar> turned_back(const Turned<Scalar>& velocity, Scalar phi_rad);

template <typename Scalar>
struct Velocities {
    Vec2<Scalar> first_mps, second_mps;
};

// Equation by equation: what the paper's derivation has on its way.
template <typename Scalar>
struct Derivation {
    Turned<Scalar> first, second;  // (4) to (7)
    Scalar first_along_mps = Scalar(0),
           second_along_mps = Scalar(0);  // (12), (13): (11) of (4) and (6)
    Velocities<Scalar> after;             // (14) to (17)
};
template <typename Scalar>
Derivation<Scalar> derivation(const Ball<Scalar>& first, const Ball<Scalar>& second,
                              const Angles<Scalar>& angles, Scalar restitution = Scalar(1));

// (18) to (21), the master equations, whether the balls approach or part.
template <typename Scalar>
Velocities<Scalar> master(const Ball<Scalar>& first, const Ball<Scalar>& second,
                          const Angles<Scalar>& angles, Scalar restitution = Scalar(1));

// The master equations with (8) to (10) as printed.
template <typename Scalar>
Velocities<Scalar> after_collision_as_printed(const Ball<Scalar>& first,
                                              const Ball<Scalar>& second);
// With angles by atan2, and only while the balls approach: balls that part keep their velocities.
template <typename Scalar>
Velocities<Scalar> after_collision(const Ball<Scalar>& first, const Ball<Scalar>& second,
                                   Scalar restitution = Scalar(1));
template <typename Scalar>
bool approach(const Ball<Scalar>& first, const Ball<Scalar>& second);

}  // namespace fts::physics::seed
