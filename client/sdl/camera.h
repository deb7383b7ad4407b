// From metres on the platform to pixels of the window. World y points up, screen y down.
#pragma once

#include <optional>

#include <imgui.h>

#include "client/sdl/canvas.h"
#include "common/physics/scene.h"

namespace fts::sdl {

enum class CameraMode : std::uint8_t {
    kWhole,   // all of the platform; follows softly where it would be too small to read
    kFollow,  // close to the own ball
};

class Camera {
  public:
    // Moves towards where `mode` wants it; the first call, and one with another platform, jumps.
    // `stage` is the part of the window that is free of panels. `unit` as in TypeScale.
    void update(const physics::Platform& platform, const std::optional<physics::Vec2d>& own_m,
                const Box& stage, float unit, CameraMode mode, double dt_s);

    ImVec2 to_screen(const physics::Vec2d& point_m) const;
    physics::Vec2d to_world(ImVec2 point_px) const;
    float px(double length_m) const { return static_cast<float>(length_m) * scale_; }
    // A direction or displacement, without the origin.
    ImVec2 vector(const physics::Vec2d& vector_m) const;

  private:
    ImVec2 centre_px_{0, 0};
    physics::Vec2d centre_m_ = physics::Vec2d::Zero();
    float scale_ = 1.0F;    // pixels per metre
    double reach_m_ = 0.0;  // of the platform last seen; 0: none yet
};

// Half the width and height of the box that holds the platform.
physics::Vec2d half_extents_m(const physics::Platform& platform);

}  // namespace fts::sdl
