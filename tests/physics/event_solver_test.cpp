// The event solver: the same physics as the swept one, kept across ticks.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/coasting.h"
#include "common/physics/periodic.h"
#include "common/physics/solver_event.h"
#include "common/physics/solver_swept.h"
#include "common/physics/world.h"
#include "tests/harness/sanitized.h"
#include "tests/physics/brute_force.h"
#include "tests/physics/event_lives.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr SolverChoice kEvent{.kind = SolverKind::kEvent};

struct Collision {
    BodyId a;
    std::optional<BodyId> b;
    double time_s;
};

std::vector<Collision> collisions_of(World<double>& world, int ticks, double tick_s) {
    std::vector<Collision> all;
    for (int tick = 0; tick < ticks; ++tick) {
        world.step(tick_s);
        for (const Contact<double>& hit : world.contacts()) {
            all.push_back({hit.a, hit.b, tick * tick_s + hit.time_s});
        }
    }
    return all;
}

void expect_same(const std::vector<Collision>& expected, const std::vector<Collision>& seen,
                 double within_s) {
    ASSERT_EQ(expected.size(), seen.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_EQ(expected[i].a, seen[i].a) << i;
        ASSERT_EQ(expected[i].b, seen[i].b) << i;
        ASSERT_NEAR(expected[i].time_s, seen[i].time_s, within_s) << i;
    }
}

double farthest_apart_m(const World<double>& one, const World<double>& other) {
    double farthest = 0.0;
    for (const BodyId id : one.ids()) {
        farthest = std::max(farthest, (one.body(id).position_m - other.body(id).position_m).norm());
    }
    return farthest;
}

Scene periodic_gas(const Gas& gas, Dice& dice) {
    Scene scene = random_gas(gas, dice);
    scene.periodic = {scene.walls->min_m, scene.walls->max_m};
    scene.walls.reset();
    return scene;
}

class EventAgainstSwept : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, EventAgainstSwept, testing::Range<std::uint64_t>(300, 312));

TEST_P(EventAgainstSwept, the_same_pairs_collide_at_the_same_times_in_the_same_order) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    const Gas gas{.balls = 40 + dice.below(60), .half_width_m = dice.between(10.0, 14.0)};
    const Scene walled = random_gas(gas, dice);
    Scene open = walled;
    open.walls.reset();
    for (const Scene& scene : {walled, open, periodic_gas(gas, dice)}) {
        World<double> event(scene, kEvent), swept(scene);
        const auto expected = collisions_of(swept, 60, kTick);
        EXPECT_GT(expected.size(), 10U);
        expect_same(expected, collisions_of(event, 60, kTick), 1e-10);
        EXPECT_LT(farthest_apart_m(event, swept), 1e-9);
    }
}

// With one or two cells along an axis the same neighbours are seen on both sides.
TEST_P(EventAgainstSwept, in_periodic_boxes_hardly_wider_than_two_balls) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    std::uint64_t hits = 0;
    for (const Vec2d& box_m : {Vec2d(2.02, 2.02), Vec2d(2.02, 3.3), Vec2d(2.2, 2.02),
                               Vec2d(2.6, 9.0), Vec2d(3.5, 3.5), Vec2d(30.0, 2.1)}) {
        Scene scene;
        scene.periodic = {Vec2d::Zero(), box_m};
        scene.bodies.push_back({Vec2d(0.1, 0.2), dice.in_box(3.0), 0.5, 1.0});
        scene.bodies.push_back({Vec2d(1.11, 1.21), dice.in_box(3.0), 0.5, 1.7});
        World<double> event(scene, kEvent), swept(scene);
        const double energy_j = event.kinetic_energy_j();
        // The box amplifies round-off: while that is small, the sequences agree.
        expect_same(collisions_of(swept, 8, kTick), collisions_of(event, 8, kTick), 1e-9);
        for (int tick = 0; tick < 600; ++tick) {
            ASSERT_FALSE(event.step(kTick).overrun);
            ASSERT_LT(event.deepest_overlap(), 1e-12);
        }
        hits += event.audit().ball_collisions;
        EXPECT_NEAR(event.kinetic_energy_j() / energy_j, 1.0, 1e-12);
    }
    EXPECT_GT(hits, 50U);
}

