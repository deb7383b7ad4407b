#include "common/physics/world.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/physics/dice.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

BodyDef ball_at(double x, double y) {
    return {Vec2d(x, y), Vec2d::Zero(), 0.5, 1.0};
}

Scene two_balls() {
    Scene scene;
    scene.bodies.push_back({Vec2d(-2, 0), Vec2d(3, 0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(2, 0), Vec2d(0, 0), 0.5, 1.0});
    return scene;
}

TEST(World, equal_balls_exchange_their_velocities_and_say_so) {
    World<double> world(two_balls());
    const StepReport report = world.step(2.0);
    EXPECT_EQ(report.events, 1U);
    EXPECT_FALSE(report.overrun);
    const BodyId a = world.ids()[0], b = world.ids()[1];
    EXPECT_DOUBLE_EQ(world.body(a).position_m.x(), 1.0);
    EXPECT_DOUBLE_EQ(world.body(b).position_m.x(), 5.0);

    ASSERT_EQ(world.contacts().size(), 1U);
    const Contact<double>& hit = world.contacts()[0];
    EXPECT_EQ(hit.a, a);
    EXPECT_EQ(hit.b, b);
    EXPECT_DOUBLE_EQ(hit.time_s, 1.0);
    EXPECT_DOUBLE_EQ(hit.point_m.x(), 1.5);
    EXPECT_EQ(hit.normal, Vec2d(-1, 0));
    EXPECT_DOUBLE_EQ(hit.impulse_ns, 3.0);
    EXPECT_EQ(hit.velocity_a_before_mps, Vec2d(3, 0));
    EXPECT_EQ(hit.velocity_a_after_mps, Vec2d(0, 0));
    EXPECT_EQ(hit.velocity_b_after_mps, Vec2d(3, 0));
    EXPECT_EQ(world.audit().ball_collisions, 1U);
    EXPECT_EQ(world.audit().energy_seen_j, 4.5);

    world.step(1.0);
    EXPECT_TRUE(world.contacts().empty());
}

TEST(World, a_wall_reflects_and_says_so) {
    Scene scene;
    scene.bodies.push_back({Vec2d(0, 0), Vec2d(0, -2), 0.5, 3.0});
    scene.walls = Walls{Vec2d(-5, -5), Vec2d(5, 5)};
    World<double> world(scene);
    world.step(3.0);
    EXPECT_DOUBLE_EQ(world.body(world.ids()[0]).position_m.y(), -3.0);
    ASSERT_EQ(world.contacts().size(), 1U);
    const Contact<double>& hit = world.contacts()[0];
    EXPECT_FALSE(hit.b);
    EXPECT_DOUBLE_EQ(hit.time_s, 2.25);
    EXPECT_EQ(hit.normal, Vec2d(0, 1));
    EXPECT_EQ(hit.point_m, Vec2d(0, -5));
    EXPECT_DOUBLE_EQ(hit.impulse_ns, 12.0);
    EXPECT_EQ(hit.mass_b_kg, kInfinite);
    EXPECT_EQ(world.audit().wall_collisions, 1U);
}

TEST(World, refuses_what_overlaps_or_is_invalid_and_takes_what_touches) {
    Scene scene;
    scene.platform = Disc{10.0};
    World<double> world(scene);
    EXPECT_TRUE(world.add(ball_at(0, 0)));
    EXPECT_FALSE(world.add(ball_at(0.9, 0)));
    EXPECT_TRUE(world.add(ball_at(1, 0)));
    EXPECT_FALSE(world.add(ball_at(10.5, 0)));
    BodyDef bad = ball_at(5, 5);
    bad.radius_m = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(world.add(bad));
    bad = ball_at(5, 5);
    bad.mass_kg = 0.0;
    EXPECT_FALSE(world.add(bad));
    bad = ball_at(5, 5);
    bad.velocity_mps.x() = kInfinite;
    EXPECT_FALSE(world.add(bad));
    EXPECT_EQ(world.size(), 2U);
}

TEST(World, is_free_where_a_disc_would_overlap_nobody) {
    World<double> world(two_balls());
    EXPECT_TRUE(world.is_free(Vec2d(0, 0), 1.0));
    EXPECT_TRUE(world.is_free(Vec2d(0, 0), 1.5));
    EXPECT_FALSE(world.is_free(Vec2d(0, 0), 1.6));
    EXPECT_FALSE(world.is_free(Vec2d(2, 0), 0.01));
    EXPECT_TRUE(World<double>(Scene()).is_free(Vec2d(0, 0), 1e6));
}

TEST(World, a_removed_id_is_never_valid_again) {
    World<double> world(two_balls());
    const BodyId a = world.ids()[0], b = world.ids()[1];
    EXPECT_TRUE(world.remove(a));
    EXPECT_FALSE(world.remove(a));
    EXPECT_FALSE(world.contains(a));
    EXPECT_TRUE(world.contains(b));
    EXPECT_FALSE(world.contains({77, 0}));
    const auto again = world.add(ball_at(-2, 0));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->index, a.index);
    EXPECT_NE(*again, a);
    EXPECT_FALSE(world.contains(a));
}

