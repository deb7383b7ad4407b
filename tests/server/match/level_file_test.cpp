#include "server/match/level_file.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fts::server {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kGood = R"(number: 3
name: "Long table"
hint: "Equal masses swap velocities."
platform { rectangle { width_m: 24 height_m: 16 } }
ai { behaviour: CHASER difficulty: NOVICE }
ai { behaviour: COWARD difficulty: EXPERT count: 2 radius_m: 0.4 mass_kg: 0.5 thrust_n: 3 top_speed_mps: 7 }
field_coins: 5
time_limit_s: 90
)";

std::string with(std::string from, std::string to) {
    std::string text = kGood;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(LevelFile, is_read_field_by_field_with_defaults_for_what_is_left_out) {
    const LoadedLevels loaded = parse_level(kGood, "03.level");
    ASSERT_EQ(loaded.error, "");
    ASSERT_EQ(loaded.levels.size(), 1u);
    const game::Level& level = loaded.levels[0];
    EXPECT_EQ(level.number, 3);
    EXPECT_EQ(level.name, "Long table");
    EXPECT_EQ(level.hint, "Equal masses swap velocities.");
    EXPECT_EQ(std::get<physics::Rectangle>(level.platform).half_extents_m,
              physics::Vec2d(12.0, 8.0));
    ASSERT_EQ(level.ai.size(), 2u);
    EXPECT_EQ(level.ai[0].behaviour, game::Behaviour::kChaser);
    EXPECT_EQ(level.ai[0].difficulty, game::Difficulty::kNovice);
    EXPECT_EQ(level.ai[0].count, game::AiGroup{}.count);
    EXPECT_EQ(level.ai[0].mass_kg, game::AiGroup{}.mass_kg);
    EXPECT_EQ(level.ai[1].behaviour, game::Behaviour::kCoward);
    EXPECT_EQ(level.ai[1].difficulty, game::Difficulty::kExpert);
    EXPECT_EQ(level.ai[1].count, 2);
    EXPECT_EQ(level.ai[1].top_speed_mps, 7.0);
    EXPECT_EQ(level.field_coins, 5);
    EXPECT_EQ(level.time_limit_s, 90.0);
}

struct Wrong {
    const char* situation;
    const char* from;
    const char* to;
    const char* error;
};

class WrongLevelFile : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongLevelFile, is_refused_with_file_field_value_and_remedy) {
    const Wrong& wrong = GetParam();
    const LoadedLevels loaded = parse_level(with(wrong.from, wrong.to), "levels/03.level");
    EXPECT_TRUE(loaded.levels.empty());
    EXPECT_THAT(loaded.error, StartsWith("levels/03.level:"));
    EXPECT_THAT(loaded.error, HasSubstr(wrong.error));
}

const Wrong kWrongs[] = {
    {"negative_mass", "mass_kg: 0.5", "mass_kg: -2",
     "ai[1].mass_kg is -2; give a mass between 0.05 and 100"},
    {"mass_not_a_number", "mass_kg: 0.5", "mass_kg: nan", "ai[1].mass_kg is nan; give"},
    {"infinite_mass", "mass_kg: 0.5", "mass_kg: inf", "ai[1].mass_kg is inf; give"},
    {"overflowing_mass", "mass_kg: 0.5", "mass_kg: 1e999", "ai[1].mass_kg is inf; give"},
    {"huge_radius", "radius_m: 0.4", "radius_m: 40", "ai[1].radius_m is 40; give a radius"},
    {"negative_thrust", "thrust_n: 3", "thrust_n: -3", "ai[1].thrust_n is -3; give a thrust"},
    {"no_speed", "top_speed_mps: 7", "top_speed_mps: 0", "ai[1].top_speed_mps is 0; give a speed"},
    {"no_balls", "count: 2", "count: 0", "ai[1].count is 0; give a number from 1"},
    {"too_many_balls", "count: 2", "count: 4000000000", "ai[1].count is 2147483647; give"},
    {"crowded", "count: 2 radius_m: 0.4", "count: 100 radius_m: 1", "ai covers"},
    {"no_behaviour", "behaviour: COWARD", "", "ai[1].behaviour is missing; give CHASER"},
    {"no_difficulty", "difficulty: EXPERT", "", "ai[1].difficulty is missing; give NOVICE"},
    {"unknown_behaviour", "COWARD", "DANCER", ":6:"},
    {"unknown_field", "field_coins: 5", "fluffiness: 5", ":7:"},
    {"syntax", "field_coins: 5", "field_coins: {", ":7:"},
    {"text_for_a_number", "field_coins: 5", "field_coins: \"many\"", ":7:"},
    {"negative_count", "field_coins: 5", "field_coins: -5", ":7:"},
    {"number_zero", "number: 3", "number: 0", "number is 0; give a number from 1"},
    {"no_name", "\"Long table\"", "\"\"", "name is empty; give"},
    {"control_character", "Long table", "Long\\ntable", "name holds a control character"},
    {"no_hint", "\"Equal masses swap velocities.\"", "\"\"", "hint is empty; give"},
    {"no_platform", "platform { rectangle { width_m: 24 height_m: 16 } }", "",
     "platform is missing; give a disc, a rectangle or a ring"},
    {"flat_platform", "height_m: 16", "height_m: 0", "platform.rectangle.height_m is 0; give"},
    {"endless_platform", "width_m: 24", "width_m: inf", "platform.rectangle.width_m is inf"},
    {"tiny_disc", "rectangle { width_m: 24 height_m: 16 }", "disc { radius_m: 1 }",
     "platform.disc.radius_m is 1; give a radius"},
    {"ring_without_band", "rectangle { width_m: 24 height_m: 16 }",
     "ring { inner_radius_m: 9.5 outer_radius_m: 10 }",
     "platform.ring.inner_radius_m is 9.5; give at most 8"},
    {"too_many_coins", "field_coins: 5", "field_coins: 5000", "field_coins is 5000; give"},
    {"no_time", "time_limit_s: 90", "time_limit_s: 0", "time_limit_s is 0; give a time"},
};
INSTANTIATE_TEST_SUITE_P(All, WrongLevelFile, ::testing::ValuesIn(kWrongs),
                         [](const auto& wrong) { return std::string(wrong.param.situation); });