TEST_P(EventAgainstSwept, bodies_added_removed_and_kicked_between_ticks_are_honoured) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    const Scene scene = random_gas({.balls = 40}, dice);
    World<double> event(scene, kEvent), swept(scene);
    for (int change = 0; change < 8; ++change) {
        const Vec2d velocity = dice.in_box(8.0);
        const BodyDef ball{dice.in_box(9.0), dice.in_box(5.0), 0.3, 2.0};
        const std::size_t nth = dice.below(event.size());
        EXPECT_EQ(event.add(ball), swept.add(ball));
        const std::vector<BodyId> ids(event.ids().begin(), event.ids().end());
        for (World<double>* world : {&event, &swept}) {
            world->remove(ids[nth]);
            world->set_velocity(world->ids()[nth / 2], velocity);
            world->set_mass(world->ids()[nth / 3], 3.0);
        }
        expect_same(collisions_of(swept, 5, kTick), collisions_of(event, 5, kTick), 1e-9);
        EXPECT_LT(farthest_apart_m(event, swept), 1e-8);
        EXPECT_EQ(event.size(), swept.size());
    }
}

TEST_P(EventAgainstSwept, under_thrust_and_drag_in_every_tick) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    Scene scene = random_gas({.balls = 30}, dice);
    World<double> event(scene, kEvent), swept(scene);
    for (const BodyId id : event.ids()) {
        const Control<double> control{dice.in_box(10.0), 0.4};
        event.set_control(id, control);
        swept.set_control(id, control);
    }
    expect_same(collisions_of(swept, 60, kTick), collisions_of(event, 60, kTick), 1e-8);
}

class EventAgainstBruteForce : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, EventAgainstBruteForce, testing::Range<std::uint64_t>(100, 130));

void expect_same(const World<double>& world, const Outcome& oracle, double within) {
    EXPECT_EQ(world.audit().ball_collisions, oracle.ball_collisions);
    EXPECT_EQ(world.audit().wall_collisions, oracle.wall_collisions);
    for (const BodyId id : world.ids()) {
        const BodyDef& expected = oracle.bodies[id.index];
        EXPECT_LE((world.body(id).position_m - expected.position_m).norm(), within) << id.index;
        EXPECT_LE((world.body(id).velocity_mps - expected.velocity_mps).norm(), within) << id.index;
    }
}

TEST_P(EventAgainstBruteForce, a_walled_gas_moves_the_same) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    Gas gas;
    gas.balls = 2 + dice.below(60);
    gas.half_width_m = dice.between(10.0, 40.0);
    gas.min_radius_m = dice.of_any_size(0.01, 0.5);
    const Scene scene = random_gas(gas, dice);
    World<double> world(scene, kEvent);
    world.step(1.5);
    expect_same(world, coast(scene, 1.5), 1e-9);
}

TEST_P(EventAgainstBruteForce, the_same_bodies_fall_at_their_times_from_each_platform) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    for (const Platform& platform :
         {Platform(Disc{15.0}), Platform(Rectangle{{11.0, 12.0}}), Platform(Ring{1.0, 15.0})}) {
        for (const bool walled : {false, true}) {
            Scene scene = random_gas({.balls = 40, .walled = walled}, dice);
            if (walled) scene.walls->min_m.x() = -30.0;
            scene.platform = platform;
            std::erase_if(scene.bodies, [&](const BodyDef& body) {
                return distance_to_edge_m(platform, body.position_m) < 0.0;
            });
            World<double> world(scene, kEvent);
            world.step(2.0);
            const Outcome oracle = coast(scene, 2.0);
            expect_same(world, oracle, 1e-9);
            ASSERT_EQ(world.falls().size(), oracle.fallen.size());
            for (std::size_t i = 0; i < oracle.fallen.size(); ++i) {
                EXPECT_EQ(world.falls()[i].id.index, oracle.fallen[i]);
                EXPECT_NEAR(distance_to_edge_m(platform, world.falls()[i].position_m), 0.0, 1e-13);
            }
        }
    }
}

TEST_P(EventAgainstBruteForce, radii_from_a_thousandth_to_a_thousand_move_the_same) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    Scene scene;
    while (scene.bodies.size() < 40) {
        const double radius_m = dice.of_any_size(1e-3, 1e3);
        const BodyDef ball{dice.in_box(2500.0), dice.in_box(600.0), radius_m, radius_m};
        Scene more = scene;
        more.bodies.push_back(ball);
        if (!validate(more)) scene = more;
    }
    World<double> world(scene, kEvent);
    for (int second = 0; second < 8; ++second) world.step(1.0);
    const Outcome oracle = coast(scene, 8.0);
    EXPECT_GT(oracle.ball_collisions, 0U);
    expect_same(world, oracle, 1e-6);
}

