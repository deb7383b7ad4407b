#include "client/sdl/wording.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/client_sdl/fabricated_views.h"

namespace fts::sdl {
namespace {

bool mentions(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(Wording, writes_numbers_as_people_read_them) {
    EXPECT_EQ(fixed(1.254, 2), "1.25");
    EXPECT_EQ(fixed(-0.004, 2), "0.00");
    EXPECT_EQ(fixed(-1.5, 1),
              "\xe2\x88\x92"
              "1.5");
    EXPECT_EQ(signed_fixed(2.0, 1), "+2.0");
    EXPECT_EQ(fixed(std::numeric_limits<double>::quiet_NaN(), 2), "\xe2\x80\x93");
    EXPECT_EQ(fixed(1e300, 0), "1000000000000000");
}

TEST(Wording, writes_small_numbers_with_a_power_of_ten) {
    EXPECT_EQ(scientific(0.0), "0");
    EXPECT_EQ(scientific(2.26e-16), "2.3 \xc3\x97 10\xe2\x81\xbb\xc2\xb9\xe2\x81\xb6");
    EXPECT_EQ(scientific(-9.97e3),
              "\xe2\x88\x92"
              "1.0 \xc3\x97 10\xe2\x81\xb4");
    EXPECT_EQ(scientific(5e-324).substr(0, 3), "4.9");
}

TEST(Wording, counts_down_to_zero_and_not_below) {
    EXPECT_EQ(clock_time(0.2), "0:01");
    EXPECT_EQ(clock_time(83.4), "1:24");
    EXPECT_EQ(clock_time(-3), "0:00");
    EXPECT_EQ(clock_time(std::numeric_limits<double>::infinity()), "0:00");
}

TEST(HitSums, keep_momentum_and_energy_of_an_elastic_hit) {
    const HitSums sums = sums_of(oblique_hit(1.25, 1.0, {-2.0, 1.5}));
    EXPECT_LT(std::abs(sums.relative_energy_change), 1e-15);
    EXPECT_LT(sums.relative_momentum_change, 1e-15);
    EXPECT_GT(sums.energy_before_j, 1.0);
}

TEST(HitSums, show_what_an_inelastic_hit_lost) {
    auto hit = oblique_hit(1.0, 1.0, physics::Vec2d::Zero());
    hit.own.velocity_after_mps *= 0.5;
    EXPECT_LT(sums_of(hit).relative_energy_change, -0.01);
    EXPECT_GT(sums_of(hit).relative_momentum_change, 0.01);
}

TEST(HitSums, are_finite_when_nothing_moves) {
    auto hit = oblique_hit(1.0, 1.0, physics::Vec2d::Zero(), physics::Vec2d::Zero());
    hit.own.velocity_after_mps.setZero();
    hit.other.velocity_after_mps.setZero();
    EXPECT_EQ(sums_of(hit).relative_energy_change, 0.0);
    EXPECT_EQ(sums_of(hit).relative_momentum_change, 0.0);
}

TEST(Explanation, says_what_a_heavier_ball_does_to_a_resting_one) {
    const auto hit = oblique_hit(1.25, 1.0, physics::Vec2d::Zero());
    const std::string text = explain(hit);
    EXPECT_TRUE(mentions(text, "1.25\xc3\x97 heavier")) << text;
    EXPECT_TRUE(mentions(text, "111 % of your speed along the line of centres")) << text;
    const double along = hit.own.velocity_before_mps.dot(-hit.normal);
    EXPECT_NEAR(hit.other.velocity_after_mps.norm() / along, 1.11, 0.005);
}

TEST(Explanation, knows_equal_lighter_and_struck) {
    EXPECT_TRUE(mentions(explain(oblique_hit(1, 1, physics::Vec2d::Zero())), "Equal masses"));
    EXPECT_TRUE(
        mentions(explain(oblique_hit(0.5, 1, physics::Vec2d::Zero())), "2.00\xc3\x97 lighter"));
    const auto struck = oblique_hit(1, 2, {-4, -4}, {0.0, 0.0});
    EXPECT_TRUE(mentions(explain(struck), "133 % of its speed")) << explain(struck);
}

TEST(Explanation, shares_out_the_change_where_both_balls_move) {
    const auto hit = oblique_hit(1.0, 3.0, {-2.0, 0.5});
    const std::string text = explain(hit);
    const auto change = [&](const replication::CollisionReport::Side& side) {
        return std::abs((side.velocity_after_mps - side.velocity_before_mps).dot(hit.normal));
    };
    const double closing =
        std::abs((hit.own.velocity_before_mps - hit.other.velocity_before_mps).dot(hit.normal));
    EXPECT_TRUE(mentions(text, "changed by " + fixed(100 * change(hit.own) / closing, 0) + " %"))
        << text;
    EXPECT_TRUE(mentions(text, "other's by " + fixed(100 * change(hit.other) / closing, 0) + " %"))
        << text;
}

TEST(Explanation, says_when_others_had_their_share) {
    auto hit = oblique_hit(1.0, 3.0, {-2.0, 0.5});
    hit.contacts_at_once = 3;
    EXPECT_TRUE(mentions(explain(hit), "One of 3 contacts")) << explain(hit);
}

TEST(Explanation, is_silent_about_masses_that_make_no_sense) {
    EXPECT_EQ(explain(oblique_hit(0.0, 0.0, {0, 0})), "");
}

TEST(Feed, tells_who_knocked_whom_off_and_what_it_paid) {
    const client::View view = match_view();
    replication::KnockOff knock_off;
    EXPECT_EQ(knock_off_line(view, knock_off, "Coward"), "Coward fell");
    knock_off.shares = {{1, 4, false}, {2, 1, true}};
    EXPECT_EQ(knock_off_line(view, knock_off, "Coward"),
              "You knocked off Coward, helped by Ana  +4 coins");
    knock_off.shares = {{2, 5, false}};
    EXPECT_EQ(knock_off_line(view, knock_off, "You"), "Ana knocked off you");
    knock_off.shares = {{77, 5, false}};
    EXPECT_EQ(knock_off_line(view, knock_off, "Ana"), "Player 77 knocked off Ana");
}

}  // namespace
}  // namespace fts::sdl
