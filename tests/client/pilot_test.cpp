// Pilots play in a world without a network, as late as over one.
#include "client/bot/pilot.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "client/bot/shopping.h"
#include "client/bot/steering.h"
#include "tests/client/piloted_world.h"

namespace fts::bot {
namespace {

using physics::BodyDef;
using physics::Platform;
using physics::Vec2d;

// What a pilot on a good link over the internet sees is about this old.
constexpr int kLagTicks = 6;

struct NamedPlatform {
    std::string name;
    Platform platform;
};
const std::vector<NamedPlatform> kPlatforms = {
    {"disc", physics::Disc{10.0}},
    {"small disc", physics::Disc{5.0}},
    {"rectangle", physics::Rectangle{{12.0, 5.0}}},
    {"ring", physics::Ring{4.0, 11.0}},
};

BodyDef at(const Vec2d& position_m) {
    BodyDef body;
    body.position_m = position_m;
    return body;
}

Vec2d somewhere_on(const Platform& platform, double margin_m, Rng& rng) {
    const double reach_m = physics::bounding_radius_m(platform);
    for (;;) {
        const Vec2d point_m(uniform(rng, -reach_m, reach_m), uniform(rng, -reach_m, reach_m));
        if (physics::distance_to_edge_m(platform, point_m) > margin_m) return point_m;
    }
}

TEST(Pilots, are_made_by_name_and_by_no_other) {
    for (const auto name : pilot_names()) EXPECT_NE(make_pilot(name), nullptr) << name;
    EXPECT_EQ(make_pilot("kamikaze"), nullptr);
    EXPECT_EQ(make_pilot(""), nullptr);
}

TEST(Pilots, stay_on_every_platform_when_nobody_pushes_them) {
    for (const auto& [platform_name, platform] : kPlatforms) {
        for (const auto name : pilot_names()) {
            for (unsigned seed = 1; seed <= 5; ++seed) {
                SCOPED_TRACE(platform_name + ", " + std::string(name) + ", seed " +
                             std::to_string(seed));
                Rng rng(seed);
                PilotedWorld world(platform, {at(somewhere_on(platform, 1.0, rng))}, kLagTicks);
                for (int i = 0; i < 12; ++i) world.add_coin(somewhere_on(platform, 0.3, rng));
                const auto pilot = make_pilot(name);
                while (world.seconds() < 20.0 && world.pilot_is_on()) world.tick(*pilot, rng);
                EXPECT_TRUE(world.pilot_is_on()) << "fell after " << world.seconds() << " s";
            }
        }
    }
}

TEST(Pilots, answer_the_same_sight_and_the_same_random_numbers_with_the_same_command) {
    for (const auto name : pilot_names()) {
        SCOPED_TRACE(name);
        const auto first = make_pilot(name), second = make_pilot(name);
        Rng one(5), other(5);
        PilotedWorld world(physics::Disc{10.0}, {at({1, 2}), at({-3, 4})}, 0);
        for (int i = 0; i < 120; ++i) {
            const Field field = world.field();
            const Sight sight = world.sight(field);
            Rng before = one;
            EXPECT_EQ(first->decide(sight, before), second->decide(sight, other));
            one = before;
            world.tick(*first, one);
            second->decide(sight, other);
        }
    }
}

TEST(Pilots, do_nothing_while_their_ball_is_off_the_platform) {
    Rng rng(1);
    Field field;
    field.platform = physics::Disc{10.0};
    for (const auto name : pilot_names()) {
        EXPECT_EQ(make_pilot(name)->decide(sight_of(field, 1, {}, 0.0), rng), game::InputCommand{})
            << name;
    }
}

TEST(Chaser, knocks_a_passive_ball_off_and_stays_on_itself) {
    for (const auto& [platform_name, platform] : kPlatforms) {
        for (unsigned seed = 1; seed <= 12; ++seed) {
            SCOPED_TRACE(platform_name + ", seed " + std::to_string(seed));
            Rng rng(seed);
            const Vec2d start_m = somewhere_on(platform, 1.0, rng);
            Vec2d target_m = start_m;
            while ((target_m - start_m).norm() < 2.0) target_m = somewhere_on(platform, 1.0, rng);
            PilotedWorld world(platform, {at(start_m), at(target_m)}, kLagTicks);
            const auto chaser = make_pilot("chaser");
            while (world.seconds() < 15.0 && world.balls_left() > 0) world.tick(*chaser, rng);
            EXPECT_EQ(world.balls_left(), 0U);
            EXPECT_TRUE(world.pilot_is_on());
        }
    }
}

TEST(Chaser, clears_a_platform_of_several_balls) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Rng rng(seed);
        PilotedWorld world(physics::Disc{10.0},
                           {at({0, 0}), at({5, 0}), at({-5, 1}), at({0, 6}), at({1, -5})},
                           kLagTicks);
        const auto chaser = make_pilot("chaser");
        while (world.seconds() < 60.0 && world.balls_left() > 0) world.tick(*chaser, rng);
        EXPECT_EQ(world.balls_left(), 0U);
        EXPECT_TRUE(world.pilot_is_on());
    }
}

