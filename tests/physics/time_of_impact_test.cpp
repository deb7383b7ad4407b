#include "common/physics/time_of_impact.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/physics/dice.h"

namespace fts::physics {
namespace {

TEST(TimeOfImpact, balls_meet_when_their_surfaces_touch) {
    EXPECT_DOUBLE_EQ(time_until_contact<double>({-5, 0}, {2, 0}, 1.0), 2.0);
    EXPECT_DOUBLE_EQ(time_until_contact<double>({0, 5}, {0, -8}, 1.0), 0.5);
    // Sides 3-4-5: centres pass at 3, contact at distance 5, so 4 are left to the closest point.
    EXPECT_DOUBLE_EQ(time_until_contact<double>({-10, 3}, {1, 0}, 5.0), 6.0);
}

TEST(TimeOfImpact, receding_balls_never_meet_even_when_they_overlap) {
    EXPECT_EQ(time_until_contact<double>({-5, 0}, {-2, 0}, 1.0), kNever<double>);
    EXPECT_EQ(time_until_contact<double>({-0.5, 0}, {-2, 0}, 1.0), kNever<double>);
    EXPECT_EQ(time_until_contact<double>({-0.5, 0}, {0, 3}, 1.0), kNever<double>);
    EXPECT_EQ(time_until_contact<double>({-5, 0}, {0, 0}, 1.0), kNever<double>);
}

TEST(TimeOfImpact, overlapping_balls_that_approach_meet_now) {
    EXPECT_EQ(time_until_contact<double>({-0.5, 0}, {2, 0}, 1.0), 0.0);
    EXPECT_EQ(time_until_contact<double>({-1, 0}, {2, 0}, 1.0), 0.0);
}

TEST(TimeOfImpact, balls_that_pass_wide_never_meet) {
    EXPECT_EQ(time_until_contact<double>({-5, 1.0000001}, {2, 0}, 1.0), kNever<double>);
    EXPECT_LT(time_until_contact<double>({-5, 0.9999999}, {2, 0}, 1.0), 2.5);
}

TEST(TimeOfImpact, a_contact_closer_than_round_off_of_the_squares_is_still_exact) {
    // The textbook root loses all digits here: it would subtract two numbers that agree to 16
    // places.
    const double gap = 1e-13;
    const double time = time_until_contact<double>({-(1.0 + gap), 0}, {1e6, 0}, 1.0);
    EXPECT_NEAR(time / (gap * 1e-6), 1.0, 1e-2);  // 1 + gap itself is only known to 1e-3 of the gap
    EXPECT_GT(time, 0.0);
}

TEST(TimeOfImpact, at_that_time_the_distance_is_the_sum_of_radii) {
    constexpr std::uint64_t kSeed = 11;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const double reach = dice.between(0.1, 2.0);
        const Vec2d d = dice.in_box(20.0);
        const Vec2d w = dice.in_box(1.0) * dice.of_any_size(1e-6, 1e6);
        const double time = time_until_contact<double>(d, w, reach);
        ASSERT_GE(time, 0.0);
        if (d.norm() < reach || time == kNever<double>) continue;
        ++met;
        ASSERT_NEAR((d + w * time).norm(), reach, 1e-12 * d.norm()) << d << " " << w;
        ASSERT_LE((d + w * time).dot(w), 1e-6 * w.norm() * reach);
    }
    EXPECT_GT(met, 500);
}

TEST(TimeOfImpact, hostile_numbers_give_a_time_or_never) {
    const double numbers[] = {0.0,     -0.0,  1.0, -1.0, 5e-324, -5e-324, 1e-200,
                              -1e-160, 1e-16, 1e9, -1e9, 1e8,    3.0,     -1e-9};
    for (const double x : numbers) {
        for (const double y : numbers) {
            for (const double vx : numbers) {
                for (const double vy : numbers) {
                    for (const double reach : {1e-6, 1.0, 1e8}) {
                        const double t = time_until_contact<double>({x, y}, {vx, vy}, reach);
                        ASSERT_GE(t, 0.0) << x << " " << y << " " << vx << " " << vy;
                        const auto f = [](double v) { return static_cast<float>(v); };
                        ASSERT_GE(time_until_contact<float>({f(x), f(y)}, {f(vx), f(vy)}, f(reach)),
                                  0.0F);
                    }
                    for (const Platform& platform :
                         {Platform(Disc{3.0}), Platform(Rectangle{{3.0, 1.0}}),
                          Platform(Ring{1.0, 3.0})}) {
                        ASSERT_GE(time_until_edge<double>(platform, {x, y}, {vx, vy}), 0.0);
                    }
                }
            }
        }
    }
}

TEST(TimeOfImpact, a_wall_is_hit_only_when_approached) {
    EXPECT_DOUBLE_EQ(time_until_wall(3.0, 1.5), 2.0);
    EXPECT_EQ(time_until_wall(3.0, 0.0), kNever<double>);
    EXPECT_EQ(time_until_wall(3.0, -1.0), kNever<double>);
    EXPECT_EQ(time_until_wall(-0.1, 1.0), 0.0);
    EXPECT_EQ(time_until_wall(-0.1, -1.0), kNever<double>);
}

struct Crossing {
    const char* name;
    Platform platform;
    Vec2d position_m, velocity_mps;
    double time_s;
};

TEST(TimeOfImpact, centres_leave_each_platform_at_the_edge) {
    const Crossing crossings[] = {
        {"disc, from the centre", Disc{4.0}, {0, 0}, {2, 0}, 2.0},
        {"disc, chord of 3-4-5", Disc{5.0}, {0, 3}, {2, 0}, 2.0},
        {"disc, across the middle", Disc{4.0}, {-3, 0}, {1, 0}, 7.0},
        {"disc, on the edge, outwards", Disc{4.0}, {4, 0}, {1, 0}, 0.0},
        {"disc, on the edge, inwards", Disc{4.0}, {4, 0}, {-1, 0}, 8.0},
        {"disc, off already", Disc{4.0}, {5, 0}, {-1, 0}, 0.0},
        {"disc, at rest", Disc{4.0}, {3, 0}, {0, 0}, kNever<double>},
        {"rectangle, near side", Rectangle{{4, 2}}, {1, 0}, {1, 0}, 3.0},
        {"rectangle, far side", Rectangle{{4, 2}}, {1, 0}, {-1, 0}, 5.0},
        {"rectangle, the nearer of two", Rectangle{{4, 2}}, {0, 0}, {1, -1}, 2.0},
        {"rectangle, off already", Rectangle{{4, 2}}, {0, 2.5}, {0, -1}, 0.0},
        {"rectangle, along an edge", Rectangle{{4, 2}}, {0, 2}, {1, 0}, 4.0},
        {"ring, outwards", Ring{1.0, 4.0}, {2, 0}, {1, 0}, 2.0},
        {"ring, inwards", Ring{1.0, 4.0}, {3, 0}, {-1, 0}, 2.0},
        {"ring, past the hole", Ring{1.0, 5.0}, {-4, 3}, {1, 0}, 8.0},
        {"ring, in the hole", Ring{1.0, 5.0}, {0.5, 0}, {1, 0}, 0.0},
    };
    for (const Crossing& c : crossings) {
        EXPECT_DOUBLE_EQ(time_until_edge<double>(c.platform, c.position_m, c.velocity_mps),
                         c.time_s)
            << c.name;
    }
}

}  // namespace
}  // namespace fts::physics
