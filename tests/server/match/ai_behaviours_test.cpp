#include <gtest/gtest.h>

#include "server/ai/steering.h"
#include "server/match/random.h"

namespace fts::server::ai {
namespace {

using physics::Vec2d;

const physics::Platform kDisc = physics::Disc{10.0};
const physics::Platform kRing = physics::Ring{4.0, 12.0};

SeenBall ball(std::uint16_t id, Vec2d position, bool is_player = false) {
    return {.id = id,
            .is_player = is_player,
            .behaviour = game::Behaviour::kHerd,
            .position_m = position,
            .velocity_mps = Vec2d::Zero(),
            .radius_m = 0.5,
            .mass_kg = 1.0};
}

Situation situation(const physics::Platform& platform, Vec2d own, std::vector<SeenBall> others) {
    return {.platform = &platform,
            .stats = game::stats_for({}),
            .own = ball(1, own),
            .others = std::move(others),
            .look_ahead_s = 0.6};
}

TEST(Chaser, pushes_outward_when_it_is_behind_its_target) {
    const auto intent = chase(situation(kDisc, {3.0, 0.0}, {ball(2, {6.0, 0.0}, true)}));
    EXPECT_GT(intent.thrust.x(), 0.99);
}

TEST(Chaser, goes_around_to_the_ghost_ball_when_it_is_on_the_wrong_side) {
    const auto here = situation(kDisc, {8.5, 2.0}, {ball(2, {6.0, 0.0}, true)});
    const Vec2d ghost = ghost_ball_m(here, here.others[0], 1.0);
    EXPECT_LT(ghost.x(), 6.0 - 1.0);
    const Vec2d way = (ghost - here.own.position_m).normalized();
    EXPECT_GT(chase(here).thrust.dot(way), 0.99);
}

TEST(Chaser, pushes_towards_the_hole_of_a_ring_when_that_edge_is_nearer) {
    const auto here = situation(kRing, {8.0, 0.0}, {ball(2, {5.5, 0.0}, true)});
    EXPECT_LT(chase(here).thrust.x(), -0.99);
}

TEST(Interceptor, leads_a_moving_target) {
    auto runner = ball(2, {5.0, 0.0}, true);
    runner.velocity_mps = {0.0, 4.0};
    EXPECT_GT(intercept(situation(kDisc, {0.0, 0.0}, {runner})).thrust.y(), 0.2);
}

TEST(EdgeGuard, stays_between_the_middle_and_its_target_and_strikes_at_the_edge) {
    const auto far = guard_edge(situation(kDisc, {0.0, 5.0}, {ball(2, {4.0, 0.0}, true)}));
    EXPECT_LT(far.thrust.y(), 0.0);
    const auto strike = guard_edge(situation(kDisc, {5.0, 0.0}, {ball(2, {8.5, 0.0}, true)}));
    EXPECT_GT(strike.thrust.x(), 0.99);
}

TEST(Herd, gathers_first_and_charges_together) {
    const auto strayed = run_with_herd(
        situation(kDisc, {-8.0, 0.0},
                  {ball(2, {4.0, 0.0}), ball(3, {5.0, 0.0}), ball(9, {-8.0, 3.0}, true)}));
    EXPECT_GT(strayed.thrust.x(), 0.9);
    const auto gathered = run_with_herd(situation(
        kDisc, {4.0, 0.0}, {ball(2, {5.5, 0.0}), ball(3, {4.5, 2.0}), ball(9, {-8.0, 0.0}, true)}));
    EXPECT_LT(gathered.thrust.x(), -0.9);
}

TEST(Coward, runs_away_and_slips_along_the_edge_when_cornered) {
    EXPECT_LT(flee(situation(kDisc, {0.0, 0.0}, {ball(2, {3.0, 0.0}, true)})).thrust.x(), -0.99);
    const auto cornered = flee(situation(kDisc, {-9.0, 0.0}, {ball(2, {-6.0, 0.1}, true)}));
    EXPECT_GT(cornered.thrust.x(), 0.0);
    EXPECT_LT(cornered.thrust.y(), -0.5);
}

TEST(Bruiser, charges_and_dashes_when_it_is_close_and_aimed) {
    const auto far = charge(situation(kDisc, {-5.0, 0.0}, {ball(2, {5.0, 0.0}, true)}));
    EXPECT_GT(far.thrust.x(), 0.99);
    EXPECT_FALSE(far.dash);
    EXPECT_TRUE(charge(situation(kDisc, {0.0, 0.0}, {ball(2, {2.5, 0.0}, true)})).dash);
}

TEST(EveryBehaviour, leaves_other_ai_balls_alone_when_no_player_is_there) {
    for (int i = 0; i < 6; ++i) {
        const auto behaviour = static_cast<game::Behaviour>(i);
        const auto intent = decide(behaviour, situation(kDisc, {0.1, 0.0}, {ball(2, {3.0, 0.0})}));
        EXPECT_LT(intent.thrust.norm(), 0.1) << "behaviour " << i;
        EXPECT_FALSE(intent.dash);
    }
}

TEST(Steering, leads_around_the_hole_of_a_ring) {
    const auto here = situation(kRing, {-8.0, 0.0}, {});
    const auto intent = seek(here, {8.0, 0.5});
    EXPECT_GT(std::abs(intent.thrust.y()), 0.5);
}

TEST(Steering, brakes_when_the_stopping_distance_exceeds_the_distance_to_the_edge) {
    auto here = situation(kDisc, {5.0, 0.0}, {});
    here.own.velocity_mps = {6.0, 0.0};  // 36 / 18 = 2 m of the 5 m that are left
    const Intent outward{.thrust = {1.0, 0.0}};
    EXPECT_EQ(kept_on_platform(here, outward, 0.1).thrust, outward.thrust);
    here.own.position_m = {8.0, 0.0};
    const Intent kept = kept_on_platform(here, outward, 0.1);
    EXPECT_LT(kept.thrust.x(), -0.99);
    EXPECT_TRUE(kept.brake);
}

TEST(Steering, sees_the_hole_of_a_ring_as_an_edge) {
    auto here = situation(kRing, {6.0, 0.0}, {});
    here.own.velocity_mps = {-6.0, 0.0};
    const Intent kept = kept_on_platform(here, {.thrust = {-1.0, 0.0}}, 0.1);
    EXPECT_GT(kept.thrust.x(), 0.99);
    EXPECT_TRUE(kept.brake);
}

TEST(Steering, does_not_dash_over_the_edge) {
    const auto here = situation(kDisc, {8.0, 0.0}, {});
    EXPECT_FALSE(kept_on_platform(here, {.thrust = {1.0, 0.0}, .dash = true}, 0.1).dash);
}

TEST(Behaviours, decide_the_same_when_they_see_only_what_matters_to_them) {
    constexpr std::uint64_t kSeed = 11;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Random random(kSeed);
    for (int round = 0; round < 300; ++round) {
        std::vector<SeenBall> all;
        for (std::uint16_t id = 2; id < 30; ++id) {
            all.push_back(ball(id, {random.between(-8.0, 8.0), random.between(-8.0, 8.0)},
                               random.below(5) == 0));
            all.back().behaviour = static_cast<game::Behaviour>(random.below(6));
        }
        const Vec2d own{random.between(-8.0, 8.0), random.between(-8.0, 8.0)};
        for (int i = 0; i <= static_cast<int>(game::Behaviour::kBruiser); ++i) {
            const auto behaviour = static_cast<game::Behaviour>(i);
            std::vector<SeenBall> some = all;
            std::erase_if(some, [&](const SeenBall& other) { return !matters(behaviour, other); });
            EXPECT_LT(some.size(), all.size());
            const Intent seeing_all = decide(behaviour, situation(kRing, own, all));
            const Intent seeing_some = decide(behaviour, situation(kRing, own, some));
            EXPECT_EQ(seeing_all.thrust, seeing_some.thrust) << i;
            EXPECT_EQ(seeing_all.brake, seeing_some.brake) << i;
            EXPECT_EQ(seeing_all.dash, seeing_some.dash) << i;
        }
    }
}

}  // namespace
}  // namespace fts::server::ai
