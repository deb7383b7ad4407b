// fts-lab bench as people run it.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/lab/bench/engine.h"
#include "tests/harness/process.h"

namespace fts::lab {
namespace {

// Ours, and Chipmunk where it is there: it talks when it starts.
std::string two_engines() {
    const bool has_chipmunk = find_engine("chipmunk-tree") != nullptr;
    return has_chipmunk ? "discrete-double,chipmunk-tree" : "discrete-double";
}

// What a quick bench of 32 balls leaves on stdout alone.
std::string stdout_of(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"-c",
                                          R"(exec "$0" "$@" 2>/dev/null)",
                                          FTS_LAB_PROGRAM,
                                          "bench",
                                          "--quick",
                                          "--balls",
                                          "32",
                                          "--speed",
                                          "2",
                                          "--repeats",
                                          "1",
                                          "--engine",
                                          two_engines()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    harness::Process process("/bin/sh", arguments);
    EXPECT_EQ(process.wait(120.0), 0);
    return process.output();
}

TEST(BenchProgram, puts_nothing_but_json_on_stdout_when_told_to) {
    const auto json = nlohmann::json::parse(stdout_of({"--json", "-"}), nullptr, false);
    ASSERT_FALSE(json.is_discarded());
    EXPECT_EQ(json["rows"].size(), find_engine("chipmunk-tree") == nullptr ? 1U : 2U);
    for (const auto& row : json["rows"]) EXPECT_GT(row["ns_per_ball_tick"], 0.0);
}

TEST(BenchProgram, puts_nothing_but_a_picture_on_stdout_that_names_its_command) {
    const std::string svg = stdout_of({"--svg", "-"});
    EXPECT_TRUE(svg.starts_with("<svg"));
    EXPECT_THAT(svg, testing::HasSubstr("--balls 32 --packing 0.3 --radii equal --speed 2"));
}

TEST(BenchProgram, measures_the_rest_where_a_scene_cannot_be_made_and_takes_no_option_back) {
    const auto json = nlohmann::json::parse(
        stdout_of({"--packing", "0.8,0.1", "--radii", "unequal", "--json", "-"}), nullptr, false);
    ASSERT_FALSE(json.is_discarded());
    for (const auto& row : json["rows"]) {
        SCOPED_TRACE(row.dump());
        EXPECT_EQ(row["balls"], 32);
        EXPECT_EQ(row["radii"], "unequal");
        if (row["packing"] == 0.8) {
            EXPECT_THAT(row["not_run"].get<std::string>(), testing::HasSubstr("packing_fraction"));
        } else {
            EXPECT_GT(row["ns_per_ball_tick"], 0.0);
        }
    }
}

}  // namespace
}  // namespace fts::lab