TEST(EventSolver, a_walled_box_keeps_its_energy_over_a_million_collisions) {
    Dice dice(61);
    World<double> world(random_gas({.balls = 200, .half_width_m = 14.0}, dice), kEvent);
    const double energy_j = world.kinetic_energy_j();
    const std::uint64_t enough = harness::kSanitized ? 50'000 : 1'000'000;
    while (world.audit().ball_collisions + world.audit().wall_collisions < enough) {
        ASSERT_FALSE(world.step(10.0).overrun);
    }
    EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-12);
    EXPECT_LT(world.deepest_overlap(), 1e-12);
    EXPECT_LT(world.audit().worst_penetration, 1e-11);
}

TEST(EventSolver, a_second_in_one_tick_or_in_six_hundred_has_the_same_collisions_to_the_last_bit) {
    constexpr std::uint64_t kSeed = 62;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Gas gas{.balls = 200, .half_width_m = 14.0, .max_speed_mps = 20.0};
    for (const Scene& scene : {random_gas(gas, dice), periodic_gas(gas, dice)}) {
        World<double> once(scene, kEvent), often(scene, kEvent);
        std::vector<Contact<double>> expected;
        for (int second = 0; second < 3; ++second) {
            once.step(1.0);
            expected.insert(expected.end(), once.contacts().begin(), once.contacts().end());
        }
        EXPECT_GT(expected.size(), 2000U);
        std::size_t seen = 0;
        for (int tick = 0; tick < 1800; ++tick) {
            often.step(1.0 / 600.0);
            for (const Contact<double>& hit : often.contacts()) {
                ASSERT_EQ(hit.a, expected[seen].a) << seen;
                ASSERT_EQ(hit.b, expected[seen].b) << seen;
                ASSERT_EQ(hit.velocity_a_after_mps, expected[seen].velocity_a_after_mps) << seen;
                ++seen;
            }
        }
        EXPECT_EQ(seen, expected.size());
        EXPECT_LT(farthest_apart_m(once, often), 1e-12);
    }
}

TEST(EventSolver, the_cells_show_in_no_more_than_the_round_off_of_the_clock) {
    constexpr std::uint64_t kSeed = 63;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = random_gas({.balls = 40, .walled = false}, dice);
    Scene wider = scene;
    for (int i = 0; i < 30; ++i) {
        wider.bodies.push_back({Vec2d(1e6 + 10 * i, -5e5), Vec2d(1e4, 1e4), 3.0, 1.0});
    }
    World<double> alone(scene, kEvent), accompanied(wider, kEvent);
    for (int tick = 0; tick < 300; ++tick) {
        alone.step(kTick);
        accompanied.step(kTick);
    }
    EXPECT_GT(alone.audit().ball_collisions, 10U);
    EXPECT_LT(farthest_apart_m(alone, accompanied), 1e-13);
}

std::vector<BodyDef> two_balls_far_apart() {
    return {{Vec2d(-50.0, 0.0), Vec2d(1.0, 0.0), 0.5, 1.0},
            {Vec2d(50.0, 0.0), Vec2d(-1.0, 0.0), 0.5, 1.0}};
}

TEST(EventSolver, a_quiet_drift_neither_reads_nor_writes_the_bodies) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Bodies<double> bodies;
    for (const BodyDef& body : two_balls_far_apart()) {
        bodies.add(body.position_m, body.velocity_mps, body.radius_m, body.mass_kg);
    }
    const Model<double> model;
    Record<double> record;
    const auto solver = make_event_solver<double>();
    EXPECT_EQ(solver->drift(bodies, model, 1.0, record).events, 0U);
    bodies.position_m.assign(2, Vec2d(nan, nan));
    bodies.velocity_mps.assign(2, Vec2d(nan, nan));
    for (int tick = 0; tick < 10; ++tick) {
        EXPECT_EQ(solver->drift(bodies, model, 1.0, record).events, 0U);
        EXPECT_TRUE(std::isnan(bodies.position_m[0].x()));
    }
    solver->synchronise(bodies);
    EXPECT_EQ(bodies.position_m[0], Vec2d(-39.0, 0.0));
    EXPECT_EQ(bodies.velocity_mps[1], Vec2d(-1.0, 0.0));
    bodies.position_m[0].x() = 7.0;
    solver->synchronise(bodies);
    EXPECT_EQ(bodies.position_m[0].x(), 7.0) << "what is up to date is not written again";
    EXPECT_EQ(solver->drift(bodies, model, 38.6, record).events, 1U);
}

