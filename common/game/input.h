// What a player, an AI ball or a bot asks for in one tick. All three send the same struct: no
// physics cheats. It is already in its wire form, so every end simulates the same bits.
#pragma once

#include <cstdint>

#include "common/physics/scene.h"

namespace fts::game {

struct InputCommand {
    // Thrust direction and share of full thrust; (127, 0) is full thrust along +x. Vectors longer
    // than 127 are clamped to it by `thrust_of`.
    std::int8_t thrust_x = 0;
    std::int8_t thrust_y = 0;
    bool brake = false;
    bool dash =
        false;  // a level, not an edge: held down, it fires each time the dash has recharged
    friend bool operator==(const InputCommand&, const InputCommand&) = default;
};

// Thrust as a fraction of the full one, |result| <= 1.
physics::Vec2d thrust_of(const InputCommand& input);
// The nearest command to a wanted thrust fraction; non-finite components become 0.
InputCommand command_toward(const physics::Vec2d& thrust);

}  // namespace fts::game