TEST(Chaser, goes_round_behind_a_ball_before_it_hits_it) {
    for (const double angle : {0.0, 0.7, 2.0, 4.0}) {
        SCOPED_TRACE(angle);
        const Vec2d outwards(std::cos(angle), std::sin(angle));
        Rng rng(1);
        PilotedWorld world(physics::Disc{10.0}, {at(outwards * 8.0), at(outwards * 6.0)},
                           kLagTicks);
        const auto chaser = make_pilot("chaser");
        Vec2d struck_mps = Vec2d::Zero();
        while (world.seconds() < 10.0 && struck_mps.isZero()) {
            world.tick(*chaser, rng);
            if (world.balls_left() > 0) struck_mps = world.field().ai_balls.back().velocity_mps;
        }
        EXPECT_GT(struck_mps.dot(outwards), 0.0);
    }
}

TEST(Collector, finds_its_way_round_a_hole) {
    Rng rng(1);
    PilotedWorld world(physics::Ring{5.0, 10.0}, {at({7.5, 0.0})}, kLagTicks);
    world.add_coin({-6.5, 0.0});
    const auto collector = make_pilot("collector");
    while (world.seconds() < 12.0 && world.coins_left() > 0) world.tick(*collector, rng);
    EXPECT_EQ(world.coins_left(), 0U);
    EXPECT_TRUE(world.pilot_is_on());
}

TEST(Collector, picks_every_coin_up) {
    for (const auto& [platform_name, platform] : kPlatforms) {
        SCOPED_TRACE(platform_name);
        Rng rng(3);
        PilotedWorld world(platform, {at(somewhere_on(platform, 1.0, rng))}, kLagTicks);
        for (int i = 0; i < 8; ++i) world.add_coin(somewhere_on(platform, 0.3, rng));
        const auto collector = make_pilot("collector");
        while (world.seconds() < 60.0 && world.coins_left() > 0) world.tick(*collector, rng);
        EXPECT_EQ(world.coins_left(), 0U);
    }
}

TEST(Defender, survives_balls_that_are_thrown_at_it) {
    int survived = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        Rng rng(seed);
        BodyDef missile = at({uniform(rng, -1, 1), 8.0});
        missile.velocity_mps = {0.0, -6.0};
        PilotedWorld world(physics::Disc{10.0}, {at({0, 0}), missile}, kLagTicks);
        const auto defender = make_pilot("defender");
        while (world.seconds() < 6.0) world.tick(*defender, rng);
        survived += world.pilot_is_on() ? 1 : 0;
    }
    EXPECT_EQ(survived, 10);
}

TEST(Wanderer, covers_ground) {
    Rng rng(9);
    PilotedWorld world(physics::Disc{10.0}, {at({0, 0})}, kLagTicks);
    const auto wanderer = make_pilot("wanderer");
    double path_m = 0.0;
    Vec2d last_m = Vec2d::Zero();
    while (world.seconds() < 20.0) {
        world.tick(*wanderer, rng);
        const Vec2d now_m = world.field().player_balls.front().position_m;
        path_m += (now_m - last_m).norm();
        last_m = now_m;
    }
    EXPECT_GT(path_m, 20.0);
}

TEST(Steering, keeps_the_middle_of_a_ring_and_the_long_axis_of_a_rectangle_safest) {
    const Vec2d ring_m = innermost_point_m(physics::Ring{4.0, 10.0}, {0.0, -1.0});
    EXPECT_LT((ring_m - Vec2d(0, -7)).norm(), 1e-12);
    const Vec2d box_m = innermost_point_m(physics::Rectangle{{12.0, 5.0}}, {20.0, 3.0});
    EXPECT_LT((box_m - Vec2d(7, 0)).norm(), 1e-12);
}

TEST(Shopping, prefers_the_lowest_tier_and_then_the_order_of_the_list) {
    constexpr std::array kWants = {game::Stat::kMass, game::Stat::kThrust};
    game::Tiers tiers{};
    EXPECT_EQ(next_purchase(kWants, tiers, 14), game::Stat::kMass);
    tiers[static_cast<std::size_t>(game::Stat::kMass)] = 1;
    EXPECT_EQ(next_purchase(kWants, tiers, 100), game::Stat::kThrust);
}

TEST(Shopping, buys_nothing_that_is_too_dear_or_at_its_last_tier) {
    constexpr std::array kWants = {game::Stat::kMass};
    game::Tiers tiers{};
    EXPECT_FALSE(next_purchase(kWants, tiers, 13));
    tiers[static_cast<std::size_t>(game::Stat::kMass)] = game::kMaxTier;
    EXPECT_FALSE(next_purchase(kWants, tiers, 1000));
}

}  // namespace
}  // namespace fts::bot
