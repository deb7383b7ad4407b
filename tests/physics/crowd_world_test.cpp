// What holds of a world whose crowd the event solver foresees in windows of time.
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/solver_event.h"
#include "common/physics/world.h"
#include "tests/harness/sanitized.h"
#include "tests/physics/crowds.h"
#include "tests/physics/event_lives.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr SolverChoice kWindows{.kind = SolverKind::kEvent};

void expect_same_contacts(const World<double>& one, const World<double>& other, double within_s) {
    ASSERT_EQ(one.contacts().size(), other.contacts().size());
    for (std::size_t i = 0; i < one.contacts().size(); ++i) {
        const Contact<double>&seen = one.contacts()[i], &expected = other.contacts()[i];
        ASSERT_EQ(seen.a, expected.a) << i;
        ASSERT_EQ(seen.b, expected.b) << i;
        ASSERT_NEAR(seen.time_s, expected.time_s, within_s) << i;
    }
}

TEST(CrowdWorld, a_walled_crowd_keeps_its_energy_over_many_collisions) {
    constexpr std::uint64_t kSeed = 521;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const double largest_m : {0.5, 1.5}) {
        SCOPED_TRACE(largest_m);
        World<double> world(random_crowd({.max_radius_m = largest_m, .filled = 0.3}, dice),
                            kWindows);
        const double energy_j = world.kinetic_energy_j();
        const std::uint64_t enough = harness::kSanitized ? 10'000 : 200'000;
        while (world.audit().ball_collisions < enough) {
            ASSERT_FALSE(world.step(1.0).overrun);
            ASSERT_LT(world.deepest_overlap(), 1e-12);
        }
        EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-12);
        EXPECT_LT(world.audit().worst_penetration, 1e-11);
        EXPECT_EQ(world.audit().unfinished_sets, 0U);
        EXPECT_TRUE(all_finite(world));
    }
}

TEST(CrowdWorld, bodies_added_removed_and_kicked_between_ticks_are_honoured) {
    for (const std::uint64_t seed : {522U, 523U, 524U}) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        const Scene scene = random_crowd({.max_radius_m = seed % 2 == 0 ? 0.5 : 0.9}, dice);
        const double half_width = 0.5 * (scene.walls->max_m - scene.walls->min_m).x();
        World<double> windows(scene, kWindows), swept(scene);
        std::size_t hits = 0;
        for (int change = 0; change < 8; ++change) {
            const BodyDef ball{dice.in_box(half_width - 1.0), dice.in_box(5.0), 0.3, 2.0};
            const Vec2d velocity = dice.in_box(8.0);
            const std::size_t nth = dice.below(windows.size());
            EXPECT_EQ(windows.add(ball), swept.add(ball));
            const std::vector<BodyId> ids(windows.ids().begin(), windows.ids().end());
            for (World<double>* world : {&windows, &swept}) {
                world->remove(ids[nth]);
                world->set_velocity(world->ids()[nth / 2], velocity);
                world->set_mass(world->ids()[nth / 3], 3.0);
            }
            for (int tick = 0; tick < 5; ++tick) {
                windows.step(kTick);
                swept.step(kTick);
                expect_same_contacts(windows, swept, 1e-9);
                if (HasFatalFailure()) return;
                hits += swept.contacts().size();
            }
            ASSERT_EQ(windows.size(), swept.size());
            for (const BodyId id : swept.ids()) {
                ASSERT_LT((windows.position_m(id) - swept.position_m(id)).norm(), 1e-8);
            }
        }
        EXPECT_GT(hits, 300U);
    }
}

Scene crowd_on_a_disc(double radius_m, double speed_mps, Dice& dice) {
    Scene scene = random_crowd({.max_speed_mps = speed_mps}, dice);
    scene.walls.reset();
    stand_on(Disc{radius_m}, scene);
    return scene;
}

