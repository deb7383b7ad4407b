#include "common/physics/seed_equations.h"

#include <cmath>
#include <numbers>

namespace fts::physics::seed {
namespace {

template <typename Scalar>
Scalar distance_m(const Ball<Scalar>& first, const Ball<Scalar>& second) {
    return (first.centre_m - second.centre_m).norm();
}

template <typename Scalar>
Angles<Scalar> angles_by(Scalar (*angle)(Scalar, Scalar), const Ball<Scalar>& first,
                         const Ball<Scalar>& second) {
    const Vec2<Scalar> line = first.centre_m - second.centre_m;
    return {angle(line.y(), line.x()), angle(first.velocity_mps.y(), first.velocity_mps.x()),
            angle(second.velocity_mps.y(), second.velocity_mps.x())};
}

template <typename Scalar>
Scalar quarter_turn_rad() {
    return std::numbers::pi_v<Scalar> / Scalar(2);
}

// (18), (19) where 1 is the first ball; (20), (21) where 1 is the second.
template <typename Scalar>
Vec2<Scalar> master_of(Scalar v_1, Scalar theta_1, Scalar m_1, Scalar v_2, Scalar theta_2,
                       Scalar m_2, Scalar phi, Scalar e) {
    const Scalar along = (v_1 * std::cos(theta_1 - phi) * (m_1 - e * m_2) +
                          (Scalar(1) + e) * m_2 * v_2 * std::cos(theta_2 - phi)) /
                         (m_1 + m_2);
    const Scalar across = v_1 * std::sin(theta_1 - phi);
    return {along * std::cos(phi) + across * std::cos(phi + quarter_turn_rad<Scalar>()),
            along * std::sin(phi) + across * std::sin(phi + quarter_turn_rad<Scalar>())};
}

}  // namespace

template <typename Scalar>
bool in_contact_as_printed(const Ball<Scalar>& first, const Ball<Scalar>& second) {
    return first.radius_m + second.radius_m <= distance_m(first, second);
}

template <typename Scalar>
bool in_contact(const Ball<Scalar>& first, const Ball<Scalar>& second) {
    return first.radius_m + second.radius_m >= distance_m(first, second);
}

template <typename Scalar>
Vec2<Scalar> pushed_as_printed(const Vec2<Scalar>& first_centre_m,
                               const Vec2<Scalar>& second_centre_m) {
    const Vec2<Scalar> away = first_centre_m - second_centre_m;
    return first_centre_m + away.cwiseQuotient(away.cwiseAbs());
}

template <typename Scalar>
std::pair<Vec2<Scalar>, Vec2<Scalar>> pushed_apart(const Ball<Scalar>& first,
                                                   const Ball<Scalar>& second) {
    const Scalar gap_m = distance_m(first, second);
    const Scalar overlap_m = first.radius_m + second.radius_m - gap_m;
    if (!(overlap_m > Scalar(0)) || gap_m == Scalar(0)) return {first.centre_m, second.centre_m};
    const Vec2<Scalar> way = (first.centre_m - second.centre_m) * (overlap_m / gap_m);
    const Scalar total_kg = first.mass_kg + second.mass_kg;
    return {first.centre_m + way * (second.mass_kg / total_kg),
            second.centre_m - way * (first.mass_kg / total_kg)};
}

template <typename Scalar>
Turned<Scalar> turned(Scalar speed_mps, Scalar theta_rad, Scalar phi_rad) {
    return {speed_mps * std::cos(theta_rad - phi_rad), speed_mps * std::sin(theta_rad - phi_rad)};
}

template <typename Scalar>
Scalar angle_as_printed_rad(Scalar y, Scalar x) {
    return std::atan(y / x);
}

template <typename Scalar>
Scalar angle_rad(Scalar y, Scalar x) {
    return std::atan2(y, x);
}

template <typename Scalar>
Angles<Scalar> angles_as_printed(const Ball<Scalar>& first, const Ball<Scalar>& second) {
    return angles_by<Scalar>(angle_as_printed_rad, first, second);
}

template <typename Scalar>
Angles<Scalar> angles(const Ball<Scalar>& first, const Ball<Scalar>& second) {
    return angles_by<Scalar>(angle_rad, first, second);
}

template <typename Scalar>
Scalar exchanged_mps(Scalar own_mps, Scalar other_mps, Scalar own_kg, Scalar other_kg,
                     Scalar restitution) {
    return (own_mps * (own_kg - restitution * other_kg) +
            (Scalar(1) + restitution) * other_kg * other_mps) /
           (own_kg + other_kg);
}

template <typename Scalar>
Vec2<Scalar> turned_back(const Turned<Scalar>& velocity, Scalar phi_rad) {
    const Scalar phi_and_quarter_rad = phi_rad + quarter_turn_rad<Scalar>();
    return {velocity.along_mps * std::cos(phi_rad) +
                velocity.across_mps * std::cos(phi_and_quarter_rad),
            velocity.along_mps * std::sin(phi_rad) +
                velocity.across_mps * std::sin(phi_and_quarter_rad)};
}

template <typename Scalar>
Derivation<Scalar> derivation(const Ball<Scalar>& first, const Ball<Scalar>& second,
                              const Angles<Scalar>& angles, Scalar restitution) {
    Derivation<Scalar> d;
    d.first = turned(first.velocity_mps.norm(), angles.theta_1_rad, angles.phi_rad);
    d.second = turned(second.velocity_mps.norm(), angles.theta_2_rad, angles.phi_rad);
    d.first_along_mps = exchanged_mps(d.first.along_mps, d.second.along_mps, first.mass_kg,
                                      second.mass_kg, restitution);
    d.second_along_mps = exchanged_mps(d.second.along_mps, d.first.along_mps, second.mass_kg,
                                       first.mass_kg, restitution);
    d.after.first_mps =
        turned_back(Turned<Scalar>{d.first_along_mps, d.first.across_mps}, angles.phi_rad);
    d.after.second_mps =
        turned_back(Turned<Scalar>{d.second_along_mps, d.second.across_mps}, angles.phi_rad);
    return d;
}

template <typename Scalar>
Velocities<Scalar> master(const Ball<Scalar>& first, const Ball<Scalar>& second,
                          const Angles<Scalar>& angles, Scalar restitution) {
    const Scalar v_1 = first.velocity_mps.norm(), v_2 = second.velocity_mps.norm();
    return {master_of(v_1, angles.theta_1_rad, first.mass_kg, v_2, angles.theta_2_rad,
                      second.mass_kg, angles.phi_rad, restitution),
            master_of(v_2, angles.theta_2_rad, second.mass_kg, v_1, angles.theta_1_rad,
                      first.mass_kg, angles.phi_rad, restitution)};
}

template <typename Scalar>
Velocities<Scalar> after_collision_as_printed(const Ball<Scalar>& first,
                                              const Ball<Scalar>& second) {
    return master(first, second, angles_as_printed(first, second), Scalar(1));
}

template <typename Scalar>
Velocities<Scalar> after_collision(const Ball<Scalar>& first, const Ball<Scalar>& second,
                                   Scalar restitution) {
    if (!approach(first, second)) return {first.velocity_mps, second.velocity_mps};
    return master(first, second, angles(first, second), restitution);
}

template <typename Scalar>
bool approach(const Ball<Scalar>& first, const Ball<Scalar>& second) {
    return (first.centre_m - second.centre_m).dot(first.velocity_mps - second.velocity_mps) <
           Scalar(0);
}

template bool in_contact_as_printed(const Ball<double>&, const Ball<double>&);
template bool in_contact_as_printed(const Ball<float>&, const Ball<float>&);
template bool in_contact(const Ball<double>&, const Ball<double>&);
template bool in_contact(const Ball<float>&, const Ball<float>&);
template Vec2<double> pushed_as_printed(const Vec2<double>&, const Vec2<double>&);
template Vec2<float> pushed_as_printed(const Vec2<float>&, const Vec2<float>&);
template std::pair<Vec2<double>, Vec2<double>> pushed_apart(const Ball<double>&,
                                                            const Ball<double>&);
template std::pair<Vec2<float>, Vec2<float>> pushed_apart(const Ball<float>&, const Ball<float>&);
template Turned<double> turned(double, double, double);
template Turned<float> turned(float, float, float);
template double angle_as_printed_rad(double, double);
template float angle_as_printed_rad(float, float);
template double angle_rad(double, double);
template float angle_rad(float, float);
template Angles<double> angles_as_printed(const Ball<double>&, const Ball<double>&);
template Angles<float> angles_as_printed(const Ball<float>&, const Ball<float>&);
template Angles<double> angles(const Ball<double>&, const Ball<double>&);
template Angles<float> angles(const Ball<float>&, const Ball<float>&);
template double exchanged_mps(double, double, double, double, double);
template float exchanged_mps(float, float, float, float, float);
template Vec2<double> turned_back(const Turned<double>&, double);
template Vec2<float> turned_back(const Turned<float>&, float);
template Derivation<double> derivation(const Ball<double>&, const Ball<double>&,
                                       const Angles<double>&, double);
template Derivation<float> derivation(const Ball<float>&, const Ball<float>&, const Angles<float>&,
                                      float);
template Velocities<double> master(const Ball<double>&, const Ball<double>&, const Angles<double>&,
                                   double);
template Velocities<float> master(const Ball<float>&, const Ball<float>&, const Angles<float>&,
                                  float);
template Velocities<double> after_collision_as_printed(const Ball<double>&, const Ball<double>&);
template Velocities<float> after_collision_as_printed(const Ball<float>&, const Ball<float>&);
template Velocities<double> after_collision(const Ball<double>&, const Ball<double>&, double);
template Velocities<float> after_collision(const Ball<float>&, const Ball<float>&, float);
template bool approach(const Ball<double>&, const Ball<double>&);
template bool approach(const Ball<float>&, const Ball<float>&);

}  // namespace fts::physics::seed
