#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "common/physics/impact.h"
#include "common/physics/solver_discrete.h"
#include "common/physics/world.h"
#include "tests/physics/allocation_count.h"
#include "tests/physics/overlap_reference.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

SolverChoice discrete(std::uint32_t substeps = 1) {
    return {SolverKind::kDiscrete, substeps};
}

BodyDef ball(const Vec2d& position_m, const Vec2d& velocity_mps, double radius_m = 1.0,
             double mass_kg = 1.0) {
    return {position_m, velocity_mps, radius_m, mass_kg};
}

Scene walled_gas(std::uint64_t seed, double half_width_m, std::size_t balls) {
    Dice dice(seed);
    return random_gas({.balls = balls, .half_width_m = half_width_m, .max_speed_mps = 10.0}, dice);
}

Scene periodic_gas(std::uint64_t seed, double half_width_m, std::size_t balls) {
    Scene scene = walled_gas(seed, half_width_m, balls);
    scene.periodic = Periodic{scene.walls->min_m, scene.walls->max_m};
    scene.walls.reset();
    return scene;
}

Model<double> model_of(const Scene& scene) {
    Model<double> model;
    if (scene.walls) model.walls = {scene.walls->min_m, scene.walls->max_m};
    if (scene.periodic) model.periodic = {scene.periodic->min_m, scene.periodic->max_m};
    model.restitution = scene.restitution;
    return model;
}

// Places as they are, also where they overlap.
Scene jumble(Scene scene, Dice& dice, double half_width_m) {
    for (BodyDef& body : scene.bodies) body.position_m = dice.in_box(half_width_m);
    return scene;
}

void expect_same_to_the_bit(const World<double>& world, const OverlapReference& reference) {
    std::size_t i = 0;
    std::size_t next = 0;
    for (const auto& contact : world.contacts()) {
        if (!contact.b) continue;
        ASSERT_LT(next, reference.contacts().size());
        EXPECT_EQ(contact.a.index, reference.contacts()[next].first);
        EXPECT_EQ(contact.b->index, reference.contacts()[next].second);
        ++next;
    }
    ASSERT_EQ(next, reference.contacts().size());
    for (const BodyId id : world.ids()) {
        ASSERT_EQ(world.body(id).position_m, reference.balls()[i].position_m);
        ASSERT_EQ(world.body(id).velocity_mps, reference.balls()[i].velocity_mps);
        ++i;
    }
}

TEST(DiscreteSolver, finds_what_looking_at_every_pair_finds_to_the_bit) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        const double half_width_m = dice.between(2.0, 12.0);
        Scene scene = seed % 2 == 0 ? walled_gas(seed, 20.0, 5 + 10 * seed)
                                    : periodic_gas(seed, 20.0, 5 + 10 * seed);
        const Vec2d corner = Vec2d::Constant(half_width_m);
        if (scene.walls) scene.walls = Walls{-corner, corner};
        if (scene.periodic) scene.periodic = Periodic{-corner, corner};
        scene = jumble(scene, dice, half_width_m - 0.6);
        scene.restitution = dice.between(0.5, 1.0);
        World<double> world(scene, discrete());
        OverlapReference reference(scene, model_of(scene));
        for (int tick = 0; tick < 80; ++tick) {
            world.step(kTick);
            reference.step(kTick);
            expect_same_to_the_bit(world, reference);
            if (testing::Test::HasFailure()) return;
        }
        EXPECT_GT(world.audit().ball_collisions, 10U);
    }
}

TEST(DiscreteSolver, is_right_in_a_periodic_box_of_one_or_two_cells) {
    std::size_t collisions = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        Scene scene;
        const Vec2d half = Vec2d(dice.between(2.01, 3.5), dice.between(2.01, 9.0));
        scene.periodic = Periodic{-half, half};
        const int balls = 1 + static_cast<int>(dice.below(5));
        for (int i = 0; i < balls; ++i) {
            const Vec2d place = dice.in_box(1.0).cwiseProduct(half);
            scene.bodies.push_back(ball(place, dice.in_box(20.0)));
        }
        World<double> world(scene, discrete());
        OverlapReference reference(scene, model_of(scene));
        for (int tick = 0; tick < 60; ++tick) {
            world.step(kTick);
            reference.step(kTick);
            expect_same_to_the_bit(world, reference);
            if (testing::Test::HasFailure()) return;
        }
        collisions += world.audit().ball_collisions;
    }
    EXPECT_GT(collisions, 200U);
}