TEST(World, freed_slots_are_given_out_lowest_first_and_ids_stay_in_order) {
    World<double> world((Scene()));
    std::vector<BodyId> ids;
    for (int i = 0; i < 8; ++i) ids.push_back(*world.add(ball_at(2 * i, 0)));
    for (const std::size_t i : {5U, 1U, 3U}) world.remove(ids[i]);
    EXPECT_EQ(world.add(ball_at(0, 5))->index, 1U);
    EXPECT_EQ(world.add(ball_at(2, 5))->index, 3U);
    EXPECT_EQ(world.add(ball_at(4, 5))->index, 5U);
    EXPECT_EQ(world.add(ball_at(6, 5))->index, 8U);
    ASSERT_EQ(world.ids().size(), 9U);
    for (std::uint32_t i = 0; i < 9; ++i) EXPECT_EQ(world.ids()[i].index, i);
}

// On a square lattice, each on its way somewhere else, equal in radius.
std::vector<BodyDef> lattice_of(int balls_per_side, double radius_m, Dice& dice) {
    std::vector<BodyDef> balls;
    for (int i = 0; i < balls_per_side * balls_per_side; ++i) {
        const Vec2d place(i % balls_per_side, i / balls_per_side);
        balls.push_back({6.0 * place, dice.in_box(8.0), radius_m, 1.0});
    }
    return balls;
}

TEST(World, balls_that_take_the_places_of_smaller_ones_hit_each_other_as_in_a_new_world) {
    constexpr std::uint64_t kSeed = 71;
    SCOPED_TRACE(kSeed);
    for (const SolverKind kind : {SolverKind::kDiscrete, SolverKind::kSwept, SolverKind::kEvent}) {
        for (const int per_side : {2, 15}) {
            SCOPED_TRACE(testing::Message() << to_string(kind) << ", " << per_side << " a side");
            Dice dice(kSeed);
            Scene small, large;
            small.bodies = lattice_of(per_side, 0.5, dice);
            large.bodies = lattice_of(per_side, 2.0, dice);
            World<double> world(small, {kind, 1}), fresh(large, {kind, 1});
            for (int step = 0; step < 5; ++step) world.step(0.02);
            const std::vector<BodyId> gone(world.ids().begin(), world.ids().end());
            for (const BodyId id : gone) world.remove(id);
            for (const BodyDef& ball : large.bodies) ASSERT_TRUE(world.add(ball));
            const std::uint64_t before = world.audit().ball_collisions;
            for (int step = 0; step < 20; ++step) {
                world.step(0.02);
                fresh.step(0.02);
            }
            EXPECT_EQ(world.audit().ball_collisions - before, fresh.audit().ball_collisions);
            EXPECT_GT(fresh.audit().ball_collisions, 0U);
            ASSERT_EQ(world.ids().size(), fresh.ids().size());
            for (std::size_t i = 0; i < fresh.ids().size(); ++i) {
                const Vec2d off =
                    world.position_m(world.ids()[i]) - fresh.position_m(fresh.ids()[i]);
                EXPECT_LT(off.norm(), 1e-9);
            }
        }
    }
}

TEST(World, a_reused_slot_does_not_inherit_the_control) {
    World<double> world(two_balls());
    world.set_control(world.ids()[0], {Vec2d(9, 9), 1.0});
    world.remove(world.ids()[0]);
    const BodyId ball = *world.add(ball_at(-5, 0));
    world.step(1.0);
    EXPECT_EQ(world.body(ball).velocity_mps, Vec2d(0, 0));
}

TEST(World, mass_and_velocity_can_be_changed_and_count_from_then_on) {
    World<double> world(two_balls());
    const BodyId a = world.ids()[0], b = world.ids()[1];
    world.set_mass(b, 3.0);
    world.set_velocity(a, Vec2d(6, 0));
    EXPECT_EQ(world.body(b).mass_kg, 3.0);
    EXPECT_DOUBLE_EQ(world.kinetic_energy_j(), 18.0);
    EXPECT_DOUBLE_EQ(world.momentum_ns().x(), 6.0);
    world.step(1.0);
    EXPECT_DOUBLE_EQ(world.body(a).velocity_mps.x(), -3.0);
    EXPECT_DOUBLE_EQ(world.body(b).velocity_mps.x(), 3.0);
}

TEST(World, an_infinite_mass_stands_like_a_rock) {
    Scene scene = two_balls();
    scene.bodies[1].mass_kg = kInfinite;
    World<double> world(scene);
    world.step(2.0);
    EXPECT_EQ(world.body(world.ids()[1]).position_m, Vec2d(2, 0));
    EXPECT_EQ(world.body(world.ids()[0]).velocity_mps, Vec2d(-3, 0));
    EXPECT_DOUBLE_EQ(world.kinetic_energy_j(), 4.5);
    EXPECT_EQ(world.audit().worst_energy_error, 0.0);
}