TEST(EventSolver, in_a_quiet_span_no_entry_of_the_calendar_comes_up) {
    constexpr std::uint64_t kSeed = 64;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Bodies<double> bodies;
    for (const BodyDef& body : random_gas({.balls = 500, .half_width_m = 60.0}, dice).bodies) {
        bodies.add(body.position_m, body.velocity_mps, body.radius_m, body.mass_kg);
    }
    Coasting<double> coasting;
    coasting.begin(bodies, Model<double>());
    for (int tick = 0; tick < 1000; ++tick) {
        coasting.begin_span(1e-8, 0);
        ASSERT_EQ(coasting.next().what, Happening::kNothing);
        coasting.end_span();
    }
    coasting.begin_span(1.0, 0);
    EXPECT_EQ(coasting.next().what, Happening::kUnfinished);
}

TEST(EventSolver, bodies_that_escaped_from_an_open_scene_still_meet) {
    constexpr std::uint64_t kSeed = 65;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_gas({.balls = 150, .max_speed_mps = 30.0, .walled = false}, dice);
    const std::size_t first = scene.bodies.size();
    scene.bodies.push_back({Vec2d(-5e4, 7e4), Vec2d(99.0, 0.0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(5e4, 7e4), Vec2d(-101.0, 0.0), 0.5, 1.0});
    World<double> world(scene, kEvent);
    const double energy_j = world.kinetic_energy_j();
    for (int second = 0; second < 600; ++second) ASSERT_FALSE(world.step(1.0).overrun);
    EXPECT_GT(world.audit().ball_collisions, 100U);
    EXPECT_EQ(world.body(world.ids()[first]).velocity_mps, Vec2d(-101.0, 0.0));
    EXPECT_EQ(world.body(world.ids()[first + 1]).velocity_mps, Vec2d(99.0, 0.0));
    EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-13);
    EXPECT_EQ(world.deepest_overlap(), 0.0);
}

TEST(EventSolver, a_ball_falls_at_the_exact_time_it_crosses_the_edge) {
    Scene scene;
    scene.platform = Disc{10.0};
    scene.bodies.push_back({Vec2d(-6.0, 6.0), Vec2d(4.0, 0.0), 0.5, 1.0});  // leaves at x = 8
    scene.bodies.push_back({Vec2d(0.0, -5.0), Vec2d(0.0, -2.0), 0.5, 1.0});
    World<double> world(scene, kEvent);
    world.step(2.0);
    EXPECT_EQ(world.size(), 2U);
    world.step(2.0);
    ASSERT_EQ(world.falls().size(), 2U);
    EXPECT_DOUBLE_EQ(world.falls()[0].time_s, 0.5);
    EXPECT_NEAR((world.falls()[0].position_m - Vec2d(0.0, -10.0)).norm(), 0.0, 1e-14);
    EXPECT_DOUBLE_EQ(world.falls()[1].time_s, 1.5);
    EXPECT_NEAR((world.falls()[1].position_m - Vec2d(8.0, 6.0)).norm(), 0.0, 1e-14);
    EXPECT_EQ(world.size(), 0U);
    world.step(2.0);
    EXPECT_TRUE(world.falls().empty());
}

