// Pilot: what a bot does next. It sees what a player is told (a Sight) and answers with what a
// player sends (an InputCommand); it knows no connection and no clock. The same sights and the same
// random numbers give the same commands.
#pragma once

#include <memory>
#include <random>
#include <span>
#include <string_view>

#include "client/bot/field.h"
#include "common/game/input.h"
#include "common/game/upgrades.h"

namespace fts::bot {

using Rng = std::mt19937_64;  // the same sequence on every system

class Pilot {
  public:
    virtual ~Pilot() = default;
    // Once per snapshot while its phase is kPlaying and the own ball is on the platform.
    virtual game::InputCommand decide(const Sight& sight, Rng& rng) = 0;
    // What it spends coins on, the most wanted first; nothing else is bought.
    virtual std::span<const game::Stat> shopping_list() const = 0;
};

// "chaser", "collector", "defender", "wanderer", "idle".
std::span<const std::string_view> pilot_names();
// nullptr for a name that is not among them.
std::unique_ptr<Pilot> make_pilot(std::string_view name);

// [low, high), the same on every system for the same state of `rng`.
double uniform(Rng& rng, double low, double high);

}  // namespace fts::bot
