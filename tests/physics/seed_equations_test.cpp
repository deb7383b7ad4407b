#include "common/physics/seed_equations.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/physics/impact.h"
#include "tests/physics/dice.h"

namespace fts::physics::seed {
namespace {

using Balld = Ball<double>;

Balld ball(const Vec2d& centre_m, const Vec2d& velocity_mps, double mass_kg = 1.0) {
    return {centre_m, velocity_mps, 1.0, mass_kg};
}

bool is_finite(const Velocities<double>& velocities) {
    return velocities.first_mps.allFinite() && velocities.second_mps.allFinite();
}

TEST(SeedEquations, the_master_equations_agree_with_the_vector_form) {
    constexpr std::uint64_t kSeed = 2013;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    int collisions = 0;
    for (int i = 0; i < 20000; ++i) {
        const Balld a = ball(dice.in_box(1), dice.in_box(5), dice.of_any_size(1e-2, 1e2));
        const Balld b = ball(dice.in_box(1), dice.in_box(5), dice.of_any_size(1e-2, 1e2));
        const auto hit = impact<double>({a.centre_m, a.velocity_mps, a.mass_kg},
                                        {b.centre_m, b.velocity_mps, b.mass_kg}, 1.0);
        const Velocities<double> after = after_collision(a, b);
        if (!hit) {
            EXPECT_EQ(after.first_mps, a.velocity_mps);
            EXPECT_EQ(after.second_mps, b.velocity_mps);
            continue;
        }
        ++collisions;
        const double scale_mps = 10.0 * (a.velocity_mps.norm() + b.velocity_mps.norm());
        EXPECT_LE((after.first_mps - hit->velocity_1_mps).norm(), 1e-14 * scale_mps);
        EXPECT_LE((after.second_mps - hit->velocity_2_mps).norm(), 1e-14 * scale_mps);
    }
    EXPECT_GT(collisions, 5000);
}

struct Collision {
    Balld a, b;
    Vec2d normal;  // from b to a
};

Collision random_collision(Dice& dice) {
    Collision c;
    do {
        c.a = ball(dice.in_box(1), dice.in_box(5), dice.of_any_size(1e-2, 1e2));
        c.b = ball(dice.in_box(1), dice.in_box(5), dice.of_any_size(1e-2, 1e2));
    } while (!approach(c.a, c.b));
    c.normal = (c.a.centre_m - c.b.centre_m).normalized();
    return c;
}

double across(const Vec2d& normal, const Vec2d& velocity_mps) {
    return normal.x() * velocity_mps.y() - normal.y() * velocity_mps.x();
}

TEST(SeedEquations, four_to_seven_are_the_parts_along_and_across_the_line_of_centres) {
    constexpr std::uint64_t kSeed = 47;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 2000; ++i) {
        const auto [a, b, normal] = random_collision(dice);
        const auto d = derivation(a, b, angles(a, b));
        EXPECT_NEAR(d.first.along_mps, a.velocity_mps.dot(normal), 1e-13);
        EXPECT_NEAR(d.first.across_mps, across(normal, a.velocity_mps), 1e-13);
        EXPECT_NEAR(d.second.along_mps, b.velocity_mps.dot(normal), 1e-13);
        EXPECT_NEAR(d.second.across_mps, across(normal, b.velocity_mps), 1e-13);
    }
}

TEST(SeedEquations, eight_to_ten_corrected_point_where_the_vectors_point) {
    constexpr std::uint64_t kSeed = 810;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 2000; ++i) {
        const auto [a, b, normal] = random_collision(dice);
        const Angles<double> angle = angles(a, b);
        const auto direction = [](double rad) { return Vec2d(std::cos(rad), std::sin(rad)); };
        EXPECT_LE((direction(angle.phi_rad) - normal).norm(), 1e-15 * 4);
        EXPECT_LE((direction(angle.theta_1_rad) - a.velocity_mps.normalized()).norm(), 4e-15);
        EXPECT_LE((direction(angle.theta_2_rad) - b.velocity_mps.normalized()).norm(), 4e-15);
    }
}