TEST(CrowdWorld, a_crowd_that_falls_until_few_are_left_is_kicked_and_goes_on) {
    constexpr std::uint64_t kSeed = 525;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = crowd_on_a_disc(17.0, 8.0, dice);
    ASSERT_GT(scene.bodies.size(), kFewestInWindows);
    World<double> windows(scene, kWindows), swept(scene);
    const auto step_both = [&] {
        windows.step(0.5 * kTick);
        swept.step(0.5 * kTick);
        expect_same_contacts(windows, swept, 1e-8);
        ASSERT_EQ(windows.falls().size(), swept.falls().size());
        for (std::size_t i = 0; i < swept.falls().size(); ++i) {
            ASSERT_EQ(windows.falls()[i].id, swept.falls()[i].id);
            ASSERT_NEAR(windows.falls()[i].time_s, swept.falls()[i].time_s, 1e-8);
        }
    };
    for (int tick = 0; swept.size() >= kFewestInWindows && tick < 200; ++tick) {
        step_both();
        if (HasFatalFailure()) return;
    }
    for (World<double>* world : {&windows, &swept}) {
        for (const BodyId id : world->ids()) {
            world->set_velocity(id, -0.5 * world->body(id).velocity_mps);
        }
    }
    for (int tick = 0; tick < 20; ++tick) {
        step_both();
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(swept.audit().ball_collisions, 100U);
}

TEST(CrowdWorld, a_crowd_falls_to_the_last_ball_and_the_empty_world_goes_on) {
    constexpr std::uint64_t kSeed = 526;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = crowd_on_a_disc(17.0, 8.0, dice);
    World<double> fine(scene, kWindows), coarse(scene, kWindows);
    std::size_t fallen = 0;
    for (int tick = 0; tick < 6000; ++tick) {
        ASSERT_FALSE(fine.step(0.1).overrun) << tick;
        fallen += fine.falls().size();
    }
    for (int tick = 0; tick < 10; ++tick) ASSERT_FALSE(coarse.step(60.0).overrun) << tick;
    EXPECT_EQ(fine.size() + fallen, scene.bodies.size());
    EXPECT_LT(fine.size(), 3U);
    EXPECT_EQ(coarse.state_hash(), fine.state_hash());
}

TEST(CrowdWorld, all_that_are_left_of_a_crowd_fall_at_once) {
    Scene scene;
    scene.platform = Rectangle{{10.0, 1000.0}};
    for (int i = 0; i < 300; ++i) {
        scene.bodies.push_back({Vec2d(0.0, 2.0 * i - 300.0), Vec2d(4.0, 0.0), 0.5, 1.0});
    }
    World<double> world(scene, kWindows);
    for (int tick = 0; tick < 24; ++tick) ASSERT_EQ(world.step(0.1).events, 0U);
    EXPECT_EQ(world.step(0.2).events, 300U);
    EXPECT_EQ(world.falls().front().id.index, 0U);
    EXPECT_EQ(world.size(), 0U);
    for (int tick = 0; tick < 100; ++tick) ASSERT_FALSE(world.step(1.0).overrun);
    ASSERT_TRUE(world.add({Vec2d::Zero(), Vec2d(4.0, 0.0), 0.5, 1.0}).has_value());
    EXPECT_EQ(world.step(3.0).events, 1U);
}

TEST(CrowdWorld, a_second_in_one_tick_or_in_six_hundred_has_the_same_collisions_to_the_last_bit) {
    constexpr std::uint64_t kSeed = 529;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const double largest_m : {0.5, 1.5}) {
        const Scene scene = random_crowd({.max_radius_m = largest_m}, dice);
        World<double> once(scene, kWindows), often(scene, kWindows);
        std::vector<Contact<double>> expected;
        for (int second = 0; second < 3; ++second) {
            once.step(1.0);
            expected.insert(expected.end(), once.contacts().begin(), once.contacts().end());
        }
        EXPECT_GT(expected.size(), 500U);
        std::size_t seen = 0;
        for (int tick = 0; tick < 1800; ++tick) {
            often.step(1.0 / 600.0);
            for (const Contact<double>& hit : often.contacts()) {
                ASSERT_LT(seen, expected.size());
                const Contact<double>& same = expected[seen++];
                ASSERT_EQ(hit.a, same.a);
                ASSERT_EQ(hit.b, same.b);
                ASSERT_EQ(hit.position_a_m, same.position_a_m);
                ASSERT_EQ(hit.velocity_a_after_mps, same.velocity_a_after_mps);
            }
        }
        EXPECT_EQ(seen, expected.size());
    }
}

