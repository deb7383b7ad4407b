#include "common/physics/scene.h"

#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/physics/values.h"

namespace fts::physics {
namespace {

using testing::HasSubstr;

Scene good_scene() {
    Scene scene;
    scene.bodies.push_back({Vec2d(-1, 0), Vec2d(1, 0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(1, 0), Vec2d(-1, 0), 0.5, 1.0});
    scene.walls = Walls{Vec2d(-3, -3), Vec2d(3, 3)};
    scene.platform = Disc{5.0};
    return scene;
}

TEST(Scene, good_ones_are_accepted) {
    EXPECT_FALSE(validate(good_scene()));
    EXPECT_FALSE(validate(Scene()));
    Scene heavy = good_scene();
    heavy.bodies[0].mass_kg = kInfinite;
    EXPECT_FALSE(validate(heavy));
}

TEST(Scene, bodies_may_touch_each_other_and_the_walls) {
    Scene scene = good_scene();
    scene.bodies[0].position_m = {0, 0};
    EXPECT_FALSE(validate(scene));
    scene.bodies[0].position_m = {-2.5, 2.5};
    EXPECT_FALSE(validate(scene));
}

struct Refusal {
    const char* field;
    const char* value;
    std::function<void(Scene&)> spoil;
};

std::vector<Refusal> refusals() {
    return {
        {"restitution", "nan", [](Scene& s) { s.restitution = kNan; }},
        {"restitution", "1.5", [](Scene& s) { s.restitution = 1.5; }},
        {"restitution", "-0.1", [](Scene& s) { s.restitution = -0.1; }},
        {"body[1].radius_m", "-1", [](Scene& s) { s.bodies[1].radius_m = -1; }},
        {"body[1].radius_m", "0", [](Scene& s) { s.bodies[1].radius_m = 0; }},
        {"body[1].radius_m", "nan", [](Scene& s) { s.bodies[1].radius_m = kNan; }},
        {"body[1].radius_m", "inf", [](Scene& s) { s.bodies[1].radius_m = kInfinite; }},
        {"body[0].radius_m", "2.999", [](Scene& s) { s.bodies[0].radius_m = 2.999; }},
        {"body[0].mass_kg", "0", [](Scene& s) { s.bodies[0].mass_kg = 0; }},
        {"body[0].mass_kg", "-2", [](Scene& s) { s.bodies[0].mass_kg = -2; }},
        {"body[0].mass_kg", "-inf", [](Scene& s) { s.bodies[0].mass_kg = -kInfinite; }},
        {"body[0].mass_kg", "nan", [](Scene& s) { s.bodies[0].mass_kg = kNan; }},
        {"body[0].mass_kg", "1e+99", [](Scene& s) { s.bodies[0].mass_kg = 1e99; }},
        {"body[0].position_m", "nan", [](Scene& s) { s.bodies[0].position_m.x() = kNan; }},
        {"body[0].position_m", "inf", [](Scene& s) { s.bodies[0].position_m.y() = kInfinite; }},
        {"body[0].position_m", "(-2.75, 0)", [](Scene& s) { s.bodies[0].position_m.x() = -2.75; }},
        {"body[1].position_m", "inside body[0]",
         [](Scene& s) {
             s.bodies[1].position_m = {-0.5, 0.1};
         }},
        {"body[0].position_m", "off the platform", [](Scene& s) { s.platform = Disc{0.5}; }},
        {"body[0].position_m", "off the platform",
         [](Scene& s) {
             s.platform = Ring{2, 3};
         }},
        {"body[0].velocity_mps", "nan", [](Scene& s) { s.bodies[0].velocity_mps.y() = kNan; }},
        {"body[0].velocity_mps", "-inf",
         [](Scene& s) { s.bodies[0].velocity_mps.x() = -kInfinite; }},
        {"body[0].velocity_mps", "1e+300", [](Scene& s) { s.bodies[0].velocity_mps.x() = 1e300; }},
        {"walls.min_m", "nan", [](Scene& s) { s.walls->min_m.x() = kNan; }},
        {"walls.max_m", "inf", [](Scene& s) { s.walls->max_m.x() = kInfinite; }},
        {"walls.max_m", "-3", [](Scene& s) { s.walls->max_m.y() = -3; }},
        {"platform.radius_m", "0", [](Scene& s) { s.platform = Disc{0.0}; }},
        {"platform.radius_m", "nan", [](Scene& s) { s.platform = Disc{kNan}; }},
        {"platform.half_extents_m.y", "-1",
         [](Scene& s) {
             s.platform = Rectangle{{1, -1}};
         }},
        {"platform.inner_radius_m", "0",
         [](Scene& s) {
             s.platform = Ring{0, 3};
         }},
        {"platform.inner_radius_m", "outer_radius_m",
         [](Scene& s) {
             s.platform = Ring{3, 3};
         }},
        {"platform.outer_radius_m", "inf",
         [](Scene& s) {
             s.platform = Ring{1, kInfinite};
         }},
    };
}

TEST(Scene, bad_ones_are_refused_by_field_value_and_remedy) {
    for (const Refusal& refusal : refusals()) {
        Scene scene = good_scene();
        refusal.spoil(scene);
        const auto error = validate(scene);
        ASSERT_TRUE(error) << refusal.field << " " << refusal.value;
        EXPECT_EQ(error->field, refusal.field);
        EXPECT_THAT(error->message, HasSubstr(refusal.field));
        EXPECT_THAT(error->message, HasSubstr(refusal.value));
        EXPECT_THAT(error->message, HasSubstr("; ")) << "no remedy";
    }
}

TEST(Scene, an_overlap_is_found_among_many_bodies) {
    Scene scene;
    for (int i = 0; i < 5000; ++i) {
        scene.bodies.push_back({Vec2d(i % 200, i / 200), Vec2d::Zero(), 0.5, 1.0});
    }
    EXPECT_FALSE(validate(scene));
    scene.bodies.push_back({Vec2d(100.5, 20.5), Vec2d::Zero(), 0.25, 1.0});
    const auto error = validate(scene);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->field, "body[5000].position_m");
}

struct EdgeCase {
    Platform platform;
    Vec2d point_m;
    double distance_m;
    Vec2d nearest_m;
};

TEST(Platform, knows_the_distance_to_its_nearest_edge) {
    const EdgeCase cases[] = {
        {Disc{5}, {3, 0}, 2, {5, 0}},
        {Disc{5}, {0, -7}, -2, {0, -5}},
        {Disc{5}, {0, 0}, 5, {5, 0}},
        {Rectangle{{4, 2}}, {1, 0.5}, 1.5, {1, 2}},
        {Rectangle{{4, 2}}, {-3.5, 0}, 0.5, {-4, 0}},
        {Rectangle{{4, 2}}, {5, 0}, -1, {4, 0}},
        {Rectangle{{4, 2}}, {7, -6}, -5, {4, -2}},
        {Ring{2, 6}, {3, 0}, 1, {2, 0}},
        {Ring{2, 6}, {0, 5.5}, 0.5, {0, 6}},
        {Ring{2, 6}, {0, 1}, -1, {0, 2}},
        {Ring{2, 6}, {-8, 0}, -2, {-6, 0}},
    };
    for (const EdgeCase& c : cases) {
        EXPECT_DOUBLE_EQ(distance_to_edge_m(c.platform, c.point_m), c.distance_m);
        EXPECT_LE((nearest_edge_point_m(c.platform, c.point_m) - c.nearest_m).norm(), 1e-15);
    }
}

TEST(Platform, fits_in_its_bounding_radius) {
    EXPECT_EQ(bounding_radius_m(Disc{3}), 3.0);
    EXPECT_EQ(bounding_radius_m(Rectangle{{3, 4}}), 5.0);
    EXPECT_EQ(bounding_radius_m(Ring{1, 7}), 7.0);
}

}  // namespace
}  // namespace fts::physics
