// Scripts: what is understood, and what is refused with which words.
#include "client/bot/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/bot/expectations.h"

namespace fts::bot {
namespace {

using testing::HasSubstr;

constexpr int kBots = 4;

Script parsed(const std::string& text) {
    const ParsedScript result = parse_script(text, "test.json", kBots);
    EXPECT_TRUE(result.script) << result.error;
    return result.script.value_or(Script{});
}

TEST(Script, is_complete_when_it_is_empty) {
    const Script script = parsed("{}");
    EXPECT_TRUE(script.steps.empty());
    EXPECT_TRUE(script.auto_shop);
    EXPECT_TRUE(script.auto_ready);
}

TEST(Script, understands_every_step) {
    const Script script = parsed(R"({
        "steps": [
            {"at_s": 1.5, "bot": 2, "do": "buy", "stat": "top_speed"},
            {"when": "shop", "after_s": 0.5, "each_time": true, "do": "chat", "text": "hi"},
            {"at_s": 0, "do": "pilot", "name": "idle"},
            {"at_s": 0, "do": "steer", "x": 1, "y": 0, "dash": true},
            {"at_s": 0, "do": "ready"}, {"at_s": 0, "do": "leave"}, {"at_s": 0, "do": "join"}],
        "auto_shop": false, "auto_ready": false,
        "until": {"levels_cleared": 2},
        "expect": [{"what": "coins", "bot": 0, "at_least": 5, "at_most": 9},
                   {"what": "ended_because", "contains": "full"}]})");
    ASSERT_EQ(script.steps.size(), 7U);
    EXPECT_EQ(std::get<Buy>(script.steps[0].action).stat, game::Stat::kTopSpeed);
    EXPECT_EQ(script.steps[0].bot, 2);
    EXPECT_DOUBLE_EQ(script.steps[0].at_s, 1.5);
    EXPECT_EQ(script.steps[1].when, Moment::kShop);
    EXPECT_DOUBLE_EQ(script.steps[1].at_s, 0.5);
    EXPECT_TRUE(script.steps[1].each_time);
    EXPECT_EQ(std::get<Steer>(script.steps[3].action).command,
              (game::InputCommand{127, 0, false, true}));
    EXPECT_FALSE(script.auto_shop);
    ASSERT_EQ(script.until.size(), 1U);
    EXPECT_EQ(script.until[0].metric, "levels_cleared");
    ASSERT_EQ(script.expect.size(), 2U);
    EXPECT_EQ(script.expect[0].at_most, 9.0);
    EXPECT_EQ(script.expect[1].contains, "full");
}

struct Refused {
    std::string text;
    std::vector<std::string> words;  // all of them are in the message
};

TEST(Script, is_refused_with_file_place_value_and_remedy) {
    const std::vector<Refused> cases = {
        {"{\n  \"steps\": [,]\n}", {"line 2, column 13", "JSON"}},
        {"", {"line 1", "JSON"}},
        {"[]", {"$ ", "object"}},
        {R"({"step": []})", {"$.step ", "remove"}},
        {R"({"steps": {}})", {"$.steps ", "list"}},
        {R"({"steps": [3]})", {"$.steps[0] ", "3", "object"}},
        {R"({"steps": [{"do": "ready"}]})", {"$.steps[0] ", "at_s", "when"}},
        {R"({"steps": [{"at_s": 1, "when": "shop", "do": "ready"}]})", {"$.steps[0] ", "one of"}},
        {R"({"steps": [{"at_s": -1, "do": "ready"}]})", {"$.steps[0].at_s ", "-1", "86400"}},
        {R"({"steps": [{"at_s": 1}]})", {"$.steps[0] ", "\"do\""}},
        {R"({"steps": [{"at_s": 1, "do": "dance"}]})", {"\"dance\"", "buy, chat, pilot"}},
        {R"({"steps": [{"when": "noon", "do": "ready"}]})", {"\"noon\"", "joined, countdown"}},
        {R"({"steps": [{"at_s": 1, "do": "buy"}]})", {"$.steps[0] ", "\"stat\""}},
        {R"({"steps": [{"at_s": 1, "do": "buy", "stat": "speeed"}]})",
         {"$.steps[0].stat ", "speeed", "top speed"}},
        {R"({"steps": [{"at_s": 1, "do": "pilot", "name": "ace"}]})", {"\"ace\"", "chaser"}},
        {R"({"steps": [{"at_s": 1, "do": "steer", "x": 2}]})", {"$.steps[0].x ", "-1 to 1"}},
        {R"({"steps": [{"at_s": 1, "do": "ready", "now": true}]})", {"$.steps[0].now "}},
        {R"({"steps": [{"at_s": 1, "do": "ready", "bot": 4}]})", {"$.steps[0].bot ", "0 to 3"}},
        {R"({"steps": [{"at_s": 1, "do": "ready", "bot": 1.5}]})", {"1.5", "whole"}},
        {R"({"steps": [{"at_s": 1, "do": "chat", "text": ")" + std::string(500, 'x') + R"("}]})",
         {"$.steps[0].text ", "500", "160"}},
        {R"({"auto_shop": "yes"})", {"$.auto_shop ", "\"yes\"", "true or false"}},
        {R"({"until": {"fun": 1}})", {"$.until.fun ", "levels_cleared"}},
        {R"({"until": {"coins": "many"}})", {"$.until.coins ", "many", "number"}},
        {R"({"expect": [{"what": "coins"}]})", {"$.expect[0] ", "at_least"}},
        {R"({"expect": [{"what": "glory", "at_least": 1}]})", {"\"glory\"", "knock_offs"}},
        {R"({"expect": [{"what": "ended_because", "at_least": 1}]})", {"\"contains\""}},
    };
    for (const Refused& refused : cases) {
        SCOPED_TRACE(refused.text.substr(0, 100));
        const ParsedScript result = parse_script(refused.text, "test.json", kBots);
        EXPECT_FALSE(result.script);
        EXPECT_THAT(result.error, HasSubstr("test.json"));
        for (const std::string& word : refused.words) EXPECT_THAT(result.error, HasSubstr(word));
    }
}

TEST(Script, that_cannot_be_read_is_named) {
    const ParsedScript result = read_script("/nowhere/at/all.json", kBots);
    EXPECT_FALSE(result.script);
    EXPECT_THAT(result.error, HasSubstr("/nowhere/at/all.json"));
}

std::vector<Tally> three_tallies() {
    std::vector<Tally> tallies(3);
    for (std::size_t i = 0; i < tallies.size(); ++i) {
        tallies[i].joined = true;
        tallies[i].coins = static_cast<int>(10 * i);
        tallies[i].levels_cleared = static_cast<int>(i);
    }
    tallies[2].ended_because = "The server is full.";
    return tallies;
}

TEST(Expectations, judge_one_bot_or_all_together) {
    const auto tallies = three_tallies();
    const Script script = parsed(R"({"expect": [
        {"what": "joined", "at_least": 3}, {"what": "coins", "at_least": 30},
        {"what": "coins", "bot": 0, "at_least": 1}, {"what": "levels_cleared", "at_most": 2},
        {"what": "coins", "at_least": 31}, {"what": "ended_because", "contains": "full"},
        {"what": "ended_because", "bot": 0, "contains": "full"}]})");
    const auto verdicts = judge(script.expect, tallies);
    ASSERT_EQ(verdicts.size(), 7U);
    const bool met[] = {true, true, false, true, false, true, false};
    for (std::size_t i = 0; i < verdicts.size(); ++i) EXPECT_EQ(verdicts[i].met, met[i]) << i;
    EXPECT_EQ(verdicts[4].expected, "coins at least 31");
    EXPECT_EQ(verdicts[4].seen, "30");
    EXPECT_EQ(verdicts[2].expected, "coins of bot 0 at least 1");
}

TEST(Expectations, reach_a_goal_only_when_all_of_it_is_there) {
    const auto tallies = three_tallies();
    EXPECT_FALSE(reached({}, tallies));
    EXPECT_TRUE(reached({{"levels_cleared", 2}}, tallies));
    EXPECT_FALSE(reached({{"levels_cleared", 2}, {"coins", 31}}, tallies));
}

}  // namespace
}  // namespace fts::bot
