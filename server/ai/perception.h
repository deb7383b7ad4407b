// What AI balls see: where all balls are, as it was a reaction time ago. One memory serves all AI
// balls of a match.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "common/game/level.h"
#include "common/physics/scene.h"

namespace fts::server::ai {

struct SeenBall {
    std::uint16_t id = 0;
    bool is_player = false;
    game::Behaviour behaviour = game::Behaviour::kChaser;  // of an AI ball: its looks tell
    physics::Vec2d position_m = physics::Vec2d::Zero();
    physics::Vec2d velocity_mps = physics::Vec2d::Zero();
    double radius_m = 0.0;
    double mass_kg = 0.0;
};

using Frame = std::vector<SeenBall>;

class Memory {
  public:
    static constexpr std::size_t kFrames = 31;  // the slowest reaction, 500 ms, and the present

    void remember(Frame frame);
    void clear() { frames_.clear(); }
    // The frame of so many ticks ago, or the oldest there is; nullptr when there is none.
    const Frame* as_of(int ticks_ago) const;

  private:
    std::deque<Frame> frames_;  // newest first
};

}  // namespace fts::server::ai