TEST(SeedEquations, eleven_keeps_momentum_and_energy_and_has_the_limits_that_the_paper_names) {
    constexpr std::uint64_t kSeed = 11;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 2000; ++i) {
        const double m_1 = dice.of_any_size(1e-3, 1e3), m_2 = dice.of_any_size(1e-3, 1e3);
        const double v_1 = dice.between(-5, 5), v_2 = dice.between(-5, 5);
        const double f_1 = exchanged_mps(v_1, v_2, m_1, m_2);
        const double f_2 = exchanged_mps(v_2, v_1, m_2, m_1);
        EXPECT_NEAR(m_1 * f_1 + m_2 * f_2, m_1 * v_1 + m_2 * v_2, 1e-13 * (m_1 + m_2));
        EXPECT_NEAR(f_1 - f_2, -(v_1 - v_2), 1e-13);
    }
    EXPECT_NEAR(exchanged_mps(3.0, 0.0, 1e12, 1.0), 3.0, 1e-11) << "M1 >> M2: unaffected";
    EXPECT_NEAR(exchanged_mps(3.0, 0.0, 1.0, 1e12), -3.0, 1e-11) << "M1 << M2: becomes -v1";
    EXPECT_EQ(exchanged_mps(3.0, 1.0, 2.0, 2.0, 0.0), 2.0) << "plastic: they go on together";
}

TEST(SeedEquations, twelve_and_thirteen_are_the_vector_forms_velocities_along_the_line) {
    constexpr std::uint64_t kSeed = 1213;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 2000; ++i) {
        const auto [a, b, normal] = random_collision(dice);
        const auto hit = impact<double>({a.centre_m, a.velocity_mps, a.mass_kg},
                                        {b.centre_m, b.velocity_mps, b.mass_kg}, 1.0);
        ASSERT_TRUE(hit);
        const auto d = derivation(a, b, angles(a, b));
        EXPECT_NEAR(d.first_along_mps, hit->velocity_1_mps.dot(normal), 1e-12);
        EXPECT_NEAR(d.second_along_mps, hit->velocity_2_mps.dot(normal), 1e-12);
    }
}

TEST(SeedEquations, fourteen_to_seventeen_undo_four_to_seven) {
    constexpr std::uint64_t kSeed = 1417;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 2000; ++i) {
        const Vec2d velocity = dice.in_box(5);
        const double phi = dice.between(-4, 4);
        const double theta = angle_rad(velocity.y(), velocity.x());
        const Vec2d there_and_back = turned_back(turned(velocity.norm(), theta, phi), phi);
        EXPECT_LE((there_and_back - velocity).norm(), 1e-14 * 5);
    }
}

TEST(SeedEquations, eighteen_to_twenty_one_are_what_the_derivation_arrives_at) {
    constexpr std::uint64_t kSeed = 1821;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 2000; ++i) {
        const auto [a, b, normal] = random_collision(dice);
        for (const Angles<double>& angle : {angles(a, b), angles_as_printed(a, b)}) {
            const Velocities<double> steps = derivation(a, b, angle).after;
            const Velocities<double> at_once = master(a, b, angle);
            EXPECT_LE((steps.first_mps - at_once.first_mps).norm(), 1e-12);
            EXPECT_LE((steps.second_mps - at_once.second_mps).norm(), 1e-12);
        }
    }
}

TEST(SeedEquations, in_single_precision_agree_with_double_to_single_round_off_and_no_further) {
    constexpr std::uint64_t kSeed = 32;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const auto [a, b, normal] = random_collision(dice);
        const Ball<float> a_float{a.centre_m.cast<float>(), a.velocity_mps.cast<float>(), 1.0F,
                                  static_cast<float>(a.mass_kg)};
        const Ball<float> b_float{b.centre_m.cast<float>(), b.velocity_mps.cast<float>(), 1.0F,
                                  static_cast<float>(b.mass_kg)};
        const auto in_double = master(a, b, angles(a, b));
        const auto in_float = master(a_float, b_float, angles(a_float, b_float));
        const double scale_mps = a.velocity_mps.norm() + b.velocity_mps.norm();
        worst = std::max(
            worst, (in_float.first_mps.cast<double>() - in_double.first_mps).norm() / scale_mps);
    }
    EXPECT_LE(worst, 1e-4);
    EXPECT_GE(worst, 1e-8);
}

