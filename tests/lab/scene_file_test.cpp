// A scene file says what it means, and what is wrong with it is told in its own words.
#include "server/lab/scene_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/temp_folder.h"

namespace fts::lab {
namespace {

using physics::Vec2d;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

LoadedScene parsed(const std::string& text) {
    LoadedScene loaded = parse_scene(text, "some.scene");
    EXPECT_EQ(loaded.error, "");
    return loaded;
}

std::string error_of(const std::string& text) {
    const LoadedScene loaded = parse_scene(text, "some.scene");
    EXPECT_NE(loaded.error, "") << text;
    return loaded.error;
}

std::string body(const std::string& fields) {
    return "body { position { x: 1 y: 2 } " + fields + " }\n";
}

TEST(SceneFile, holds_everything_a_scene_has) {
    const LoadedScene loaded = parsed(R"(
        name: "All of it"
        body { position { x: 1 y: 2 } velocity { x: -3 y: 4e-1 } radius: 0.25 mass: inf }
        body { position { x: 3 y: 3 } }
        walls { min { x: 0 y: -1 } max { x: 8 y: 9 } }
        platform { disc { radius_m: 20 } }
        drag: 0.5
        restitution: 0.75)");
    const physics::Scene& scene = loaded.scene;
    EXPECT_EQ(loaded.name, "All of it");
    EXPECT_EQ(loaded.warning, "");
    ASSERT_EQ(scene.bodies.size(), 2U);
    EXPECT_EQ(scene.bodies[0].position_m, Vec2d(1.0, 2.0));
    EXPECT_EQ(scene.bodies[0].velocity_mps, Vec2d(-3.0, 0.4));
    EXPECT_EQ(scene.bodies[0].radius_m, 0.25);
    EXPECT_TRUE(std::isinf(scene.bodies[0].mass_kg));
    EXPECT_EQ(scene.walls->min_m, Vec2d(0.0, -1.0));
    EXPECT_EQ(scene.walls->max_m, Vec2d(8.0, 9.0));
    EXPECT_EQ(std::get<physics::Disc>(*scene.platform).radius_m, 20.0);
    EXPECT_EQ(scene.drag_per_s, 0.5);
    EXPECT_EQ(scene.restitution, 0.75);
}

TEST(SceneFile, has_defaults_for_what_is_left_out) {
    const LoadedScene loaded = parsed("body {}");
    EXPECT_EQ(loaded.name, "some");
    EXPECT_EQ(loaded.scene.bodies[0].radius_m, 0.5);
    EXPECT_EQ(loaded.scene.bodies[0].mass_kg, 1.0);
    EXPECT_EQ(loaded.scene.restitution, 1.0);
    EXPECT_FALSE(loaded.scene.walls || loaded.scene.periodic || loaded.scene.platform);
    EXPECT_EQ(parsed("body {} restitution: 0").scene.restitution, 0.0);
}

TEST(SceneFile, generates_into_walls_periodic_boxes_and_platforms_or_makes_a_square) {
    const std::string numbers =
        " generator { seed: 1 count: 50 packing_fraction: 0.3 radius_min: 0.5 radius_max: 0.5 "
        "mass: EQUAL speed_rms: 1 }";
    const LoadedScene square = parsed(numbers);
    EXPECT_EQ(square.scene.bodies.size(), 50U);
    EXPECT_NEAR((square.scene.walls->max_m - square.scene.walls->min_m).x(),
                std::sqrt(50 * 3.14159265358979 * 0.25 / 0.3), 1e-9);
    EXPECT_TRUE(parsed("periodic {}" + numbers).scene.periodic);
    EXPECT_TRUE(parsed("walls {}" + numbers).scene.walls);
    EXPECT_EQ(
        parsed("periodic { min { x: 0 y: 0 } max { x: 10 y: 9 } }" + numbers).scene.periodic->max_m,
        Vec2d(10.0, 9.0));
    EXPECT_FALSE(parsed("platform { disc { radius_m: 9 } }" + numbers).scene.walls);
    EXPECT_EQ(parsed("body { position { x: 0 y: 0 } }" + numbers).scene.bodies.size(), 51U);
    const LoadedScene by_area = parsed(
        "generator { count: 9 packing_fraction: 0.1 radius_min: 0.1 radius_max: 0.9 mass: BY_AREA "
        "}");
    EXPECT_NE(by_area.scene.bodies[0].mass_kg, by_area.scene.bodies[1].mass_kg);
}

TEST(SceneFile, refuses_radii_and_masses_that_are_no_radii_and_masses) {
    for (const std::string value : {"nan", "-1", "0", "-inf", "inf", "1e99"}) {
        EXPECT_THAT(error_of("\n" + body("radius: " + value)),
                    AllOf(StartsWith("some.scene:2:"), HasSubstr("body[0].radius is "),
                          HasSubstr("; give a radius from ")))
            << value;
    }
    for (const std::string value : {"nan", "-1", "0", "-inf", "1e99"}) {
        EXPECT_THAT(error_of(body("") + body("mass: " + value)),
                    AllOf(StartsWith("some.scene:2:31: body[1].mass is "),
                          HasSubstr("; give a mass from ")))
            << value;
    }
}

TEST(SceneFile, refuses_numbers_that_are_none_wherever_they_stand) {
    EXPECT_THAT(error_of("body { position { x: nan } }"),
                HasSubstr("body[0].position is (nan, 0)"));
    EXPECT_THAT(error_of("body { velocity { y: inf } }"),
                HasSubstr("body[0].velocity is (0, inf)"));
    EXPECT_THAT(error_of("body {} drag: -1"), HasSubstr("some.scene:1:9: drag is -1; give"));
    EXPECT_THAT(error_of("body {} drag: nan"), HasSubstr("drag is nan; give"));
    EXPECT_THAT(error_of("body {} restitution: 2"), HasSubstr("restitution is 2; give"));
    EXPECT_THAT(error_of("body {} walls { min { x: 1 } max { x: inf y: 1 } }"),
                HasSubstr("walls.max is (inf, 1)"));
    EXPECT_THAT(error_of("body {} walls { min { x: 1 } max { x: 0 y: 1 } }"),
                AllOf(HasSubstr("walls.max is (0, 1); give more than walls.min, which is (1, 0)")));
    EXPECT_THAT(error_of("body {} periodic {}"), HasSubstr("periodic.max is (0, 0); give more"));
    EXPECT_THAT(error_of("body {} platform { disc { radius_m: -2 } }"),
                HasSubstr("platform.disc.radius_m is -2; give"));
    EXPECT_THAT(error_of("body {} platform { rectangle { width_m: 2 height_m: nan } }"),
                HasSubstr("platform.rectangle.height_m, halved, is nan; give"));
    EXPECT_THAT(error_of("body {} platform { ring { inner_radius_m: 5 outer_radius_m: 3 } }"),
                HasSubstr("platform.ring.inner_radius_m is 5; give"));
    EXPECT_THAT(error_of("body {} platform {}"), HasSubstr("platform is empty; give a disc"));
    EXPECT_THAT(error_of("body {} walls {} periodic {}"), HasSubstr("periodic is given beside"));
}

TEST(SceneFile, refuses_generators_that_ask_for_too_much) {
    EXPECT_THAT(error_of("generator { count: 1000\n packing_fraction: 0.95 }"),
                AllOf(StartsWith("some.scene:2:2: generator.packing_fraction is 0.95; give "),
                      HasSubstr("0.9068")));
    EXPECT_THAT(error_of("generator { count: 1000 packing_fraction: 0.9 }"),
                HasSubstr("; 1000 equal balls fill a square to 0.8"));
    EXPECT_THAT(error_of("generator { count: -5 packing_fraction: 0.3 }"),
                HasSubstr("generator.count is -5; give a number from 1"));
    EXPECT_THAT(error_of("generator { count: 5 packing_fraction: 0.3 radius_min: nan }"),
                HasSubstr("generator.radius_min is nan; give"));
    EXPECT_THAT(error_of("generator { count: 5 packing_fraction: 0.3 speed_rms: inf }"),
                HasSubstr("generator.speed_rms is inf; give"));
    EXPECT_THAT(error_of("generator {}"), HasSubstr("generator.count is missing; say"));
}

TEST(SceneFile, refuses_fields_that_it_does_not_know_and_lists_those_it_does) {
    EXPECT_THAT(error_of("body {\n radus: 0.5 }"),
                AllOf(StartsWith("some.scene:2:"),
                      HasSubstr("'radus' is unknown in Body; give "
                                "position, velocity, radius or mass"),
                      HasSubstr("radus: 0.5")));
    EXPECT_THAT(error_of("gravity: 9.81"), HasSubstr("'gravity' is unknown in Scene; give name, "));
}

TEST(SceneFile, shows_the_line_that_it_does_not_understand) {
    EXPECT_THAT(error_of("body {\n  radius: wide }"),
                AllOf(StartsWith("some.scene:2:11: "), HasSubstr("radius: wide")));
    EXPECT_THAT(error_of("body { radius: 1 radius: 2 }"), HasSubstr("radius"));
    EXPECT_THAT(error_of("body {"), StartsWith("some.scene:1:7: "));
}

TEST(SceneFile, refuses_a_scene_of_nothing_and_a_name_that_would_upset_a_terminal) {
    EXPECT_THAT(error_of("name: \"empty\""), HasSubstr("body is missing; give"));
    EXPECT_THAT(error_of("body {} name: \"\\033[2J\""),
                HasSubstr("name holds a control character"));
}

TEST(SceneFile, warns_of_bodies_that_overlap_and_takes_them) {
    const LoadedScene loaded = parsed("body {}\nbody { position { x: 0.5 } }");
    EXPECT_EQ(loaded.scene.bodies.size(), 2U);
    EXPECT_THAT(loaded.warning,
                AllOf(StartsWith("some.scene:2:8: body[1].position is (0.5, 0); 0.5 m inside "),
                      HasSubstr("body[0]")));
}

TEST(SceneFile, is_found_by_path_or_by_name_and_names_the_scenes_there_are) {
    harness::TempFolder folder;
    std::ofstream(folder.file("two.scene")) << "body {}";
    std::ofstream(folder.file("one.scene")) << "body {}";
    const std::string path = folder.path().string();
    EXPECT_EQ(load_scene("two", path).error, "");
    EXPECT_EQ(load_scene("two.scene", path).error, "");
    EXPECT_EQ(load_scene(folder.file("one.scene"), "/no/such/folder").error, "");
    EXPECT_THAT(load_scene("three", path).error, HasSubstr("one of: one, two"));
    EXPECT_THAT(load_scene(path, path).error, HasSubstr("is a folder; name one"));
    EXPECT_THAT(load_scene("/no/such/file.scene", path).error, HasSubstr("there is no scene"));
}

}  // namespace
}  // namespace fts::lab
