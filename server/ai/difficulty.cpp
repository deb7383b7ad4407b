#include "server/ai/difficulty.h"

#include <array>

#include "common/game/rules.h"

namespace fts::server::ai {
namespace {

constexpr std::array<Skill, 5> kSkills = {{
    {.reaction_ms = 500, .decides_every_ms = 400, .aim_noise_deg = 20.0, .look_ahead_s = 0.0},
    {.reaction_ms = 350, .decides_every_ms = 250, .aim_noise_deg = 12.0, .look_ahead_s = 0.3},
    {.reaction_ms = 250, .decides_every_ms = 150, .aim_noise_deg = 7.0, .look_ahead_s = 0.6},
    {.reaction_ms = 180, .decides_every_ms = 100, .aim_noise_deg = 4.0, .look_ahead_s = 1.0},
    {.reaction_ms = 120, .decides_every_ms = 50, .aim_noise_deg = 2.0, .look_ahead_s = 1.5},
}};
static_assert(kSkills.size() == static_cast<std::size_t>(game::Difficulty::kExpert) + 1);

}  // namespace

const Skill& skill_of(game::Difficulty difficulty) {
    return kSkills[static_cast<std::size_t>(difficulty)];
}

int ticks_of_ms(int duration_ms) {
    return (duration_ms * game::kTickRateHz + 500) / 1000;
}

}  // namespace fts::server::ai