TEST(SeedEquations, one_as_printed_finds_contact_while_the_balls_are_apart) {
    const Balld apart = ball({5, 0}, {0, 0});
    const Balld overlapping = ball({1, 0}, {0, 0});
    const Balld touching = ball({2, 0}, {0, 0});
    const Balld origin = ball({0, 0}, {0, 0});
    EXPECT_TRUE(in_contact_as_printed(origin, apart));
    EXPECT_FALSE(in_contact_as_printed(origin, overlapping));
    EXPECT_FALSE(in_contact(origin, apart));
    EXPECT_TRUE(in_contact(origin, overlapping));
    EXPECT_TRUE(in_contact(origin, touching));
}

TEST(SeedEquations,
     two_and_three_as_printed_push_along_the_diagonal_and_fail_on_equal_coordinates) {
    const Vec2d away = pushed_as_printed<double>({1.0, 0.1}, {0.0, 0.0}) - Vec2d(1.0, 0.1);
    EXPECT_EQ(away, Vec2d(1.0, 1.0)) << "the shortest path is along (1, 0.1)";
    EXPECT_TRUE(std::isnan(pushed_as_printed<double>({1.0, 0.0}, {0.0, 0.0}).y()));
}

TEST(SeedEquations, two_and_three_corrected_take_the_shortest_path_and_keep_the_centre_of_mass) {
    for (const Vec2d& centre : {Vec2d(1.0, 0.1), Vec2d(1.0, 0.0), Vec2d(-0.2, 0.9)}) {
        const Balld first = ball(centre, {0, 0}, 3.0);
        const Balld second = ball({0, 0}, {0, 0}, 1.0);
        const auto [a, b] = pushed_apart(first, second);
        EXPECT_NEAR((a - b).norm(), 2.0, 1e-14);
        EXPECT_NEAR((a - b).normalized().dot(centre.normalized()), 1.0, 1e-14);
        EXPECT_LE((3.0 * a + b - 3.0 * centre).norm(), 1e-14);
    }
    const auto [same_a, same_b] = pushed_apart(ball({1, 1}, {0, 0}), ball({1, 1}, {0, 0}));
    EXPECT_EQ(same_a, same_b) << "no line of centres, nowhere to go";
}

TEST(SeedEquations, eight_to_ten_as_printed_lose_the_quadrant) {
    EXPECT_EQ(angle_as_printed_rad(1.0, -1.0), angle_as_printed_rad(-1.0, 1.0));
    EXPECT_NE(angle_rad(1.0, -1.0), angle_rad(-1.0, 1.0));
    // A ball that comes from the right is taken for one that comes from the left.
    const Balld comes = ball({2, 0}, {-3, 0});
    const Balld waits = ball({0, 0}, {1, 0});
    EXPECT_NEAR(after_collision_as_printed(comes, waits).second_mps.x(), 3.0, 1e-14);
    EXPECT_NEAR(after_collision(comes, waits).second_mps.x(), -3.0, 1e-14);
}

TEST(SeedEquations, eight_to_ten_as_printed_are_not_a_number_for_a_ball_at_rest) {
    const Balld comes = ball({-2, 0}, {3, 0});
    const Balld rests = ball({0, 0}, {0, 0});
    EXPECT_FALSE(is_finite(after_collision_as_printed(comes, rests)));
    const Velocities<double> after = after_collision(comes, rests);
    EXPECT_NEAR(after.first_mps.norm(), 0.0, 1e-14);
    EXPECT_NEAR(after.second_mps.x(), 3.0, 1e-14);
}

TEST(SeedEquations, balls_that_part_already_are_turned_round_again_as_printed) {
    const Balld left = ball({-1, 0.5}, {-2, 0.1});
    const Balld right = ball({1, 0.5}, {2, 0.1});
    const Velocities<double> printed =
        after_collision_as_printed(ball({-1, 0.5}, {2, 0.1}), ball({1, 0.5}, {3, 0.1}));
    EXPECT_GT(printed.first_mps.x(), printed.second_mps.x()) << "they parted, now they approach";
    const Velocities<double> corrected = after_collision(left, right);
    EXPECT_EQ(corrected.first_mps, left.velocity_mps);
    EXPECT_EQ(corrected.second_mps, right.velocity_mps);
}

}  // namespace
}  // namespace fts::physics::seed
