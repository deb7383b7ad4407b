#include "server/match/attribution.h"

#include <numeric>

#include <gtest/gtest.h>

namespace fts::server {
namespace {

constexpr Actor kAnna{1, 0}, kBert{2, 0}, kCarl{3, 0}, kDora{4, 0};
constexpr Actor kRobot{0, 100}, kOther{0, 101}, kVictim{0, 102};
constexpr double kFullMomentum = 10.0;  // a hit is decisive from 1 N s on
constexpr std::uint32_t kSecond = 60;

class AttributionTest : public ::testing::Test {
  protected:
    void hit(Actor actor, Actor victim, std::uint32_t tick, double impulse_ns,
             bool actor_came = true) {
        attribution.record({victim, actor, tick, impulse_ns, kFullMomentum, actor_came});
    }
    double fraction(const std::vector<Attribution::Share>& shares, Actor actor) const {
        for (const auto& share : shares)
            if (share.actor == actor) return share.fraction;
        return 0.0;
    }
    Attribution attribution;
};

TEST_F(AttributionTest, nobody_is_credited_for_a_ball_that_nobody_touched) {
    EXPECT_TRUE(attribution.credit(kVictim, 10).empty());
}

TEST_F(AttributionTest, a_lone_decisive_hit_owns_everything) {
    hit(kAnna, kVictim, 10, 5.0);
    EXPECT_EQ(attribution.credit(kVictim, 20),
              (std::vector<Attribution::Share>{{kAnna, 1.0, false}}));
}

TEST_F(AttributionTest, a_hit_is_decisive_from_a_tenth_of_the_victims_full_momentum) {
    hit(kAnna, kVictim, 10, 0.999);
    EXPECT_TRUE(attribution.credit(kVictim, 10).empty());
    hit(kAnna, kVictim, 11, 1.0);
    EXPECT_EQ(attribution.credit(kVictim, 11).size(), 1u);
}

TEST_F(AttributionTest, the_latest_decisive_hit_owns_even_when_an_earlier_one_was_stronger) {
    hit(kAnna, kVictim, 10, 9.0);
    hit(kBert, kVictim, 20, 3.0);
    const auto shares = attribution.credit(kVictim, 20);
    ASSERT_EQ(shares.size(), 2u);
    EXPECT_EQ(shares[0].actor, kBert);
    EXPECT_FALSE(shares[0].assist);
    EXPECT_DOUBLE_EQ(shares[0].fraction, 0.7);
    EXPECT_EQ(shares[1].actor, kAnna);
    EXPECT_TRUE(shares[1].assist);
    EXPECT_NEAR(shares[1].fraction, 0.3, 1e-15);
}

TEST_F(AttributionTest, a_graze_after_the_decisive_hit_does_not_take_it_over) {
    hit(kAnna, kVictim, 10, 5.0);
    hit(kBert, kVictim, 20, 0.5);
    EXPECT_EQ(attribution.credit(kVictim, 20),
              (std::vector<Attribution::Share>{{kAnna, 1.0, false}}));
}

TEST_F(AttributionTest, an_assist_needs_a_quarter_of_the_weight_that_remains) {
    hit(kBert, kVictim, 10, 0.99);
    hit(kAnna, kVictim, 10, 3.0);
    EXPECT_EQ(attribution.credit(kVictim, 10).size(), 1u);
    hit(kBert, kVictim, 10, 0.02);  // grazes add up
    EXPECT_EQ(attribution.credit(kVictim, 10).size(), 2u);
}

TEST_F(AttributionTest, weight_halves_every_two_seconds) {
    hit(kBert, kVictim, 0, 2.1);
    hit(kAnna, kVictim, 2 * kSecond, 3.0);  // Bert weighs 1.05 of 4.05 now
    EXPECT_EQ(attribution.credit(kVictim, 2 * kSecond).size(), 2u);

    Attribution later;
    later.record({kVictim, kBert, 0, 1.9, kFullMomentum, true});
    later.record({kVictim, kAnna, 2 * kSecond, 3.0, kFullMomentum, true});  // 0.95 of 3.95
    EXPECT_EQ(later.credit(kVictim, 2 * kSecond).size(), 1u);
}

TEST_F(AttributionTest, assistants_divide_their_part_by_weight) {
    hit(kBert, kVictim, 10, 4.0);
    hit(kCarl, kVictim, 10, 2.0);
    hit(kAnna, kVictim, 10, 1.0);
    const auto shares = attribution.credit(kVictim, 10);
    EXPECT_NEAR(fraction(shares, kAnna), 0.7, 1e-15);
    EXPECT_NEAR(fraction(shares, kBert), 0.2, 1e-15);
    EXPECT_NEAR(fraction(shares, kCarl), 0.1, 1e-15);
}

TEST_F(AttributionTest, a_contact_expires_after_six_seconds) {
    hit(kAnna, kVictim, 10, 5.0);
    EXPECT_EQ(attribution.credit(kVictim, 10 + 6 * kSecond).size(), 1u);
    EXPECT_TRUE(attribution.credit(kVictim, 11 + 6 * kSecond).empty());
    attribution.expire(10 + 6 * kSecond);
    EXPECT_EQ(attribution.credit(kVictim, 10 + 6 * kSecond).size(), 1u);
}

TEST_F(AttributionTest, a_respawn_clears_what_happened_before) {
    hit(kAnna, kBert, 10, 5.0);
    attribution.respawned(kBert);
    EXPECT_TRUE(attribution.credit(kBert, 20).empty());
}

TEST_F(AttributionTest, a_second_and_a_half_well_inside_clears_what_happened_before) {
    hit(kAnna, kVictim, 10, 5.0);
    for (std::uint32_t tick = 11; tick < 11 + 90; ++tick) {
        attribution.observe(kVictim, tick, true);
        ASSERT_EQ(attribution.credit(kVictim, tick).size(), 1u) << tick;
    }
    attribution.observe(kVictim, 11 + 90, true);
    EXPECT_TRUE(attribution.credit(kVictim, 11 + 90).empty());
}

TEST_F(AttributionTest, leaving_the_inside_starts_the_calm_anew) {
    hit(kAnna, kVictim, 10, 5.0);
    for (std::uint32_t tick = 11; tick < 200; ++tick)
        attribution.observe(kVictim, tick, tick % 60 != 0);
    EXPECT_EQ(attribution.credit(kVictim, 200).size(), 1u);
}

TEST_F(AttributionTest, a_hit_on_a_ball_that_has_long_been_inside_counts) {
    hit(kBert, kVictim, 0, 5.0);
    for (std::uint32_t tick = 1; tick < 200; ++tick) attribution.observe(kVictim, tick, true);
    hit(kAnna, kVictim, 200, 5.0);
    attribution.observe(kVictim, 201, true);
    EXPECT_EQ(attribution.credit(kVictim, 201),
              (std::vector<Attribution::Share>{{kAnna, 1.0, false}}));
}

TEST_F(AttributionTest, billiards_a_knocked_hitter_passes_half_on) {
    hit(kAnna, kBert, 10, 5.0);
    hit(kBert, kVictim, 20, 5.0);
    const auto shares = attribution.credit(kVictim, 30);
    ASSERT_EQ(shares.size(), 2u);
    EXPECT_EQ(shares[0], (Attribution::Share{kBert, 0.5, false}));
    EXPECT_EQ(shares[1], (Attribution::Share{kAnna, 0.5, true}));
}

TEST_F(AttributionTest, billiards_counts_within_two_seconds_only) {
    hit(kAnna, kBert, 10, 5.0);
    hit(kBert, kVictim, 11 + 2 * kSecond, 5.0);
    EXPECT_EQ(attribution.credit(kVictim, 11 + 2 * kSecond).size(), 1u);
}

TEST_F(AttributionTest, whoever_runs_into_somebody_is_not_knocked_by_it) {
    hit(kRobot, kAnna, 10, 5.0, false);  // Anna came at the robot
    hit(kAnna, kVictim, 20, 5.0);
    EXPECT_EQ(attribution.credit(kVictim, 20),
              (std::vector<Attribution::Share>{{kAnna, 1.0, false}}));
}

TEST_F(AttributionTest, a_robot_in_between_makes_the_knock_off_the_players) {
    hit(kAnna, kRobot, 10, 5.0);
    hit(kRobot, kVictim, 20, 5.0);
    const auto shares = attribution.credit(kVictim, 20);
    ASSERT_EQ(shares.size(), 2u);
    EXPECT_EQ(shares[0], (Attribution::Share{kAnna, 0.5, false}));
    EXPECT_EQ(shares[1], (Attribution::Share{kRobot, 0.5, true}));
}

TEST_F(AttributionTest, a_chain_passes_half_of_the_half_on) {
    hit(kAnna, kRobot, 10, 5.0);
    hit(kRobot, kOther, 15, 5.0);
    hit(kOther, kVictim, 20, 5.0);
    const auto shares = attribution.credit(kVictim, 20);
    EXPECT_DOUBLE_EQ(fraction(shares, kOther), 0.5);
    EXPECT_DOUBLE_EQ(fraction(shares, kRobot), 0.25);
    EXPECT_DOUBLE_EQ(fraction(shares, kAnna), 0.25);
    EXPECT_EQ(shares[0].actor, kAnna);
    EXPECT_FALSE(shares[0].assist);
}

TEST_F(AttributionTest, the_victim_never_profits_from_its_own_fall) {
    hit(kVictim, kAnna, 10, 5.0);
    hit(kAnna, kVictim, 20, 5.0);
    EXPECT_EQ(attribution.credit(kVictim, 20),
              (std::vector<Attribution::Share>{{kAnna, 1.0, false}}));
}

TEST_F(AttributionTest, two_that_knock_each_other_off_are_credited_for_each_other) {
    hit(kAnna, kBert, 10, 5.0);
    hit(kBert, kAnna, 10, 5.0);
    EXPECT_EQ(attribution.credit(kBert, 15)[0], (Attribution::Share{kAnna, 1.0, false}));
    EXPECT_EQ(attribution.credit(kAnna, 15)[0], (Attribution::Share{kBert, 1.0, false}));
}

TEST_F(AttributionTest,
       a_ball_that_is_hit_without_end_keeps_the_newest_contacts_and_counts_the_rest) {
    for (std::uint32_t i = 0; i < Attribution::kMaxContacts + 7; ++i)
        hit(i < 7 ? kBert : kAnna, kVictim, 10, 5.0);
    EXPECT_EQ(attribution.contacts_forgotten_early(), 7u);
    EXPECT_EQ(attribution.credit(kVictim, 10),
              (std::vector<Attribution::Share>{{kAnna, 1.0, false}}));
}

TEST_F(AttributionTest, shares_always_add_up_to_one) {
    const Actor actors[] = {kAnna, kBert, kCarl, kDora, kRobot, kOther};
    std::uint64_t state = 7;
    const auto dice = [&state](std::uint64_t sides) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return (state >> 33) % sides;
    };
    for (std::uint32_t tick = 0; tick < 5000; ++tick) {
        const Actor actor = actors[dice(6)], victim = actors[dice(6)];
        if (actor == victim) continue;
        hit(actor, victim, tick, 0.1 + static_cast<double>(dice(40)), dice(2) == 0);
        const auto shares = attribution.credit(victim, tick);
        const double sum = std::accumulate(
            shares.begin(), shares.end(), 0.0,
            [](double total, const Attribution::Share& share) { return total + share.fraction; });
        ASSERT_NEAR(sum, shares.empty() ? 0.0 : 1.0, 1e-12) << "tick " << tick;
        ASSERT_EQ(fraction(shares, victim), 0.0);
    }
}

TEST(CameAt, is_whoever_did_more_of_the_approach) {
    using physics::Vec2d;
    const Vec2d right(1.0, 0.0);  // from the actor to the victim
    EXPECT_TRUE(came_at({3.0, 9.0}, {0.0, 0.0}, right));
    EXPECT_FALSE(came_at({0.0, 0.0}, {-3.0, 0.0}, right));
    EXPECT_TRUE(came_at({3.0, 0.0}, {-2.0, 0.0}, right));
    EXPECT_FALSE(came_at({2.0, 0.0}, {-3.0, 0.0}, right));
    EXPECT_TRUE(came_at({3.0, 0.0}, {2.0, 0.0}, right));     // runs after it
    EXPECT_FALSE(came_at({-2.0, 0.0}, {-3.0, 0.0}, right));  // is run after
}

TEST(SplitCoins, uses_the_largest_remainder) {
    const std::vector<Attribution::Share> seventy_thirty{{kAnna, 0.7, false}, {kBert, 0.3, true}};
    EXPECT_EQ(split_coins(4, seventy_thirty), (std::vector<int>{3, 1}));
    EXPECT_EQ(split_coins(5, seventy_thirty), (std::vector<int>{4, 1}));
    EXPECT_EQ(split_coins(10, seventy_thirty), (std::vector<int>{7, 3}));
    EXPECT_EQ(split_coins(0, seventy_thirty), (std::vector<int>{0, 0}));
    EXPECT_EQ(split_coins(4, {}), std::vector<int>{});
}

TEST(SplitCoins, never_makes_or_loses_a_coin) {
    for (int coins = 0; coins < 100; ++coins)
        for (int parts = 1; parts < 9; ++parts) {
            const std::vector<Attribution::Share> equal(static_cast<std::size_t>(parts),
                                                        {kAnna, 1.0 / parts, false});
            const auto split = split_coins(coins, equal);
            EXPECT_EQ(std::accumulate(split.begin(), split.end(), 0), coins);
            for (const int part : split) EXPECT_LE(std::abs(part * parts - coins), parts);
        }
}

}  // namespace
}  // namespace fts::server
