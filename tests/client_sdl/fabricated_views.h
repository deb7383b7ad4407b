// Views made up for tests: what a player might see at a chosen moment.
#pragma once

#include "client/core/view.h"
#include "common/replication/messages.h"

namespace fts::sdl {

// Three players and five AI balls on a disc, in the middle of level 3.
client::View match_view();
client::View rectangle_view();
client::View ring_view();
client::View crowded_view();  // 64 players, 40 balls, long names
client::View countdown_view();
client::View shop_view();
client::View fallen_view();

// An oblique elastic hit, as the simulation would report it.
replication::CollisionReport oblique_hit(double own_kg, double other_kg,
                                         const physics::Vec2d& other_velocity_mps,
                                         const physics::Vec2d& own_velocity_mps = {4.6, 1.9});

}  // namespace fts::sdl
