// Generated scenes hold what their numbers say, and what cannot be made is refused in words.
#include "common/physics/generator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/physics/bodies.h"
#include "common/physics/diagnostics.h"
#include "common/physics/disc_grid.h"
#include "common/physics/region.h"
#include "tests/physics/values.h"

namespace fts::physics {
namespace {

using testing::HasSubstr;

Scene filled(const Scene& scene, const Generator& generator) {
    auto result = fill(scene, generator);
    if (const auto* error = std::get_if<SceneError>(&result)) {
        ADD_FAILURE() << error->message;
        return {};
    }
    return std::get<Scene>(std::move(result));
}

SceneError refused(const Scene& scene, const Generator& generator) {
    auto result = fill(scene, generator);
    if (const auto* error = std::get_if<SceneError>(&result)) return *error;
    ADD_FAILURE() << "made " << std::get<Scene>(result).bodies.size() << " balls";
    return {};
}

double cover_of(const Scene& scene) {
    double covered_m2 = 0.0;
    for (const BodyDef& body : scene.bodies) {
        covered_m2 += std::numbers::pi * body.radius_m * body.radius_m;
    }
    return covered_m2 / region_of(scene)->area_m2();
}

double rms_speed_mps(const Scene& scene) {
    double squares = 0.0;
    for (const BodyDef& body : scene.bodies) squares += body.velocity_mps.squaredNorm();
    return std::sqrt(squares / static_cast<double>(scene.bodies.size()));
}

void expect_valid(const Scene& scene) {
    const auto error = validate(scene);
    EXPECT_FALSE(error) << error->message;
}

Scene periodic_of_any_size() {
    Scene scene;
    scene.periodic = Periodic{};
    return scene;
}

TEST(Generator, reaches_the_packing_without_overlaps_from_dilute_to_nearly_closest) {
    for (const double packing : {1e-6, 0.01, 0.3, 0.5, 0.7, 0.8, 0.85, 0.88}) {
        for (const bool periodic : {false, true}) {
            SCOPED_TRACE(testing::Message() << packing << (periodic ? " periodic" : " walls"));
            const Scene scene = filled(periodic ? periodic_of_any_size() : Scene{},
                                       {.seed = 5, .count = 10'000, .packing_fraction = packing});
            EXPECT_EQ(scene.bodies.size(), 10'000U);
            EXPECT_NEAR(cover_of(scene), packing, 0.01 * packing);
            expect_valid(scene);
        }
    }
}

TEST(Generator, packs_balls_of_different_radii_densely) {
    for (const double packing : {0.3, 0.6, 0.75, 0.8}) {
        for (const bool periodic : {false, true}) {
            SCOPED_TRACE(testing::Message() << packing << (periodic ? " periodic" : " walls"));
            const Scene scene =
                filled(periodic ? periodic_of_any_size() : Scene{}, {.seed = 9,
                                                                     .count = 2'000,
                                                                     .packing_fraction = packing,
                                                                     .radius_min_m = 0.2,
                                                                     .radius_max_m = 0.6});
            EXPECT_EQ(scene.bodies.size(), 2'000U);
            EXPECT_NEAR(cover_of(scene), packing, 0.01 * packing);
            expect_valid(scene);
        }
    }
}

TEST(Generator, fills_every_boundary_to_the_packing) {
    Scene walled, disc, rectangle, ring;
    walled.walls = Walls{{-30.0, 10.0}, {50.0, 40.0}};
    disc.platform = Disc{25.0};
    rectangle.platform = Rectangle{{20.0, 30.0}};
    ring.platform = Ring{10.0, 30.0};
    for (const Scene& boundary : {walled, disc, rectangle, ring}) {
        for (const double packing : {0.1, 0.4, 0.6}) {
            SCOPED_TRACE(packing);
            const Scene scene = filled(boundary, {.seed = 3, .packing_fraction = packing});
            EXPECT_NEAR(cover_of(scene), packing, 0.01 * packing);
            expect_valid(scene);
        }
    }
}

TEST(Generator, makes_the_fewer_balls_of_count_and_packing_within_a_boundary) {
    Scene scene;
    scene.walls = Walls{{0.0, 0.0}, {100.0, 100.0}};
    EXPECT_EQ(filled(scene, {.count = 10, .packing_fraction = 0.5}).bodies.size(), 10U);
    const std::size_t full = filled(scene, {.packing_fraction = 0.1}).bodies.size();
    EXPECT_EQ(filled(scene, {.count = 100'000, .packing_fraction = 0.1}).bodies.size(), full);
    EXPECT_EQ(filled(scene, {.count = 7}).bodies.size(), 7U);
}

TEST(Generator, keeps_clear_of_the_bodies_that_the_scene_has_and_counts_their_area) {
    for (const double packing : {0.3, 0.6}) {
        Scene scene;
        scene.walls = Walls{{-20.0, -20.0}, {20.0, 20.0}};
        scene.bodies = {{{5.0, 5.0}, {0.0, 0.0}, 6.0, kInfinite},
                        {{-10.0, 0.0}, {1.0, 0.0}, 0.1, 1.0}};
        const Scene full = filled(scene, {.seed = 4, .packing_fraction = packing});
        EXPECT_EQ(full.bodies[0].radius_m, 6.0);
        EXPECT_NEAR(cover_of(full), packing, 0.01 * packing);
        expect_valid(full);
    }
}

TEST(Generator, gives_no_momentum_and_exactly_the_speed_that_was_asked_for) {
    for (const MassRule rule : {MassRule::kEqual, MassRule::kByArea}) {
        const Scene scene = filled({}, {.seed = 11,
                                        .count = 500,
                                        .packing_fraction = 0.3,
                                        .radius_min_m = 0.1,
                                        .radius_max_m = 0.9,
                                        .mass = rule,
                                        .speed_rms_mps = 3.0});
        Vec2d momentum = Vec2d::Zero();
        double mass_kg = 0.0, per_area = 0.0;
        for (const BodyDef& body : scene.bodies) {
            momentum += body.mass_kg * body.velocity_mps;
            mass_kg += body.mass_kg;
            per_area = body.mass_kg / (body.radius_m * body.radius_m);
            if (rule == MassRule::kByArea) {
                const BodyDef& first = scene.bodies.front();
                EXPECT_NEAR(per_area, first.mass_kg / (first.radius_m * first.radius_m),
                            1e-12 * per_area);
            } else {
                EXPECT_EQ(body.mass_kg, 1.0);
            }
        }
        EXPECT_LT(momentum.norm(), 1e-12);
        EXPECT_NEAR(mass_kg / 500.0, 1.0, 1e-12);
        EXPECT_NEAR(rms_speed_mps(scene), 3.0, 1e-14);
    }
}

TEST(Generator, lets_a_single_ball_move) {
    const Scene scene = filled({}, {.count = 1, .packing_fraction = 0.1, .speed_rms_mps = 2.0});
    EXPECT_NEAR(rms_speed_mps(scene), 2.0, 1e-15);
}

TEST(Generator, makes_the_square_about_the_point_it_is_given) {
    Scene scene;
    scene.walls = Walls{{1e6, -7.0}, {1e6, -7.0}};
    const Scene made = filled(scene, {.seed = 2, .count = 3000, .packing_fraction = 0.85});
    EXPECT_NEAR(0.5 * (made.walls->min_m + made.walls->max_m).x(), 1e6, 1e-9);
    expect_valid(made);
}

std::uint64_t hash_of(const Generator& generator) {
    Bodies<double> bodies;
    for (const BodyDef& body : filled({}, generator).bodies) {
        bodies.add(body.position_m, body.velocity_mps, body.radius_m, body.mass_kg);
    }
    return state_hash(bodies);
}

TEST(Generator, golden_hashes_of_every_way_to_place) {
    const Generator dilute{.seed = 1, .count = 300, .packing_fraction = 0.3};
    Generator dense = dilute, mixed = dilute;
    dense.packing_fraction = 0.8;
    mixed.packing_fraction = 0.75;
    mixed.radius_min_m = 0.2;
    mixed.mass = MassRule::kByArea;
    EXPECT_EQ(hash_of(dilute), 0xe9e8c1735b980484ULL);
    EXPECT_EQ(hash_of(dense), 0x4e3c234e42d2e1a9ULL);
    EXPECT_EQ(hash_of(mixed), 0x770b2aee765bc29cULL);
    Generator other = dilute;
    other.seed = 2;
    EXPECT_NE(hash_of(other), hash_of(dilute));
}

TEST(Generator, refuses_numbers_by_name_value_and_remedy) {
    const Generator good{.seed = 1, .count = 10, .packing_fraction = 0.3};
    const auto expect_refused = [&](const std::string& field, auto change) {
        for (const double bad : {kNan, -1.0, kInfinite, -kInfinite}) {
            Generator generator = good;
            change(generator, bad);
            const SceneError error = refused({}, generator);
            EXPECT_EQ(error.field, "generator." + field);
            EXPECT_THAT(error.message, HasSubstr("generator." + field + " is "));
            EXPECT_THAT(error.message, HasSubstr("; give "));
        }
    };
    expect_refused("packing_fraction", [](Generator& g, double x) { g.packing_fraction = x; });
    expect_refused("radius_min", [](Generator& g, double x) { g.radius_min_m = x; });
    expect_refused("radius_max", [](Generator& g, double x) { g.radius_max_m = x; });
    expect_refused("speed_rms", [](Generator& g, double x) { g.speed_rms_mps = x; });
    EXPECT_EQ(refused({}, {.count = 0, .packing_fraction = 0.3}).field, "generator.count");
    EXPECT_EQ(refused({}, {.count = -4, .packing_fraction = 0.3}).field, "generator.count");
    EXPECT_EQ(refused({}, {.count = 1'000'001, .packing_fraction = 0.3}).field, "generator.count");
    EXPECT_EQ(refused({}, {.count = 4, .packing_fraction = 0.0}).field,
              "generator.packing_fraction");
    EXPECT_EQ(refused({}, {.count = 4, .packing_fraction = 0.1, .radius_min_m = 0.0}).field,
              "generator.radius_min");
    EXPECT_EQ(refused({}, {.count = 4, .packing_fraction = 0.1, .radius_min_m = 1.0}).field,
              "generator.radius_max");
}

TEST(Generator, asks_for_what_is_missing) {
    EXPECT_THAT(refused({}, {.packing_fraction = 0.3}).message,
                HasSubstr("generator.count is missing"));
    EXPECT_THAT(refused({}, {.count = 3}).message,
                HasSubstr("generator.packing_fraction is missing"));
    Scene walled;
    walled.walls = Walls{{0.0, 0.0}, {10.0, 10.0}};
    EXPECT_THAT(refused(walled, {}).message, HasSubstr("generator.count is missing"));
}

TEST(Generator, refuses_what_is_too_dense_and_says_what_is_not) {
    EXPECT_THAT(refused({}, {.count = 1000, .packing_fraction = 0.95}).message,
                HasSubstr("generator.packing_fraction is 0.95; give a number above 0 and at most "
                          "0.9068"));
    const SceneError square = refused({}, {.count = 1000, .packing_fraction = 0.9});
    EXPECT_THAT(square.message, HasSubstr("1000 equal balls fill a square to 0.8"));
    Scene walled;
    walled.walls = Walls{{0.0, 0.0}, {10.0, 10.0}};
    EXPECT_THAT(refused(walled, {.count = 200}).message, HasSubstr("give at most 105"));
    EXPECT_EQ(filled(walled, {.count = 105}).bodies.size(), 105U);
    EXPECT_THAT(refused(walled, {.packing_fraction = 0.9}).message,
                HasSubstr("generator.packing_fraction is 0.9; the 115 balls"));
    EXPECT_EQ(refused(walled, {.count = 1, .radius_min_m = 6.0, .radius_max_m = 6.0}).field,
              "generator.radius_max");
    EXPECT_EQ(refused(periodic_of_any_size(), {.count = 2, .packing_fraction = 0.5}).field,
              "generator.packing_fraction");
    EXPECT_EQ(
        refused({},
                {.count = 500, .packing_fraction = 0.9, .radius_min_m = 0.3, .radius_max_m = 0.6})
            .field,
        "generator.packing_fraction");
}

TEST(Generator, refuses_a_boundary_that_the_scene_may_not_have) {
    Scene scene;
    scene.walls = Walls{{0.0, 0.0}, {10.0, -10.0}};
    EXPECT_THAT(refused(scene, {.count = 3}).field, HasSubstr("walls.max"));
}

// A million within seconds, and each still where its neighbours are not.
TEST(Generator, makes_a_million_balls) {
    const Scene scene = filled({}, {.seed = 8, .count = 1'000'000, .packing_fraction = 0.3});
    ASSERT_EQ(scene.bodies.size(), 1'000'000U);
    const Region region = *region_of(scene);
    DiscGrid grid(region, 0.5, scene.bodies.size());
    std::uint32_t overlaps = 0;
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
        const Vec2d& place = scene.bodies[i].position_m;
        grid.for_each_near(place, [&](std::uint32_t other) {
            if ((scene.bodies[other].position_m - place).norm() < 1.0 - 1e-12) ++overlaps;
        });
        grid.insert(i, place);
    }
    EXPECT_EQ(overlaps, 0U);
}

}  // namespace
}  // namespace fts::physics
