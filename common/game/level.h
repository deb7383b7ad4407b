// A level of the campaign as a value. Read from text files by the server
// (server/match/level_file.h); its platform travels to clients.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/physics/scene.h"

namespace fts::game {

enum class Phase : std::uint8_t {
    kWaiting,    // nobody is here; the arena is paused
    kCountdown,  // balls stand on the platform, nothing moves
    kPlaying,
    kShop,  // between levels, after a win or a loss
};

enum class Difficulty : std::uint8_t { kNovice, kEasy, kNormal, kHard, kExpert };
enum class Behaviour : std::uint8_t { kChaser, kEdgeGuard, kInterceptor, kHerd, kCoward, kBruiser };

struct AiGroup {
    Behaviour behaviour = Behaviour::kChaser;
    Difficulty difficulty = Difficulty::kNovice;
    int count = 1;
    double radius_m = 0.5;
    double mass_kg = 1.0;
    double thrust_n = 6.0;
    double top_speed_mps = 5.0;
};

struct Level {
    int number = 1;
    std::string name;
    std::string hint;  // one sentence a player reads during the countdown
    physics::Platform platform = physics::Disc{12.0};
    std::vector<AiGroup> ai;
    int field_coins = 0;  // coins lying on the platform at the start
    double time_limit_s = 120;
};

}  // namespace fts::game
