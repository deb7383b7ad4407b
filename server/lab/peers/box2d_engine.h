// Box2D 2.4 set up for elastic discs as well as it can be: restitution 1 at any speed, no friction,
// no rotation, no sleep, no warm starting (nothing rests), 8 velocity and 3 position iterations as
// its manual has it. It wants to move a body by at most 2 m a step: a faster scene is made smaller.
#pragma once

#include <memory>

#include "server/lab/bench/engine.h"

namespace fts::lab {

// With bullets, times of impact are found and nothing passes through anything; without, bodies move
// a whole step and overlaps are found afterwards, as Chipmunk does it.
enum class Bullets : std::uint8_t { kNo, kYes };

std::unique_ptr<Engine> make_box2d(const physics::Scene& scene, double tick_s, Bullets bullets);

}  // namespace fts::lab