TEST(EventSolver, in_a_periodic_box_two_balls_meet_again_through_the_other_image) {
    Scene scene;
    scene.periodic = {Vec2d(-5.0, -5.0), Vec2d(5.0, 5.0)};
    scene.bodies.push_back({Vec2d(-3.0, 1.0), Vec2d(1.0, 0.0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(3.0, 1.0), Vec2d(0.0, 0.0), 0.5, 1.0});
    World<double> world(scene, kEvent);
    // First after 5 s, then each flies 8 m to the image of the other.
    std::uint64_t hits = 0;
    for (int tick = 0; tick < 1000; ++tick) hits += world.step(0.5).events;
    EXPECT_EQ(hits, 1U + 495U / 8U);
    EXPECT_EQ(world.kinetic_energy_j(), 0.5);
}

TEST(EventSolver, a_periodic_scene_does_not_know_where_its_box_begins) {
    constexpr std::uint64_t kSeed = 66;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = periodic_gas({.balls = 60, .half_width_m = 8.0}, dice);
    World<double> here(scene, kEvent);
    const auto expected = collisions_of(here, 60, kTick);
    EXPECT_GT(expected.size(), 50U);
    for (const Vec2d& shift : {Vec2d(3.0, 0.0), Vec2d(-5.5, 7.25), Vec2d(8.0, 8.0)}) {
        Scene moved = scene;
        for (BodyDef& body : moved.bodies) {
            body.position_m = wrapped<double>(body.position_m + shift,
                                              {scene.periodic->min_m, scene.periodic->max_m});
        }
        World<double> there(moved, kEvent);
        expect_same(expected, collisions_of(there, 60, kTick), 1e-6);
        for (const BodyId id : there.ids()) {
            EXPECT_LT((there.body(id).velocity_mps - here.body(id).velocity_mps).norm(), 1e-5);
        }
    }
}

template <typename Scalar>
std::uint64_t hash_after_a_life_of_events(std::uint64_t seed) {
    Dice dice(seed);
    const Gas gas{.balls = 120, .half_width_m = 12.0, .max_speed_mps = 10.0};
    Scene walled = random_gas(gas, dice), open = walled;
    walled.restitution = 0.97;
    open.walls.reset();
    open.platform = Disc{18.0};
    const Scene scenes[] = {walled, open, periodic_gas(gas, dice)};
    return hash_after_visits<Scalar>(scenes, 300, 100, dice);
}

// Change these only together with a change of the physics that is meant to change trajectories.
TEST(EventDeterminism, golden_hash_in_double_precision) {
    EXPECT_EQ(hash_after_a_life_of_events<double>(2013), 0xf92ce7ebff76109ULL);
}

TEST(EventDeterminism, golden_hash_in_single_precision) {
    EXPECT_EQ(hash_after_a_life_of_events<float>(2013), 0xff1abd8f4d7995fULL);
}

TEST(EventSolver, in_single_precision_the_clock_is_as_good_after_ten_thousand_seconds_as_at_once) {
    Scene scene;
    scene.walls = Walls{Vec2d(0.0, 0.0), Vec2d(8.0, 8.0)};
    scene.bodies.push_back({Vec2d(4.0, 4.0), Vec2d(1.75, 0.0), 0.5, 1.0});  // to and fro in 8 s
    World<float> world(scene, kEvent);
    const float tick_s = 1.0F / 60.0F;
    int ticks = 0;
    while (ticks < 600'000) {
        for (int next = ticks + 60; ticks < next; ++ticks) world.step(tick_s);
        const double time_s = ticks * static_cast<double>(tick_s);
        const double way_m = std::fmod(3.5 + 1.75 * time_s, 14.0);
        const double expected_m = 0.5 + (way_m < 7.0 ? way_m : 14.0 - way_m);
        const double seen_m = static_cast<double>(world.body(world.ids()[0]).position_m.x());
        ASSERT_NEAR(seen_m, expected_m, 1e-6) << time_s;
    }
}

TEST(EventSolver, budget_of_events_ends_a_drift_that_would_not_end_and_goes_on_in_the_next) {
    Scene scene;
    scene.walls = Walls{Vec2d(-1.0, -50.0), Vec2d(1.0, 50.0)};
    scene.bodies.push_back({Vec2d(0.0, 0.0), Vec2d(1.0, 0.0), 0.5, 1.0});
    World<double> world(scene, kEvent);
    const double budget = event_budget(1);
    const StepReport report = world.step(budget + 1.0);
    EXPECT_TRUE(report.overrun);
    EXPECT_EQ(report.events, event_budget(1));
    EXPECT_NEAR(report.unspent_time_s, 1.5, 1e-9);
    EXPECT_EQ(std::abs(world.body(world.ids()[0]).position_m.x()), 0.5);
    const StepReport rest = world.step(report.unspent_time_s);
    EXPECT_FALSE(rest.overrun);
    EXPECT_EQ(rest.events, 1U);
    EXPECT_NEAR(world.body(world.ids()[0]).position_m.x(), 0.0, 1e-9);
}

TEST(EventSolver, inelastic_balls_collapse_without_overrun) {
    for (const double restitution : {0.0, 0.1, 0.5, 0.9}) {
        SCOPED_TRACE(restitution);
        constexpr std::uint64_t kSeed = 44;
        Dice dice(kSeed);
        Scene scene = random_gas({.balls = 80, .half_width_m = 8.0}, dice);
        scene.restitution = restitution;
        expect_collapse_without_overrun(scene, 600);
    }
}

TEST(EventSolver, balls_that_start_in_each_other_part_without_overrun) {
    constexpr std::uint64_t kSeed = 67;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene;
    for (int i = 0; i < 100; ++i) {
        scene.bodies.push_back({dice.in_box(2.0), dice.in_box(3.0), 0.5, dice.between(0.5, 2.0)});
    }
    scene.bodies[1].position_m = scene.bodies[0].position_m;
    expect_parting_without_overrun(scene);
}

}  // namespace
}  // namespace fts::physics
