#include "common/physics/impact.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/physics/dice.h"
#include "tests/physics/values.h"

namespace fts::physics {
namespace {

TEST(Impact, equal_masses_head_on_exchange_velocities) {
    const auto hit = impact<double>({{-1, 0}, {3, 0}, 2.0}, {{1, 0}, {-1, 0}, 2.0}, 1.0);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->velocity_1_mps, Vec2d(-1, 0));
    EXPECT_EQ(hit->velocity_2_mps, Vec2d(3, 0));
    EXPECT_EQ(hit->normal, Vec2d(-1, 0));
    EXPECT_DOUBLE_EQ(hit->impulse_ns, 8.0);
}

TEST(Impact, equal_masses_off_centre_part_at_a_right_angle) {
    const auto hit = impact<double>({{-1, 0.3}, {3, 0}, 1.0}, {{1, -0.4}, {0, 0}, 1.0}, 1.0);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->velocity_1_mps.dot(hit->velocity_2_mps), 0.0, 1e-15);
}

TEST(Impact, an_infinite_mass_is_not_moved_and_reflects) {
    const auto hit = impact<double>({{-1, 0}, {3, 2}, 1.0}, {{1, 0}, {0, 0}, kInfinite}, 1.0);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->velocity_1_mps, Vec2d(-3, 2));
    EXPECT_EQ(hit->velocity_2_mps, Vec2d(0, 0));
    const auto moving = impact<double>({{-1, 0}, {1, 0}, kInfinite}, {{1, 0}, {0, 0}, 1.0}, 1.0);
    ASSERT_TRUE(moving);
    EXPECT_EQ(moving->velocity_1_mps, Vec2d(1, 0));
    EXPECT_EQ(moving->velocity_2_mps, Vec2d(2, 0));
}

TEST(Impact, two_infinite_masses_do_not_act_on_each_other) {
    EXPECT_FALSE(impact<double>({{-1, 0}, {3, 0}, kInfinite}, {{1, 0}, {0, 0}, kInfinite}, 1.0));
}

TEST(Impact, nothing_happens_unless_they_approach) {
    EXPECT_FALSE(impact<double>({{-1, 0}, {-3, 0}, 1.0}, {{1, 0}, {0, 0}, 1.0}, 1.0));
    EXPECT_FALSE(impact<double>({{-1, 0}, {0, 1}, 1.0}, {{1, 0}, {0, 0}, 1.0}, 1.0));
    EXPECT_FALSE(impact<double>({{1, 0}, {0, 1}, 1.0}, {{1, 0}, {0, 0}, 1.0}, 1.0));
}

TEST(Impact, conserves_energy_and_momentum_at_any_mass_ratio) {
    constexpr std::uint64_t kSeed = 5;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 20000; ++i) {
        const Mover<double> a{dice.in_box(1), dice.in_box(5), dice.of_any_size(1e-6, 1e6)};
        const Mover<double> b{dice.in_box(1), dice.in_box(5), dice.of_any_size(1e-6, 1e6)};
        const auto hit = impact(a, b, 1.0);
        if (!hit) continue;
        const double energy =
            a.mass_kg * a.velocity_mps.squaredNorm() + b.mass_kg * b.velocity_mps.squaredNorm();
        const double energy_after = a.mass_kg * hit->velocity_1_mps.squaredNorm() +
                                    b.mass_kg * hit->velocity_2_mps.squaredNorm();
        ASSERT_NEAR(energy_after / energy, 1.0, 1e-13);
        const Vec2d p = a.mass_kg * a.velocity_mps + b.mass_kg * b.velocity_mps;
        const Vec2d p_after = a.mass_kg * hit->velocity_1_mps + b.mass_kg * hit->velocity_2_mps;
        const double scale = a.mass_kg * a.velocity_mps.norm() + b.mass_kg * b.velocity_mps.norm();
        ASSERT_LE((p_after - p).norm(), 1e-14 * scale);
        ASSERT_GT(hit->impulse_ns, 0.0);
    }
}

TEST(Impact, restitution_scales_the_speed_at_which_they_part) {
    for (const double e : {0.0, 0.25, 1.0}) {
        const auto hit = impact<double>({{-1, 0}, {3, 0}, 2.0}, {{1, 0}, {-1, 0}, 5.0}, e);
        ASSERT_TRUE(hit);
        EXPECT_NEAR((hit->velocity_2_mps - hit->velocity_1_mps).x(), 4.0 * e, 1e-15);
    }
}

}  // namespace
}  // namespace fts::physics
