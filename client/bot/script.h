// Script: what bots are told to do and what is expected of a run, from a JSON file.
//
//   {
//     "steps": [ {"at_s": 1.0, "bot": 0, "do": "buy", "stat": "mass"},
//                {"when": "shop", "after_s": 0.5, "each_time": true, "do": "chat", "text": "hello"}
//                ],
//     "auto_shop": true,
//     "auto_ready": true,
//     "until": {"levels_cleared": 1},
//     "expect": [ {"what": "joined", "at_least": 4}, {"what": "coins", "bot": 0, "at_least": 5},
//                 {"what": "ended_because", "contains": "full"} ]
//   }
//
// A step has either "at_s", seconds since the start of the run, or "when", a moment of a bot's own:
//   joined, countdown, playing, shop, level_cleared, level_lost, ended.
// With "when" it acts "after_s" later (0), at the first such moment, or at each with "each_time".
// "bot" is the number of one bot, from 0; without it every bot acts. "do" is one of
//   buy (with "stat"), chat (with "text"), pilot (with "name"), ready, leave, join (again, as the
//   same player, after the session has ended), and steer (with "x" and "y", the thrust from -1 to
//   1, and "brake" and "dash") which holds one command until the next "pilot".
// "auto_shop" lets bots buy what their pilot wants and they can afford; "auto_ready" lets them
// leave the shop afterwards. Both are true unless said otherwise. "until" ends the run early, as
// soon as every metric in it has reached its value. "expect" holds at the end of the run. "what" is
// a metric (tally.h; of all bots together, or of one "bot") with "at_least", "at_most" or both, or
// "ended_because" with "contains": the reason of that bot, or of any bot, contains the text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/game/input.h"
#include "common/game/upgrades.h"

namespace fts::bot {

enum class Moment : std::uint8_t {
    kJoined,
    kCountdown,
    kPlaying,
    kShop,
    kLevelCleared,
    kLevelLost,
    kEnded,
};

struct Buy {
    game::Stat stat = game::Stat::kMass;
};
struct Chat {
    std::string text;
};
struct UsePilot {
    std::string name;
};
struct Steer {
    game::InputCommand command;
};
struct Ready {};
struct Leave {};
struct Join {};
using Action = std::variant<Buy, Chat, UsePilot, Steer, Ready, Leave, Join>;

struct Step {
    std::optional<Moment> when;  // otherwise at `at_s`
    double at_s = 0.0;           // since the start, or since the moment
    bool each_time = false;
    std::optional<int> bot;  // every bot otherwise
    Action action;
};

struct Expectation {
    std::string what;
    std::optional<int> bot;
    std::optional<double> at_least, at_most;
    std::string contains;  // for "ended_because"
};

struct Goal {
    std::string metric;
    double at_least = 0.0;
};

struct Script {
    std::vector<Step> steps;
    bool auto_shop = true;
    bool auto_ready = true;
    std::vector<Goal> until;  // empty: runs its full time
    std::vector<Expectation> expect;
};

inline constexpr std::string_view kEndedBecause = "ended_because";

struct ParsedScript {
    std::optional<Script> script;
    std::string error;  // names file, place, value and remedy
};
// `file` is only named in errors. `bots` is how many there are.
ParsedScript parse_script(const std::string& text, const std::string& file, int bots);
ParsedScript read_script(const std::string& file, int bots);

}  // namespace fts::bot