TEST(DiscreteSolver, keeps_momentum_and_energy_to_round_off_over_ten_thousand_collisions) {
    World<double> world(periodic_gas(5, 8.0, 60), discrete(2));
    const double energy = world.kinetic_energy_j();
    const Vec2d momentum = world.momentum_ns();
    double scale_ns = 0.0;
    for (const BodyId id : world.ids()) {
        scale_ns += world.body(id).mass_kg * world.body(id).velocity_mps.norm();
    }
    while (world.audit().ball_collisions < 10000) world.step(kTick);
    EXPECT_LE(std::abs(world.kinetic_energy_j() - energy), 1e-12 * energy);
    EXPECT_LE((world.momentum_ns() - momentum).norm(), 1e-12 * scale_ns);
    EXPECT_LE(world.audit().worst_energy_error, 1e-14);
    EXPECT_LE(world.audit().worst_momentum_error, 1e-14);
    EXPECT_GT(world.audit().worst_penetration, 1e-3) << "what is given up is where";
}

TEST(DiscreteSolver, gives_the_impulse_of_the_vector_form) {
    constexpr std::uint64_t kSeed = 18;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        Scene scene;
        scene.restitution = dice.between(0.0, 1.0);
        for (int k = 0; k < 2; ++k) {
            scene.bodies.push_back(
                ball(dice.in_box(1.0), dice.in_box(5.0), 1.5, dice.of_any_size(1e-6, 1e6)));
        }
        const auto& a = scene.bodies[0];
        const auto& b = scene.bodies[1];
        const auto hit =
            impact<double>({a.position_m, a.velocity_mps, a.mass_kg},
                           {b.position_m, b.velocity_mps, b.mass_kg}, scene.restitution);
        World<double> world(scene, discrete());
        world.step(0.0);
        ASSERT_EQ(world.contacts().size(), hit ? 1U : 0U);
        if (!hit) continue;
        ++hits;
        const auto& contact = world.contacts()[0];
        EXPECT_LE((contact.velocity_a_after_mps - hit->velocity_1_mps).norm(), 1e-14 * 30);
        EXPECT_LE((contact.velocity_b_after_mps - hit->velocity_2_mps).norm(), 1e-14 * 30);
        EXPECT_LE((contact.normal - hit->normal).norm(), 1e-15 * 4);
        EXPECT_NEAR(contact.impulse_ns / hit->impulse_ns, 1.0, 1e-13);
        EXPECT_LE(world.deepest_overlap(), 1e-14) << "parted until they touch";
    }
    EXPECT_GT(hits, 500);
}

TEST(DiscreteSolver, keeps_the_mirror_image_of_a_scene_its_mirror_image) {
    const Scene scene = walled_gas(8, 8.0, 60);
    Scene mirrored = scene;
    for (BodyDef& body : mirrored.bodies) {
        body.position_m.x() *= -1.0;
        body.velocity_mps.x() *= -1.0;
    }
    World<double> world(scene, discrete(2)), mirror(mirrored, discrete(2));
    for (int tick = 0; tick < 300; ++tick) {
        world.step(kTick);
        mirror.step(kTick);
    }
    EXPECT_GT(world.audit().ball_collisions, 200U);
    for (const BodyId id : world.ids()) {
        const auto one = world.body(id), other = mirror.body(id);
        EXPECT_EQ(one.position_m, Vec2d(-other.position_m.x(), other.position_m.y()));
        EXPECT_EQ(one.velocity_mps, Vec2d(-other.velocity_mps.x(), other.velocity_mps.y()));
    }
}

