#include <algorithm>

#include <gtest/gtest.h>

#include "tests/server/match/match_bench.h"

namespace fts::server {
namespace {

using game::Phase;
using physics::Vec2d;
using replication::CollisionReport;

std::vector<CollisionReport> reports_of_ramming(MatchBench& bench, PlayerId player, int ticks) {
    std::vector<CollisionReport> reports;
    for (int tick = 0; tick < ticks; ++tick) {
        bench.match.set_input(player, ram(bench.match.snapshot(), player, Prey::kAnybody));
        bench.tick();
        for (const auto& report : bench.said<CollisionReport>(player)) reports.push_back(report);
    }
    return reports;
}

void expect_elastic(const CollisionReport& report) {
    const auto& own = report.own;
    const auto& other = report.other;
    const Vec2d before =
        own.mass_kg * own.velocity_before_mps + other.mass_kg * other.velocity_before_mps;
    const Vec2d after =
        own.mass_kg * own.velocity_after_mps + other.mass_kg * other.velocity_after_mps;
    EXPECT_LE((before - after).norm(), 1e-14 * (1.0 + before.norm()));
    const double approach =
        (own.velocity_before_mps - other.velocity_before_mps).dot(report.normal);
    const double parting = (own.velocity_after_mps - other.velocity_after_mps).dot(report.normal);
    EXPECT_LT(approach, 0.0);
    EXPECT_NEAR(parting, -approach, 1e-13 * (1.0 + std::abs(approach)));
    const double reduced_kg = own.mass_kg * other.mass_kg / (own.mass_kg + other.mass_kg);
    EXPECT_NEAR(report.impulse_ns, -2.0 * reduced_kg * approach, 1e-13 * report.impulse_ns);
    EXPECT_NEAR((own.position_m - other.position_m).norm(), own.radius_m + other.radius_m, 1e-9);
    EXPECT_NEAR((own.position_m - other.position_m).normalized().dot(report.normal), 1.0, 1e-9);
}

TEST(MatchCollisions, are_reported_to_the_player_in_full_precision) {
    MatchBench bench({quiet_level(1, physics::Disc{12.0}, 4)});
    const PlayerId player = bench.join(1);
    bench.tick_until(Phase::kPlaying);
    const auto reports = reports_of_ramming(bench, player, 60 * 20);
    ASSERT_FALSE(reports.empty());
    for (const CollisionReport& report : reports) {
        EXPECT_EQ(report.own.player_id, player);
        EXPECT_EQ(report.own.mass_kg, 1.0);
        EXPECT_EQ(report.own.radius_m, 0.5);
        EXPECT_EQ(report.other.player_id, 0);
        EXPECT_LE(report.time_in_tick_s, game::kTickDurationS);
        expect_elastic(report);
    }
    EXPECT_LE(bench.match.audit().worst_energy_error, 1e-12);
    EXPECT_LE(bench.match.audit().worst_momentum_error, 1e-12);
    EXPECT_GE(bench.match.audit().ball_collisions, reports.size());
}

TEST(MatchCollisions, reach_both_players_of_a_hit_each_from_the_own_side) {
    MatchBench bench({quiet_level(1, physics::Disc{12.0})}, 5);
    const PlayerId first = bench.join(1), second = bench.join(2);
    bench.tick_until(Phase::kPlaying);
    for (int tick = 0; tick < 60 * 30; ++tick) {
        bench.match.set_input(first, ram(bench.match.snapshot(), first, Prey::kAnybody));
        bench.tick();
        const auto mine = bench.said<CollisionReport>(first);
        const auto theirs = bench.said<CollisionReport>(second);
        if (theirs.empty()) continue;
        ASSERT_EQ(mine.size(), 1u);
        EXPECT_EQ(mine[0].own.ball, theirs[0].other.ball);
        EXPECT_EQ(mine[0].other.ball, theirs[0].own.ball);
        EXPECT_EQ(mine[0].normal, -theirs[0].normal);
        EXPECT_EQ(mine[0].own.velocity_after_mps, theirs[0].other.velocity_after_mps);
        expect_elastic(mine[0]);
        expect_elastic(theirs[0]);
        return;
    }
    FAIL() << "the players never met";
}

TEST(MatchCollisions, a_player_is_told_of_at_most_ten_a_second) {
    auto level = quiet_level(1, physics::Disc{12.0});
    level.ai[0] = {.behaviour = game::Behaviour::kBruiser,
                   .difficulty = game::Difficulty::kExpert,
                   .count = 12,
                   .mass_kg = 5.0,
                   .thrust_n = 60.0,
                   .top_speed_mps = 8.0};
    MatchBench bench({level});
    const PlayerId player = bench.join(1);
    bench.tick_until(Phase::kPlaying);
    const auto reports = reports_of_ramming(bench, player, 60 * 20);
    for (std::size_t i = 1; i < reports.size(); ++i) {
        EXPECT_GT(reports[i].tick, reports[i - 1].tick);
        EXPECT_GE(reports[i].tick - reports[i - std::min<std::size_t>(i, 10)].tick,
                  std::min<std::size_t>(i, 10) * 6 - 5);
    }
    EXPECT_GT(bench.match.totals().reports_left_out, 0u);
}

TEST(MatchCollisions, a_mass_upgrade_changes_the_next_hit_as_conservation_of_momentum_says) {
    auto level = quiet_level(1, physics::Disc{12.0}, 3);
    level.time_limit_s = 10.0;
    MatchBench bench({level});
    const PlayerId player = bench.join(1, 100);
    bench.tick_until(Phase::kShop);
    EXPECT_EQ(bench.ball_of(player)->mass, 65536u);
    ASSERT_EQ(bench.ledger.buy(key_of(1), 1, game::Stat::kMass, 0).outcome, BuyOutcome::kBought);
    bench.match.upgrades_changed(player);
    EXPECT_EQ(bench.ball_of(player)->mass, 73400u);  // 1.12 kg
    bench.tick();
    ASSERT_EQ(bench.said<replication::Wallet>(player).size(), 1u);
    EXPECT_EQ(bench.said<replication::Wallet>(player)[0].tiers[0], 1);

    bench.match.set_ready(player);
    bench.tick_until(Phase::kPlaying);
    const auto reports = reports_of_ramming(bench, player, 60 * 9);
    ASSERT_FALSE(reports.empty());
    const CollisionReport& hit = reports.front();
    EXPECT_NEAR(hit.own.mass_kg, game::stats_for(bench.ledger.tiers(key_of(1))).mass_kg,
                replication::kMassStepKg / 2);
    expect_elastic(hit);
    // Against a ball at rest: the struck ball leaves with 2 m1 / (m1 + m2) of the speed along the
    // normal.
    ASSERT_TRUE(hit.other.velocity_before_mps.isZero());
    const double along = hit.own.velocity_before_mps.dot(hit.normal);
    const double passed_on = 2.0 * hit.own.mass_kg / (hit.own.mass_kg + hit.other.mass_kg);
    EXPECT_NEAR(hit.other.velocity_after_mps.dot(hit.normal), passed_on * along, 1e-12);
    EXPECT_GT(passed_on, 1.05);
}

TEST(MatchCollisions, hits_since_the_last_snapshot_are_in_the_next_and_then_forgotten) {
    MatchBench bench({quiet_level(1, physics::Disc{12.0}, 4)});
    const PlayerId player = bench.join(1);
    bench.tick_until(Phase::kPlaying);
    bench.match.clear_hits();
    while (bench.match.snapshot().hits.empty()) {
        ASSERT_LT(bench.match.snapshot().tick, 60u * 30u);
        bench.match.set_input(player, ram(bench.match.snapshot(), player, Prey::kAnybody));
        bench.tick();
    }
    const auto hit = bench.match.snapshot().hits.front();
    EXPECT_LT(hit.a, hit.b);
    EXPECT_GT(hit.impulse, 0u);
    bench.match.clear_hits();
    EXPECT_TRUE(bench.match.snapshot().hits.empty());
}

TEST(MatchCollisions, a_dash_changes_the_velocity_once) {
    MatchBench bench({quiet_level(1, physics::Disc{12.0})});
    const PlayerId player = bench.join(1);
    bench.tick_until(Phase::kPlaying);
    bench.match.set_input(player, {.thrust_x = 127, .thrust_y = 0, .brake = false, .dash = true});
    bench.tick();
    const double dashed_mps = velocity_of(*bench.ball_of(player)).x();
    EXPECT_GT(dashed_mps, 3.5);
    bench.tick();
    EXPECT_NEAR(velocity_of(*bench.ball_of(player)).x(), dashed_mps, 0.2);
}

}  // namespace
}  // namespace fts::server
