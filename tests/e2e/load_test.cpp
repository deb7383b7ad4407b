// scripts/load, made small: that it runs, and that its report says what it is to say.
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/stage_times.h"
#include "tests/harness/process.h"
#include "tests/harness/temp_folder.h"

namespace fts::e2e {
namespace {

using ::testing::HasSubstr;

void expect_whole(const nlohmann::json& run, int players) {
    const auto& server = run.at("server");
    EXPECT_EQ(run.at("bots").at("total").at("joined"), players);
    EXPECT_GT(run.at("bots").at("cpu_s").get<double>(), 0.0);
    EXPECT_EQ(server.at("joins"), players);
    EXPECT_GT(server.at("ticks").at("played").get<int>(), 60);
    EXPECT_GE(server.at("ticks").at("missed").get<int>(), 0);
    EXPECT_GT(server.at("cpu_s").get<double>(), 0.0);
    EXPECT_GT(server.at("player_ticks").get<int>(), 60 * players);
    for (const std::string_view name : server::kStageNames) {
        const auto& stage = server.at("stages").at(std::string(name));
        EXPECT_GT(stage.at("mean_us").get<double>(), 0.0) << name;
        EXPECT_LE(stage.at("p50_us").get<double>(), stage.at("p99_us").get<double>()) << name;
        EXPECT_LE(stage.at("p99_us").get<double>(), stage.at("max_us").get<double>()) << name;
    }
    EXPECT_GT(server.at("traffic").at("bytes_sent").get<double>(), 0.0);
    EXPECT_GT(server.at("traffic").at("bytes_received").get<double>(), 0.0);
    for (const char* reason : {"receive_buffer_full", "send_buffer_full", "bad_seal"}) {
        EXPECT_TRUE(server.at("drops").contains(reason)) << reason;
    }
}

TEST(Load, AShortRunOfTheScriptEndsWellAndItsReportIsWhole) {
    const harness::TempFolder folder;
    const std::string report = folder.file("load.json");
    harness::Process load(FTS_LOAD_SCRIPT, {"--bin", FTS_PROGRAMS, "--seconds", "4", "--bots", "20",
                                            "--balls", "90", "--crowd", "6", "--json", report});
    ASSERT_EQ(load.wait(300.0), 0) << load.output();
    EXPECT_THAT(load.output(), HasSubstr("20 players in 2 arenas of 16"));
    EXPECT_THAT(load.output(), HasSubstr("90 balls in one arena, 6 of them players"));
    EXPECT_THAT(load.output(), HasSubstr("missed ticks"));
    EXPECT_THAT(load.output(), HasSubstr("Stages of a tick, us"));

    std::ifstream file(report);
    const auto json = nlohmann::json::parse(file, nullptr, false);
    ASSERT_TRUE(json.is_object()) << "not JSON: " << report;
    EXPECT_EQ(json.at("seconds"), 4);
    expect_whole(json.at("runs").at("arenas"), 20);
    expect_whole(json.at("runs").at("crowd"), 6);
}

TEST(Load, WhatTheScriptCannotDoIsSaidWithAUsageCode) {
    const std::vector<std::vector<std::string>> nonsense = {
        {"--bots", "0"},   {"--seconds"},         {"--balls", "64", "--crowd", "64"},
        {"--crowd", "65"}, {"--only", "nothing"}, {"--fast"}};
    for (const auto& arguments : nonsense) {
        harness::Process load(FTS_LOAD_SCRIPT, arguments);
        EXPECT_EQ(load.wait(60.0), 2) << arguments.front();
        EXPECT_THAT(load.output(), HasSubstr("load: ")) << arguments.front();
    }
}

}  // namespace
}  // namespace fts::e2e
