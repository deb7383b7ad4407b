// Pilot: steers one AI ball by what a player could see and do: it perceives late, decides now and
// then, and aims with noise, in no more directions than that noise lets it tell apart. Its decision
// is an InputCommand that holds until the next one, and further on while it would now want nearly
// the same: every change of a command travels to every client.
//
// Deterministic: the same seed and calls give the same commands.
#pragma once

#include <optional>

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
    // Whether what it does serves what it wants as well as aiming anew would.
    bool is_content(const Intent& wanted) const;
    physics::Vec2d aimed(const physics::Vec2d& thrust);

    game::Behaviour behaviour_;
    Skill skill_;
    Random random_;
    int ticks_to_decision_;
    game::InputCommand held_;
    std::optional<Intent> aimed_at_;  // what `held_` was meant to be; empty: something else
    int aimed_for_ms_ = 0;
};

}  // namespace fts::server::ai
