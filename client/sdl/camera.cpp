#include "client/sdl/camera.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

namespace fts::sdl {
namespace {

constexpr double kMarginM = 0.9;          // around the platform
constexpr float kMinPixelsPerMetre = 15;  // at unit 1; below it the whole platform is unreadable
constexpr float kFollowPixelsPerMetre = 40;
constexpr double kFollowTimeS = 0.35;  // to cover 63 % of the way

}  // namespace

physics::Vec2d half_extents_m(const physics::Platform& platform) {
    return std::visit(
        [](const auto& shape) -> physics::Vec2d {
            using Shape = std::decay_t<decltype(shape)>;
            if constexpr (std::is_same_v<Shape, physics::Disc>) {
                return {shape.radius_m, shape.radius_m};
            } else if constexpr (std::is_same_v<Shape, physics::Rectangle>) {
                return shape.half_extents_m;
            } else {
                return {shape.outer_radius_m, shape.outer_radius_m};
            }
        },
        platform);
}

void Camera::update(const physics::Platform& platform, const std::optional<physics::Vec2d>& own_m,
                    const Box& stage, float unit, CameraMode mode, double dt_s) {
    const physics::Vec2d half_m =
        half_extents_m(platform).cwiseMax(0.5) + physics::Vec2d(kMarginM, kMarginM);
    const double fit = std::min(static_cast<double>(stage.width()) / (2.0 * half_m.x()),
                                static_cast<double>(stage.height()) / (2.0 * half_m.y()));
    const float floor_scale =
        unit * (mode == CameraMode::kFollow ? kFollowPixelsPerMetre : kMinPixelsPerMetre);
    const bool follows = floor_scale > static_cast<float>(fit);
    const float wanted_scale = follows ? floor_scale : static_cast<float>(fit);
    physics::Vec2d wanted_m = centre_m_;
    if (!follows) wanted_m.setZero();
    if (follows && own_m) wanted_m = *own_m;

    const bool jump = reach_m_ != half_m.norm();
    const double share = jump ? 1.0 : 1.0 - std::exp(-std::clamp(dt_s, 0.0, 1.0) / kFollowTimeS);
    if (jump && follows && !own_m) wanted_m.setZero();
    reach_m_ = half_m.norm();
    centre_px_ = stage.centre();
    centre_m_ += (wanted_m - centre_m_) * share;
    scale_ += (wanted_scale - scale_) * static_cast<float>(share);
}

ImVec2 Camera::to_screen(const physics::Vec2d& point_m) const {
    const ImVec2 offset = vector(point_m - centre_m_);
    return {centre_px_.x + offset.x, centre_px_.y + offset.y};
}

physics::Vec2d Camera::to_world(ImVec2 point_px) const {
    const physics::Vec2d offset(static_cast<double>(point_px.x - centre_px_.x),
                                static_cast<double>(centre_px_.y - point_px.y));
    return centre_m_ + offset / static_cast<double>(scale_);
}

ImVec2 Camera::vector(const physics::Vec2d& vector_m) const {
    return {px(vector_m.x()), -px(vector_m.y())};
}

}  // namespace fts::sdl
