#include "client/sdl/camera.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fts::sdl {
namespace {

using physics::Vec2d;

const Box kStage{{200, 10}, {1000, 610}};
const std::vector<physics::Platform> kPlatforms = {
    physics::Disc{11.0}, physics::Rectangle{{15.0, 4.0}}, physics::Rectangle{{3.0, 9.0}},
    physics::Ring{4.0, 14.0}};

Camera settled(const physics::Platform& platform, const std::optional<Vec2d>& own_m,
               CameraMode mode, float unit = 1.0F) {
    Camera camera;
    camera.update(platform, own_m, kStage, unit, mode, 0.0);
    return camera;
}

TEST(Camera, fits_every_platform_into_the_stage_and_uses_its_room) {
    for (const physics::Platform& platform : kPlatforms) {
        SCOPED_TRACE(platform.index());
        const Camera camera = settled(platform, std::nullopt, CameraMode::kWhole);
        const Vec2d half = half_extents_m(platform);
        const ImVec2 corner = camera.to_screen({half.x(), -half.y()});
        const ImVec2 opposite = camera.to_screen({-half.x(), half.y()});
        EXPECT_TRUE(kStage.holds(corner));
        EXPECT_TRUE(kStage.holds(opposite));
        const float used = std::max((corner.x - opposite.x) / kStage.width(),
                                    (corner.y - opposite.y) / kStage.height());
        EXPECT_GT(used, 0.75F);
    }
}

TEST(Camera, puts_up_above_and_right_to_the_right) {
    const Camera camera = settled(physics::Disc{10.0}, std::nullopt, CameraMode::kWhole);
    const ImVec2 origin = camera.to_screen(Vec2d::Zero());
    EXPECT_LT(camera.to_screen({0, 1}).y, origin.y);
    EXPECT_GT(camera.to_screen({1, 0}).x, origin.x);
}

TEST(Camera, finds_its_way_back_from_the_screen) {
    const Camera camera = settled(physics::Disc{10.0}, Vec2d(3, 4), CameraMode::kFollow);
    for (const Vec2d& point : {Vec2d(0, 0), Vec2d(7.25, -3.5), Vec2d(-9, 9)}) {
        EXPECT_NEAR((camera.to_world(camera.to_screen(point)) - point).norm(), 0.0, 1e-4);
    }
}

TEST(Camera, close_up_approaches_the_own_ball_without_a_jump) {
    Camera camera = settled(physics::Disc{12.0}, Vec2d(0, 0), CameraMode::kFollow);
    const Vec2d own(6.0, 2.0);
    double last_px = 1e9;
    const ImVec2 middle = kStage.centre();
    for (int frame = 0; frame < 240; ++frame) {
        camera.update(physics::Disc{12.0}, own, kStage, 1.0F, CameraMode::kFollow, 1.0 / 60.0);
        const ImVec2 at = camera.to_screen(own);
        const double off_px =
            std::hypot(static_cast<double>(at.x - middle.x), static_cast<double>(at.y - middle.y));
        ASSERT_LE(off_px, last_px + 1e-3);
        if (frame > 0) {
            ASSERT_LT(last_px - off_px, 40.0);
        }
        last_px = off_px;
    }
    EXPECT_LT(last_px, 2.0);
}

TEST(Camera, stays_where_the_own_ball_was_lost) {
    Camera camera = settled(physics::Disc{12.0}, Vec2d(5, 0), CameraMode::kFollow);
    const ImVec2 before = camera.to_screen(Vec2d::Zero());
    camera.update(physics::Disc{12.0}, std::nullopt, kStage, 1.0F, CameraMode::kFollow, 1.0);
    EXPECT_NEAR(camera.to_screen(Vec2d::Zero()).x, before.x, 0.01F);
}

TEST(Camera, follows_where_the_whole_platform_would_be_too_small_to_read) {
    const Camera camera = settled(physics::Disc{200.0}, Vec2d(150, 0), CameraMode::kWhole);
    const ImVec2 at = camera.to_screen({150, 0});
    EXPECT_NEAR(at.x, kStage.centre().x, 0.5F);
    EXPECT_GT(camera.px(0.5), 5.0F);
}

TEST(Camera, survives_a_platform_without_size) {
    const Camera camera = settled(physics::Disc{0.0}, std::nullopt, CameraMode::kWhole);
    EXPECT_TRUE(std::isfinite(camera.to_screen({1, 1}).x));
}

}  // namespace
}  // namespace fts::sdl