double direction_after_glancing_hit_rad(const SolverChoice& choice, double start_m,
                                        double offset_m) {
    Scene scene;
    scene.bodies = {ball({-start_m, offset_m}, {60.0, 0.0}), ball({0.0, 0.0}, {0.0, 0.0})};
    World<double> world(scene, choice);
    for (int tick = 0; tick < 8; ++tick) world.step(kTick);
    const Vec2d velocity = world.body(world.ids()[0]).velocity_mps;
    return std::atan2(velocity.y(), velocity.x());
}

TEST(DiscreteSolver, nears_the_exact_deflection_with_the_first_order_of_the_substep) {
    constexpr std::uint64_t kSeed = 71;
    SCOPED_TRACE(kSeed);
    const auto error_rad = [&](std::uint32_t substeps) {
        Dice dice(kSeed);
        double sum = 0.0;
        for (int i = 0; i < 200; ++i) {
            const double start_m = dice.between(3.0, 4.0), offset_m = dice.between(-1.5, 1.5);
            const double exact = direction_after_glancing_hit_rad({}, start_m, offset_m);
            const double found =
                direction_after_glancing_hit_rad(discrete(substeps), start_m, offset_m);
            sum += std::abs(std::remainder(found - exact, 2.0 * std::numbers::pi));
        }
        return sum / 200;
    };
    // At one substep the balls move by a radius.
    const double coarse = error_rad(4), fine = error_rad(256);
    const double order = std::log(coarse / fine) / std::log(256.0 / 4.0);
    EXPECT_GT(order, 0.7) << coarse << " " << fine;
    EXPECT_LT(order, 1.3) << coarse << " " << fine;
    EXPECT_LT(fine, 0.01);
}

TEST(DiscreteSolver, lets_fast_balls_pass_through_each_other_where_swept_does_not) {
    Scene scene;
    scene.bodies = {ball({-10.0, 0.0}, {1200.0, 0.0}), ball({10.0, 0.0}, {-1200.0, 0.0})};
    World<double> fast(scene, discrete()), exact(scene), fine(scene, discrete(64));
    for (World<double>* world : {&fast, &exact, &fine}) world->step(kTick);
    EXPECT_EQ(fast.audit().ball_collisions, 0U);
    EXPECT_EQ(exact.audit().ball_collisions, 1U);
    EXPECT_EQ(fine.audit().ball_collisions, 1U);
}

// A ball far away of another radius and mass: the same bits by the general way.
TEST(DiscreteSolver, gives_equal_balls_the_same_bits_by_the_general_way) {
    for (const bool periodic : {false, true}) {
        Scene scene = periodic ? periodic_gas(9, 10.0, 80) : walled_gas(9, 10.0, 80);
        Vec2d& corner = periodic ? scene.periodic->max_m : scene.walls->max_m;
        corner.x() = 3e6;
        for (BodyDef& body : scene.bodies) {
            body.radius_m = 0.3;
            body.mass_kg = 1.7;
        }
        Scene other = scene;
        other.bodies.push_back(ball({2e6, 0.0}, {0.0, 0.0}, 0.5, kInfinite));
        World<double> alone(scene, discrete()), accompanied(other, discrete());
        for (int tick = 0; tick < 120; ++tick) {
            alone.step(kTick);
            accompanied.step(kTick);
        }
        EXPECT_GT(alone.audit().ball_collisions, 20U);
        for (const BodyId id : alone.ids()) {
            ASSERT_EQ(alone.body(id).position_m, accompanied.body(id).position_m);
            ASSERT_EQ(alone.body(id).velocity_mps, accompanied.body(id).velocity_mps);
        }
    }
}

TEST(DiscreteSolver, does_not_change_when_it_is_looked_at) {
    const Scene scene = walled_gas(4, 8.0, 60);
    World<double> watched(scene, discrete()), alone(scene, discrete());
    for (int tick = 0; tick < 200; ++tick) {
        watched.step(kTick);
        alone.step(kTick);
        watched.state_hash();
        if (tick % 7 == 0) {  // somebody else's hand: the copy is made anew
            const BodyId id = watched.ids()[3];
            watched.set_velocity(id, watched.body(id).velocity_mps);
        }
    }
    EXPECT_EQ(watched.state_hash(), alone.state_hash());
}