// A power of two changes no digit.
TEST(CrowdWorld, a_crowd_does_not_know_its_scale) {
    constexpr std::uint64_t kSeed = 532;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = random_crowd({.max_radius_m = 1.2}, dice);
    World<double> world(scene, kWindows);
    for (int tick = 0; tick < 120; ++tick) world.step(kTick);
    for (const double scale : {0x1p-18, 0x1p16}) {
        SCOPED_TRACE(scale);
        Scene scaled = scene;
        scaled.walls->min_m *= scale;
        scaled.walls->max_m *= scale;
        for (BodyDef& body : scaled.bodies) {
            body.position_m *= scale;
            body.velocity_mps *= scale;
            body.radius_m *= scale;
        }
        World<double> other(scaled, kWindows);
        for (int tick = 0; tick < 120; ++tick) other.step(kTick);
        EXPECT_EQ(other.audit().ball_collisions, world.audit().ball_collisions);
        for (const BodyId id : world.ids()) {
            ASSERT_EQ(Vec2d(scale * world.position_m(id)), other.position_m(id));
        }
    }
}

TEST(CrowdWorld, under_the_drag_of_its_scene_a_crowd_moves_as_in_the_swept_solver) {
    constexpr std::uint64_t kSeed = 533;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_crowd({.max_radius_m = 0.8}, dice);
    scene.drag_per_s = 1.5;
    World<double> windows(scene, kWindows), swept(scene);
    for (int tick = 0; tick < 60; ++tick) {
        windows.step(kTick);
        swept.step(kTick);
        expect_same_contacts(windows, swept, 1e-9);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(swept.audit().ball_collisions, 200U);
    for (const BodyId id : swept.ids()) {
        ASSERT_LT((windows.position_m(id) - swept.position_m(id)).norm(), 1e-9);
    }
    for (int second = 0; second < 1000; ++second) ASSERT_FALSE(windows.step(1.0).overrun);
    EXPECT_LT(windows.kinetic_energy_j(), 1e-100);
    EXPECT_LT(windows.deepest_overlap(), 1e-12);
}

template <typename Scalar>
std::uint64_t hash_after_a_crowded_life(std::uint64_t seed) {
    Dice dice(seed);
    const Scene walled = random_crowd({.balls = 400}, dice);
    Scene mixed = random_crowd({.balls = 400, .max_radius_m = 1.5}, dice);
    mixed.restitution = 0.97;
    Scene standing = random_crowd({.balls = 400, .max_radius_m = 0.8}, dice);
    standing.walls.reset();
    stand_on(Disc{20.0}, standing);
    const Scene scenes[] = {walled, mixed, standing};
    return hash_after_visits<Scalar>(scenes, 180, 60, dice);
}

// Change these only together with a change of the physics that is meant to change trajectories, or
// of how long windows are.
TEST(CrowdEventDeterminism, golden_hash_in_double_precision) {
    EXPECT_EQ(hash_after_a_crowded_life<double>(2013), 0x521d230998479acbULL);
}

TEST(CrowdEventDeterminism, golden_hash_in_single_precision) {
    EXPECT_EQ(hash_after_a_crowded_life<float>(2013), 0x9c5b23a08dd4dca8ULL);
}

}  // namespace
}  // namespace fts::physics