TEST(World, infinite_masses_pass_through_their_like_and_the_walls) {
    Scene scene = two_balls();
    scene.bodies[0].mass_kg = scene.bodies[1].mass_kg = kInfinite;
    scene.walls = Walls{Vec2d(-5, -5), Vec2d(5, 5)};
    World<double> world(scene);
    const StepReport report = world.step(4.0);
    EXPECT_EQ(report.events, 0U);
    EXPECT_EQ(world.body(world.ids()[0]).position_m, Vec2d(10, 0));
}

TEST(World, works_from_empty_and_at_any_extent) {
    World<double> world((Scene()));
    EXPECT_EQ(world.step(1.0).events, 0U);
    for (const double far_m : {0.0, 1e3, 1e6, 1e8}) {
        ASSERT_TRUE(world.add({Vec2d(far_m - 2, -far_m), Vec2d(2, 0), 0.5, 1.0}));
        ASSERT_TRUE(world.add({Vec2d(far_m + 2, -far_m), Vec2d(-2, 0), 0.5, 1.0}));
    }
    EXPECT_EQ(world.step(1.0).events, 4U);
}

TEST(World, a_step_of_no_time_changes_nothing) {
    World<double> world(two_balls());
    world.set_control(world.ids()[0], {Vec2d(9, 9), 1.0});
    const std::uint64_t before = world.state_hash();
    EXPECT_EQ(world.step(0.0).events, 0U);
    EXPECT_EQ(world.state_hash(), before);
}

TEST(World, the_hash_sees_every_part_of_the_state) {
    const std::uint64_t hash = World<double>(two_balls()).state_hash();
    EXPECT_EQ(World<double>(two_balls()).state_hash(), hash);
    const auto hash_of = [](auto change) {
        Scene scene = two_balls();
        change(scene.bodies[1]);
        return World<double>(scene).state_hash();
    };
    EXPECT_NE(hash_of([](BodyDef& b) { b.position_m.x() += 1e-15; }), hash);
    EXPECT_NE(hash_of([](BodyDef& b) { b.velocity_mps.y() = 5e-324; }), hash);
    EXPECT_NE(hash_of([](BodyDef& b) { b.radius_m = 0.25; }), hash);
    EXPECT_NE(hash_of([](BodyDef& b) { b.mass_kg = 2.0; }), hash);
}

TEST(World, can_be_moved) {
    World<double> world(two_balls());
    World<double> other = std::move(world);
    other.step(2.0);
    EXPECT_EQ(other.contacts().size(), 1U);
}

TEST(World, single_precision_collides_the_same_way) {
    World<float> world(two_balls());
    world.step(2.0F);
    EXPECT_FLOAT_EQ(world.body(world.ids()[1]).position_m.x(), 5.0F);
}

// One is asked for positions alone, another for everything, a third for nothing until the end.
TEST(World, is_the_same_whatever_it_is_asked_for_on_the_way) {
    for (const SolverKind kind : {SolverKind::kDiscrete, SolverKind::kSwept, SolverKind::kEvent}) {
        SCOPED_TRACE(to_string(kind));
        Scene scene;
        scene.walls = Walls{Vec2d(-6, -6), Vec2d(6, 6)};
        for (int i = 0; i < 25; ++i) {
            scene.bodies.push_back({Vec2d(2.0 * (i % 5) - 4.0, 2.0 * (i / 5) - 4.0),
                                    Vec2d(3.0 - i % 7, i % 5 - 2.5), 0.5, 1.0 + i % 3});
        }
        World<double> looked_at(scene, {kind, 1}), read(scene, {kind, 1}), left(scene, {kind, 1});
        for (int tick = 0; tick < 120; ++tick) {
            for (World<double>* world : {&looked_at, &read, &left}) world->step(1.0 / 60.0);
            for (const BodyId id : read.ids()) {
                ASSERT_EQ(looked_at.position_m(id), read.body(id).position_m) << tick;
            }
            if (tick % 40 != 39) continue;
            for (const BodyId id : read.ids()) {
                ASSERT_EQ(looked_at.body(id).velocity_mps, read.body(id).velocity_mps) << tick;
            }
            for (World<double>* world : {&looked_at, &read, &left}) {
                world->set_velocity(world->ids()[3], Vec2d(0.5, -4.0));
            }
        }
        EXPECT_GT(read.audit().ball_collisions, 20U);
        EXPECT_EQ(looked_at.state_hash(), read.state_hash());
        EXPECT_EQ(left.state_hash(), read.state_hash());
    }
}

}  // namespace
}  // namespace fts::physics
