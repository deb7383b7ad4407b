// Difficulty is perception and decision only: an AI ball of any difficulty obeys the same physics.
#pragma once

#include "common/game/level.h"

namespace fts::server::ai {

struct Skill {
    int reaction_ms = 0;  // the world is seen as it was this long ago
    int decides_every_ms = 0;
    double aim_noise_deg = 0.0;  // standard deviation
    double look_ahead_s = 0.0;   // how far others' motion is foreseen
};

const Skill& skill_of(game::Difficulty difficulty);
int ticks_of_ms(int duration_ms);

}  // namespace fts::server::ai
