// Which solver a level is played with: the plan of common/physics/fidelity.h for the balls that may
// meet in it at their fastest, all players there and fully upgraded.
#pragma once

#include <string>
#include <vector>

#include "common/game/level.h"
#include "common/physics/fidelity.h"

namespace fts::server {

// The balls of a full level, dashing at top speed, all at the centre of the platform.
physics::Scene fastest_scene_of(const game::Level& level, int players);

// The tolerance is as in physics::Fidelity. Always double: a match is not played in less.
physics::Plan plan_level(const game::Level& level, int players, double tolerance);
std::vector<physics::Plan> plan_levels(const std::vector<game::Level>& levels, int players,
                                       double tolerance);

// One line a plan that differs from the one before:
// "levels 1 to 10: swept, double. Bodies move about 0.3 radii a tick: ..."
std::vector<std::string> describe_levels(const std::vector<physics::Plan>& plans);

}  // namespace fts::server
