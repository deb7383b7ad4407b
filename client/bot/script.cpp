#include "client/bot/script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "client/bot/json_reader.h"
#include "client/bot/pilot.h"
#include "client/bot/tally.h"
#include "common/game/rules.h"

namespace fts::bot {
namespace {

using nlohmann::json;

constexpr double kLongestRunS = 86400.0;
constexpr double kAnyNumber = std::numeric_limits<double>::max();

struct NamedMoment {
    std::string_view name;
    Moment moment;
};
constexpr auto kMoments = std::to_array<NamedMoment>({
    {"joined", Moment::kJoined},
    {"countdown", Moment::kCountdown},
    {"playing", Moment::kPlaying},
    {"shop", Moment::kShop},
    {"level_cleared", Moment::kLevelCleared},
    {"level_lost", Moment::kLevelLost},
    {"ended", Moment::kEnded},
});

template <typename Range, typename NameOf>
std::string listed(const Range& range, NameOf name_of) {
    std::string list;
    for (const auto& item : range) {
        if (!list.empty()) list += ", ";
        list += name_of(item);
    }
    return list;
}

void fail_choice(JsonReader& reader, const std::string& name, const std::string& given,
                 const std::string& choices) {
    reader.fail(name, "is " + quoted(json(given)) + "; give one of " + choices + ".");
}

std::string stat_names() {
    std::string list;
    for (std::size_t i = 0; i < game::kStatCount; ++i) {
        if (i > 0) list += ", ";
        list += game::name_of(static_cast<game::Stat>(i));
    }
    return list;
}

Action parse_buy(JsonReader& reader) {
    const std::string name = reader.required_text("stat");
    const auto stat = game::stat_named(name);
    if (!stat && reader.ok()) fail_choice(reader, "stat", name, stat_names());
    return Buy{stat.value_or(game::Stat::kMass)};
}

Action parse_chat(JsonReader& reader) {
    const std::string text = reader.required_text("text");
    if (text.size() > std::size_t{game::kMaxChatBytes}) {
        reader.fail("text", "has " + std::to_string(text.size()) + " bytes; give at most " +
                                std::to_string(game::kMaxChatBytes) + ".");
    }
    return Chat{text};
}

Action parse_pilot(JsonReader& reader) {
    const std::string name = reader.required_text("name");
    if (reader.ok() && !make_pilot(name)) {
        const auto same = [](std::string_view known) { return std::string(known); };
        fail_choice(reader, "name", name, listed(pilot_names(), same));
    }
    return UsePilot{name};
}

Action parse_steer(JsonReader& reader) {
    const double x = reader.number("x", -1.0, 1.0).value_or(0.0);
    const double y = reader.number("y", -1.0, 1.0).value_or(0.0);
    game::InputCommand command = game::command_toward({x, y});
    command.brake = reader.boolean("brake").value_or(false);
    command.dash = reader.boolean("dash").value_or(false);
    return Steer{command};
}

template <typename T>
Action parse_plain(JsonReader&) {
    return T{};
}

struct NamedAction {
    std::string_view name;
    Action (*parse)(JsonReader&);
};
constexpr auto kActions = std::to_array<NamedAction>({
    {"buy", parse_buy},
    {"chat", parse_chat},
    {"pilot", parse_pilot},
    {"steer", parse_steer},
    {"ready", parse_plain<Ready>},
    {"leave", parse_plain<Leave>},
    {"join", parse_plain<Join>},
});

constexpr auto kNameOf = [](const auto& item) { return std::string(item.name); };

void parse_time(JsonReader& reader, Step& step) {
    const auto at_s = reader.number("at_s", 0.0, kLongestRunS);
    const auto when = reader.text("when");
    if (!reader.ok()) return;
    if (at_s.has_value() == when.has_value()) {
        reader.fail("", "needs either \"at_s\" or \"when\"; give one of the two.");
        return;
    }
    if (at_s) {
        step.at_s = *at_s;
        return;
    }
    step.at_s = reader.number("after_s", 0.0, kLongestRunS).value_or(0.0);
    step.each_time = reader.boolean("each_time").value_or(false);
    const auto* found = std::ranges::find(kMoments, std::string_view(*when), &NamedMoment::name);
    if (found == kMoments.end()) {
        fail_choice(reader, "when", *when, listed(kMoments, kNameOf));
        return;
    }
    step.when = found->moment;
}

Step parse_step(JsonReader& reader, int bots) {
    Step step;
    parse_time(reader, step);
    step.bot = reader.integer("bot", 0, bots - 1);
    const std::string name = reader.required_text("do");
    const auto* found = std::ranges::find(kActions, std::string_view(name), &NamedAction::name);
    if (!reader.ok()) return step;
    if (found == kActions.end()) {
        fail_choice(reader, "do", name, listed(kActions, kNameOf));
        return step;
    }
    step.action = found->parse(reader);
    reader.expect_nothing_else();
    return step;
}

Expectation parse_expectation(JsonReader& reader, int bots) {
    Expectation expectation;
    expectation.what = reader.required_text("what");
    expectation.bot = reader.integer("bot", 0, bots - 1);
    if (!reader.ok()) return expectation;
    if (expectation.what == kEndedBecause) {
        expectation.contains = reader.required_text("contains");
    } else if (metric_named(expectation.what) == nullptr) {
        fail_choice(reader, "what", expectation.what,
                    std::string(kEndedBecause) + ", " + listed(metrics(), kNameOf));
    } else {
        expectation.at_least = reader.number("at_least", -kAnyNumber, kAnyNumber);
        expectation.at_most = reader.number("at_most", -kAnyNumber, kAnyNumber);
        if (reader.ok() && !expectation.at_least && !expectation.at_most) {
            reader.fail("", "has neither \"at_least\" nor \"at_most\"; give one or both.");
        }
    }
    reader.expect_nothing_else();
    return expectation;
}

std::vector<Goal> parse_until(JsonReader& reader) {
    std::vector<Goal> goals;
    for (const std::string& name : reader.names()) {
        if (metric_named(name) == nullptr) {
            reader.fail(name, "is no metric; give one of " + listed(metrics(), kNameOf) + ".");
        }
        if (const auto value = reader.number(name, -kAnyNumber, kAnyNumber)) {
            goals.push_back({name, *value});
        }
    }
    return goals;
}

// Where in the text a byte is, for people: "line 3, column 7".
std::string line_and_column(const std::string& text, std::size_t byte) {
    std::size_t line = 1, column = 1;
    for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
        column = text[i] == '\n' ? 1 : column + 1;
        line += text[i] == '\n' ? 1U : 0U;
    }
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

}  // namespace

ParsedScript parse_script(const std::string& text, const std::string& file, int bots) {
    json root;
    try {
        root = json::parse(text);
    } catch (const json::parse_error& failure) {
        return {std::nullopt, file + ": " + line_and_column(text, failure.byte) +
                                  " is not JSON; check quotes, commas and brackets there."};
    } catch (const json::out_of_range&) {
        return {std::nullopt, file + " holds a number that is too large; give one below 1e308."};
    }
    JsonError error{file, ""};
    JsonReader reader(root, "$", error);
    Script script;
    for (JsonReader& step : reader.objects("steps")) script.steps.push_back(parse_step(step, bots));
    for (JsonReader& item : reader.objects("expect")) {
        script.expect.push_back(parse_expectation(item, bots));
    }
    if (auto until = reader.object("until")) script.until = parse_until(*until);
    script.auto_shop = reader.boolean("auto_shop").value_or(true);
    script.auto_ready = reader.boolean("auto_ready").value_or(true);
    reader.expect_nothing_else();
    if (!error.message.empty()) return {std::nullopt, error.message};
    return {std::move(script), ""};
}

ParsedScript read_script(const std::string& file, int bots) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    if (in) text << in.rdbuf();
    if (!in || !text) {
        return {std::nullopt, "Cannot read the script " + file + ". Check the path."};
    }
    return parse_script(text.str(), file, bots);
}

}  // namespace fts::bot
