// Pilot: steers one AI ball by what a player could see and do: it perceives late, decides now and
// then, aims with noise, and its decision is an InputCommand that holds until the next one.
//
// Deterministic: the same seed and calls give the same commands.
#pragma once

#include "common/game/input.h"
#include "server/ai/behaviours.h"
#include "server/ai/difficulty.h"
#include "server/match/random.h"

namespace fts::server::ai {

class Pilot {
  public:
    Pilot(game::Behaviour behaviour, game::Difficulty difficulty, std::uint64_t seed);

    // Once a tick. `ball` is the pilot's own in the memory.
    game::InputCommand command(std::uint16_t ball, const game::BallStats& stats,
                               const physics::Platform& platform, const Memory& memory);

  private:
    game::InputCommand decide_now(std::uint16_t ball, const game::BallStats& stats,
                                  const physics::Platform& platform, const Frame& seen);
    physics::Vec2d with_aim_noise(const physics::Vec2d& direction);

    game::Behaviour behaviour_;
    Skill skill_;
    Random random_;
    int ticks_to_decision_;
    game::InputCommand held_;
};

}  // namespace fts::server::ai