template <typename Scalar>
std::uint64_t hash_after_a_life() {
    World<Scalar> world(walled_gas(2013, 9.0, 90), discrete(2));
    for (int tick = 0; tick < 600; ++tick) world.step(Scalar(1) / Scalar(60));
    EXPECT_GT(world.audit().ball_collisions, 2000U);
    EXPECT_GT(world.audit().wall_collisions, 500U);
    return world.state_hash();
}

TEST(DiscreteSolver, golden_hash_in_double_precision) {
    EXPECT_EQ(hash_after_a_life<double>(), 0x2813b9e111d42715ULL);
}

TEST(DiscreteSolver, golden_hash_in_single_precision) {
    EXPECT_EQ(hash_after_a_life<float>(), 0xaa7cfaf4ac1b07d4ULL);
}

TEST(DiscreteSolver, asks_for_no_memory_once_warm) {
    for (const Scene& scene : {walled_gas(31, 8.0, 60), periodic_gas(31, 8.0, 60)}) {
        World<double> world(scene, discrete());
        for (int tick = 0; tick < 600; ++tick) world.step(kTick);
        const std::size_t before = allocations();
        for (int tick = 0; tick < 300; ++tick) world.step(kTick);
        EXPECT_EQ(allocations(), before);
    }
}

// What all bodies share is read once: what stands in the other bodies' place is never looked at.
TEST(DiscreteSolver, never_reads_radii_and_masses_that_are_all_alike) {
    Scene scene = walled_gas(6, 8.0, 60);
    Bodies<double> plain, poisoned;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const BodyDef& body : scene.bodies) {
        plain.add(body.position_m, body.velocity_mps, 0.3, 2.0);
        poisoned.add(body.position_m, body.velocity_mps, plain.slots() == 1 ? 0.3 : nan, 2.0);
    }
    Model<double> model = model_of(scene);
    model.equal_radii = model.equal_masses = true;
    const auto one = make_discrete_solver<double>(1), other = make_discrete_solver<double>(1);
    Record<double> record, record_of_other;
    for (int tick = 0; tick < 100; ++tick) {
        one->drift(plain, model, kTick, record);
        other->drift(poisoned, model, kTick, record_of_other);
    }
    one->synchronise(plain);
    other->synchronise(poisoned);
    EXPECT_GT(record.audit.ball_collisions, 30U);
    for (const BodyId id : plain.ids) {
        EXPECT_EQ(plain.position_m[id.index], poisoned.position_m[id.index]);
        EXPECT_EQ(plain.velocity_mps[id.index], poisoned.velocity_mps[id.index]);
    }
}

TEST(DiscreteSolver, loses_by_restitution_what_it_should_and_no_momentum) {
    Scene scene;
    scene.restitution = 0.5;
    scene.bodies = {ball({0.0, 0.0}, {1.0, 0.0}, 1.0, 1.0),
                    ball({1.9, 0.0}, {-1.0, 0.0}, 1.0, 3.0)};
    World<double> world(scene, discrete());
    world.step(0.0);
    const auto& contact = world.contacts()[0];
    const Vec2d apart = contact.velocity_a_after_mps - contact.velocity_b_after_mps;
    EXPECT_NEAR(apart.x(), -1.0, 1e-15);
    EXPECT_NEAR(world.momentum_ns().x(), -2.0, 1e-15);
}

TEST(DiscreteSolver, reports_where_in_the_tick_and_how_deep) {
    Scene scene;
    scene.bodies = {ball({0.0, 0.0}, {6.0, 0.0}), ball({2.35, 0.0}, {-6.0, 0.0}, 1.0)};
    World<double> world(scene, discrete(4));
    world.step(0.1);  // closing 0.3 a substep: after the second one 0.25 deep
    ASSERT_EQ(world.contacts().size(), 1U);
    EXPECT_NEAR(world.contacts()[0].time_s, 0.05, 1e-15);
    EXPECT_NEAR(world.contacts()[0].penetration, 0.25, 1e-14);
    EXPECT_NEAR(world.audit().worst_penetration, 0.25, 1e-14);
}

}  // namespace
}  // namespace fts::physics