TEST(LevelFile, without_ai_balls_is_refused) {
    EXPECT_THAT(
        parse_level("number: 1 name: 'a' hint: 'b' platform { disc { radius_m: 9 } }", "f").error,
        HasSubstr("ai is empty; give at least one group"));
}

class LevelFolder : public ::testing::Test {
  protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "fts-levels-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder = name;
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder / name) << text;
    }
    std::filesystem::path folder;
};

TEST_F(LevelFolder, is_sorted_by_number_and_other_files_are_left_alone) {
    write("b.level", with("number: 3", "number: 1"));
    write("a.level", with("number: 3", "number: 2"));
    write("notes.txt", "nothing of ours");
    const LoadedLevels loaded = load_levels(folder);
    ASSERT_EQ(loaded.error, "");
    ASSERT_EQ(loaded.levels.size(), 2u);
    EXPECT_EQ(loaded.levels[0].number, 1);
    EXPECT_EQ(loaded.levels[1].number, 2);
}

TEST_F(LevelFolder, with_a_gap_or_a_repeat_is_refused) {
    write("a.level", with("number: 3", "number: 1"));
    write("b.level", kGood);
    EXPECT_THAT(load_levels(folder).error, HasSubstr("b.level: number is 3; give 2"));
    write("b.level", with("number: 3", "number: 1"));
    EXPECT_THAT(load_levels(folder).error, HasSubstr("b.level: number is 1; give 2"));
}

TEST_F(LevelFolder, that_is_empty_or_missing_is_refused) {
    EXPECT_THAT(load_levels(folder).error, HasSubstr("holds no *.level file"));
    const std::string missing = folder / "nowhere";
    EXPECT_THAT(load_levels(missing).error, StartsWith(missing));
}

TEST_F(LevelFolder, with_a_giant_file_is_refused) {
    write("a.level", std::string(100'000, ' '));
    EXPECT_THAT(load_levels(folder).error, HasSubstr("is 100000 bytes long; give"));
}

TEST_F(LevelFolder, with_a_folder_named_like_a_level_is_refused) {
    std::filesystem::create_directory(folder / "a.level");
    EXPECT_THAT(load_levels(folder).error, HasSubstr("a.level cannot be read"));
}

TEST(ShippedLevels, are_a_campaign_on_all_kinds_of_platforms) {
    const LoadedLevels loaded = load_levels(FTS_LEVELS_DIR);
    ASSERT_EQ(loaded.error, "");
    EXPECT_GE(loaded.levels.size(), 8u);
    std::set<std::size_t> platforms;
    std::set<game::Behaviour> behaviours;
    for (const game::Level& level : loaded.levels) {
        platforms.insert(level.platform.index());
        for (const game::AiGroup& group : level.ai) behaviours.insert(group.behaviour);
    }
    EXPECT_EQ(platforms.size(), std::variant_size_v<physics::Platform>);
    EXPECT_EQ(behaviours.size(), 6u);
}

}  // namespace
}  // namespace fts::server
