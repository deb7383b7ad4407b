#include "common/physics/seed_equations.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/physics/impact.h"
#include "tests/physics/dice.h"

namespace fts::physics::seed {
namespace {

Ball ball(const Vec2d& centre_m, const Vec2d& velocity_mps, double mass_kg = 1.0) {
    return {centre_m, velocity_mps, 1.0, mass_kg};
}

bool is_finite(const Velocities& velocities) {
    return velocities.first_mps.allFinite() && velocities.second_mps.allFinite();
}

TEST(SeedEquations, the_master_equations_agree_with_the_vector_form) {
    constexpr std::uint64_t kSeed = 2013;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    int collisions = 0;
    for (int i = 0; i < 20000; ++i) {
        const Ball a = ball(dice.in_box(1), dice.in_box(5), dice.of_any_size(1e-2, 1e2));
        const Ball b = ball(dice.in_box(1), dice.in_box(5), dice.of_any_size(1e-2, 1e2));
        const auto hit = impact<double>({a.centre_m, a.velocity_mps, a.mass_kg},
                                        {b.centre_m, b.velocity_mps, b.mass_kg}, 1.0);
        const Velocities after = after_collision(a, b);
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

TEST(SeedEquations, one_as_printed_finds_contact_while_the_balls_are_apart) {
    const Ball apart = ball({5, 0}, {0, 0});
    const Ball overlapping = ball({1, 0}, {0, 0});
    const Ball touching = ball({2, 0}, {0, 0});
    const Ball origin = ball({0, 0}, {0, 0});
    EXPECT_TRUE(in_contact_as_printed(origin, apart));
    EXPECT_FALSE(in_contact_as_printed(origin, overlapping));
    EXPECT_FALSE(in_contact(origin, apart));
    EXPECT_TRUE(in_contact(origin, overlapping));
    EXPECT_TRUE(in_contact(origin, touching));
}

TEST(SeedEquations,
     two_and_three_as_printed_push_along_the_diagonal_and_fail_on_equal_coordinates) {
    const Vec2d away = pushed_as_printed({1.0, 0.1}, {0.0, 0.0}) - Vec2d(1.0, 0.1);
    EXPECT_EQ(away, Vec2d(1.0, 1.0)) << "the shortest path is along (1, 0.1)";
    EXPECT_TRUE(std::isnan(pushed_as_printed({1.0, 0.0}, {0.0, 0.0}).y()));
}

TEST(SeedEquations, two_and_three_corrected_take_the_shortest_path_and_keep_the_centre_of_mass) {
    for (const Vec2d& centre : {Vec2d(1.0, 0.1), Vec2d(1.0, 0.0), Vec2d(-0.2, 0.9)}) {
        const Ball first = ball(centre, {0, 0}, 3.0);
        const Ball second = ball({0, 0}, {0, 0}, 1.0);
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
    const Ball comes = ball({2, 0}, {-3, 0});
    const Ball waits = ball({0, 0}, {1, 0});
    EXPECT_NEAR(after_collision_as_printed(comes, waits).second_mps.x(), 3.0, 1e-14);
    EXPECT_NEAR(after_collision(comes, waits).second_mps.x(), -3.0, 1e-14);
}

TEST(SeedEquations, eight_to_ten_as_printed_are_not_a_number_for_a_ball_at_rest) {
    const Ball comes = ball({-2, 0}, {3, 0});
    const Ball rests = ball({0, 0}, {0, 0});
    EXPECT_FALSE(is_finite(after_collision_as_printed(comes, rests)));
    const Velocities after = after_collision(comes, rests);
    EXPECT_NEAR(after.first_mps.norm(), 0.0, 1e-14);
    EXPECT_NEAR(after.second_mps.x(), 3.0, 1e-14);
}

TEST(SeedEquations, balls_that_part_already_are_turned_round_again_as_printed) {
    const Ball left = ball({-1, 0.5}, {-2, 0.1});
    const Ball right = ball({1, 0.5}, {2, 0.1});
    const Velocities printed =
        after_collision_as_printed(ball({-1, 0.5}, {2, 0.1}), ball({1, 0.5}, {3, 0.1}));
    EXPECT_GT(printed.first_mps.x(), printed.second_mps.x()) << "they parted, now they approach";
    const Velocities corrected = after_collision(left, right);
    EXPECT_EQ(corrected.first_mps, left.velocity_mps);
    EXPECT_EQ(corrected.second_mps, right.velocity_mps);
}

}  // namespace
}  // namespace fts::physics::seed
