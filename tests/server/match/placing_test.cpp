#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "common/replication/hit_log.h"
#include "server/match/id_pool.h"
#include "server/match/spawn.h"
#include "tests/server/match/match_bench.h"

namespace fts::server {
namespace {

using physics::Platform;
using physics::Vec2d;

const Platform kPlatforms[] = {physics::Disc{10.0}, physics::Rectangle{{14.0, 6.0}},
                               physics::Ring{4.0, 12.0}, physics::Disc{2.0}};
double nobody_is_near(const Vec2d&) {
    return std::numeric_limits<double>::infinity();
}

TEST(Spawn, is_well_inside_every_kind_of_platform) {
    for (const Platform& platform : kPlatforms) {
        Random random(7);
        for (int i = 0; i < 200; ++i) {
            const auto spot = find_spawn(platform, 0.5, nobody_is_near, random);
            ASSERT_TRUE(spot.has_value());
            EXPECT_GE(physics::distance_to_edge_m(platform, *spot),
                      std::min(3.0, 0.4 * inradius_m(platform)) - 1e-12);
        }
    }
}

TEST(Spawn, keeps_away_from_other_balls_and_gives_up_where_there_is_no_room) {
    Random random(3);
    const Vec2d other{2.0, 1.0};
    const auto one_other = [&](const Vec2d& point) { return (point - other).norm() - 0.5; };
    for (int i = 0; i < 200; ++i) {
        const auto spot = find_spawn(kPlatforms[0], 0.5, one_other, random);
        ASSERT_TRUE(spot.has_value());
        EXPECT_GT((*spot - other).norm(), 1.0);
    }
    const auto crowded = [](const Vec2d&) { return 0.4; };
    EXPECT_FALSE(find_spawn(kPlatforms[0], 0.5, crowded, random).has_value());
}

TEST(Spawn, is_the_same_for_the_same_seed) {
    Random first(11), second(11), third(12);
    const auto a = find_spawn(kPlatforms[2], 0.5, nobody_is_near, first);
    EXPECT_EQ(*a, *find_spawn(kPlatforms[2], 0.5, nobody_is_near, second));
    EXPECT_NE(*a, *find_spawn(kPlatforms[2], 0.5, nobody_is_near, third));
}

TEST(Spawn, near_a_point_of_the_edge_stays_on_the_platform) {
    for (const Platform& platform : kPlatforms) {
        Random random(5);
        for (int i = 0; i < 100; ++i) {
            const Vec2d outside{random.between(-30.0, 30.0), random.between(-30.0, 30.0)};
            const Vec2d edge = physics::nearest_edge_point_m(platform, outside);
            EXPECT_GT(physics::distance_to_edge_m(platform,
                                                  scatter_near(platform, edge, 2.0, 0.5, random)),
                      0.0);
        }
    }
}

TEST(Match, brings_the_balls_of_a_large_level_in_over_several_ticks_of_the_countdown) {
    constexpr std::size_t kMany = 500;
    MatchBench bench({quiet_level(1, physics::Disc{60.0}, static_cast<int>(kMany))}, 1, 16);
    for (int person = 1; person <= 8; ++person) bench.join(person);
    EXPECT_LT(bench.match.snapshot().balls.size(), 100u);
    bench.tick(20);
    EXPECT_EQ(bench.match.phase(), game::Phase::kCountdown);
    EXPECT_EQ(bench.match.snapshot().balls.size(), kMany + 8);
    EXPECT_EQ(bench.match.totals().spawns_delayed, 0u);
}

TEST(Match, lets_balls_wait_while_there_is_no_free_spot_and_never_overlaps_them) {
    MatchBench bench({quiet_level(1, physics::Disc{2.0}, 2)}, 1, 16);
    for (int person = 1; person <= 16; ++person) bench.join(person);
    bench.tick(60);
    const auto balls = bench.match.snapshot().balls;
    EXPECT_LT(balls.size(), 18u);
    EXPECT_GT(bench.match.totals().spawns_delayed, 0u);
    for (const auto& a : balls)
        for (const auto& b : balls) {
            if (a.id < b.id) {
                EXPECT_GT((position_of(a) - position_of(b)).norm(), 1.0);
            }
        }

    // As soon as somebody makes room, somebody else gets it.
    std::set<PlayerId> waiting;
    for (PlayerId player = 1; player <= 16; ++player)
        if (!bench.ball_of(player)) waiting.insert(player);
    ASSERT_FALSE(waiting.empty());
    for (PlayerId player = 1; player <= 16; ++player)
        if (bench.ball_of(player) && !waiting.contains(player)) bench.match.leave(player);
    bench.tick(10);
    EXPECT_TRUE(bench.ball_of(*waiting.begin()).has_value());
}

TEST(HitLog, keeps_the_strongest_when_there_are_too_many) {
    replication::HitLog log;
    for (std::uint16_t i = 1; i <= 100; ++i)
        log.add({.tick = 1, .a = i, .b = 200, .impulse = static_cast<std::uint32_t>(i * 7 % 101)});
    EXPECT_EQ(log.left_out(), 36u);
    const auto hits = log.sorted();
    ASSERT_EQ(hits.size(), replication::HitLog::kMaxHits);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        EXPECT_GT(hits[i].impulse, 36u);
        EXPECT_TRUE(i == 0 || hits[i].a > hits[i - 1].a);
    }
}

TEST(HitLog, counts_a_pair_once_a_tick_with_its_stronger_hit) {
    replication::HitLog log;
    log.add({.tick = 1, .a = 1, .b = 2, .impulse = 5});
    log.add({.tick = 1, .a = 1, .b = 2, .impulse = 9});
    log.add({.tick = 1, .a = 1, .b = 2, .impulse = 7});
    log.add({.tick = 2, .a = 1, .b = 2, .impulse = 1});
    ASSERT_EQ(log.sorted().size(), 2u);
    EXPECT_EQ(log.sorted()[0].impulse, 9u);
}

TEST(IdPool, lets_an_id_rest_before_it_is_used_again) {
    IdPool pool(600);
    const auto first = pool.take(10);
    ASSERT_TRUE(first.has_value());
    pool.give_back(*first, 20);
    std::set<std::uint16_t> used;
    for (int i = 1; i < 65535; ++i) {
        const auto id = pool.take(620);
        ASSERT_TRUE(id.has_value());
        EXPECT_TRUE(used.insert(*id).second);
    }
    EXPECT_FALSE(used.contains(*first));
    EXPECT_EQ(pool.take(621), first);
    EXPECT_FALSE(pool.take(622).has_value());
}

TEST(IdPool, gives_the_longest_rested_id_rather_than_none) {
    IdPool pool(600);
    for (int i = 0; i < 65535; ++i) pool.take(10);
    pool.give_back(77, 20);
    pool.give_back(11, 21);
    EXPECT_EQ(pool.take(22), std::uint16_t{77});
}

}  // namespace
}  // namespace fts::server
