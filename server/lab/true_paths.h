// Where every ball of a server is at every frame of a faster clock, between two snapshots: exactly,
// hits inside a tick included.
#pragma once

#include <cstddef>
#include <vector>

#include "common/physics/world.h"

namespace fts::lab {

class TruePaths {
  public:
    // Frames in the middle of each part of a tick.
    explicit TruePaths(std::size_t frames_per_tick) : frames_per_tick_(frames_per_tick) {}

    void clear() { frames_.clear(); }
    void before_tick(const physics::World<double>& world);
    void after_tick(const physics::World<double>& world, double tick_s);

    std::size_t frames() const { return frames_.size(); }
    double tick_of(std::size_t frame) const {
        return (static_cast<double>(frame) + 0.5) / static_cast<double>(frames_per_tick_);
    }
    // By the index of the ball.
    const std::vector<physics::Vec2d>& at(std::size_t frame) const { return frames_[frame]; }

  private:
    std::size_t frames_per_tick_;
    std::vector<physics::Vec2d> start_m_;
    std::vector<std::vector<physics::Vec2d>> frames_;
};

}  // namespace fts::lab
