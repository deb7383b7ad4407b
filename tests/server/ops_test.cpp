// What a host sees: options from flags and environment, and the report at the end.
#include <cstdlib>
#include <fstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/ops/options.h"
#include "server/ops/report.h"
#include "tests/harness/temp_folder.h"

namespace fts::server {
namespace {

using ::testing::HasSubstr;

ParsedOptions parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "fts-server");
    return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(Options, have_defaults_that_work) {
    const auto parsed = parse({});
    ASSERT_TRUE(parsed.options);
    EXPECT_EQ(parsed.options->port, game::kDefaultPort);
    EXPECT_EQ(parsed.options->arenas, 1);
    EXPECT_EQ(parsed.options->players_per_arena, game::kDefaultPlayersPerArena);
    EXPECT_THAT(parsed.options->levels_folder, HasSubstr("share/fear-the-sphere/levels"));
}

TEST(Options, differ_in_their_seed_from_run_to_run_unless_one_is_given) {
    EXPECT_NE(parse({}).options->seed, parse({}).options->seed);
    EXPECT_EQ(parse({"--seed", "7"}).options->seed, 7U);
}

TEST(Options, come_from_flags_before_a_file_before_the_environment) {
    const harness::TempFolder folder;
    const std::string file = folder.file("server.toml");
    std::ofstream(file) << "arenas = 2\nplayers = 3\nname = \"From a file\"\n";
    setenv("FTS_ARENAS", "4", 1);
    setenv("FTS_PORT", "1234", 1);
    setenv("FTS_SEED", "5", 1);
    const auto parsed = parse({"--config", file.c_str(), "--port", "4321"});
    unsetenv("FTS_ARENAS");
    unsetenv("FTS_PORT");
    unsetenv("FTS_SEED");
    ASSERT_TRUE(parsed.options);
    EXPECT_EQ(parsed.options->port, 4321);
    EXPECT_EQ(parsed.options->arenas, 2);
    EXPECT_EQ(parsed.options->players_per_arena, 3);
    EXPECT_EQ(parsed.options->seed, 5U);
    EXPECT_EQ(parsed.options->name, "From a file");
}

TEST(Options, are_refused_with_a_usage_code_when_they_make_no_sense) {
    const std::vector<std::vector<const char*>> nonsense = {
        {"--no-such-flag"},        {"--port", "70000"},
        {"--port", "seven"},       {"--arenas", "0"},
        {"--players", "65"},       {"--log-level", "loud"},
        {"--config", "/nowhere"},  {"stray"},
        {"--fidelity", "good"},    {"--fidelity", "0"},
        {"--snapshot-rate", "25"}, {"--snapshot-rate", "0"},
        {"--client-rate", "100"},  {"--client-rate", "nan"},
        {"--fidelity", "1.5"},     {"--fidelity", "nan"}};
    for (const auto& arguments : nonsense) {
        SCOPED_TRACE(arguments[0]);
        const auto parsed = parse(arguments);
        EXPECT_FALSE(parsed.options);
        EXPECT_EQ(parsed.exit_code, kExitUsage);
    }
    EXPECT_EQ(parse({"--help"}).exit_code, 0);
}

TEST(Options, name_how_exact_collisions_are) {
    EXPECT_EQ(parse({}).options->tolerance, physics::kAutoTolerance);
    EXPECT_EQ(parse({"--fidelity", "fast"}).options->tolerance, physics::kFastTolerance);
    EXPECT_EQ(parse({"--fidelity", "exact"}).options->tolerance, physics::kExactTolerance);
    EXPECT_EQ(parse({"--fidelity", "0.003"}).options->tolerance, 0.003);
}

TEST(Options, refuse_a_file_with_a_setting_that_does_not_exist) {
    const harness::TempFolder folder;
    const std::string file = folder.file("server.toml");
    std::ofstream(file) << "prot = 7777\n";
    EXPECT_EQ(parse({"--config", file.c_str()}).exit_code, kExitUsage);
}

ServerReport sample_report() {
    ServerReport report;
    ArenaReport arena;
    arena.level = 3;
    arena.scoreboard = {{.player = 1, .name = "Zoë", .knock_offs = 12, .falls = 2},
                        {.player = 2, .name = "Bartholomew", .knock_offs = 3, .falls = 5}};
    arena.totals.ai_knock_offs = 8;
    arena.audit = {.ball_collisions = 100,
                   .wall_collisions = 0,
                   .worst_energy_error = 2e-16,
                   .worst_momentum_error = 1e-16,
                   .energy_change_j = -1e-13,
                   .energy_seen_j = 1000.0};
    report.arenas = {arena, arena};
    report.arenas[1].arena = 1;
    report.arenas[1].audit.worst_energy_error = 4e-16;
    report.coins = {.minted = 10, .held = 6, .spent = 4, .dropped = 0};
    report.drops = {{"malformed_payload", 3}};
    return report;
}

TEST(Report, takes_the_worst_of_all_arenas_and_the_sum_of_what_adds_up) {
    const auto audit = combined_audit(sample_report());
    EXPECT_EQ(audit.ball_collisions, 200U);
    EXPECT_EQ(audit.worst_energy_error, 4e-16);
    EXPECT_EQ(audit.energy_seen_j, 2000.0);
}

TEST(Report, lines_the_scoreboard_up_whatever_the_names) {
    const std::string text = text_of(sample_report(), {});
    const auto column_of = [&](const std::string& line_with, const std::string& what) {
        const std::size_t at = text.find(line_with);
        const std::size_t begin = text.rfind('\n', at) + 1;
        std::size_t column = 0;
        for (std::size_t i = begin; i < text.find(what, at) + what.size(); ++i) {
            if ((static_cast<unsigned char>(text[i]) & 0xc0U) != 0x80U) ++column;
        }
        return column;
    };
    EXPECT_EQ(column_of("Zoë", " 12"), column_of("Bartholomew", " 3"));
    EXPECT_THAT(text, HasSubstr("10 minted = 6 held + 4 spent + 0 dropped"));
    EXPECT_THAT(text, HasSubstr("4.00e-16"));
}

TEST(Report, shouts_when_the_books_do_not_balance) {
    ServerReport report = sample_report();
    report.coins.held = 5;
    EXPECT_THAT(text_of(report, {}), HasSubstr("IS NOT"));
}

TEST(Report, says_the_same_to_programs) {
    RunFacts run;
    run.tick_durations.record(0.002);
    run.cpu_s = 1.5;
    ServerReport report = sample_report();
    report.late_ticks = 3;
    report.dropped_ticks = 4;
    report.stages[2].record(0.001);
    const auto json = nlohmann::json::parse(json_of(report, run));
    EXPECT_EQ(json["arenas"][0]["scoreboard"][0]["name"], "Zoë");
    EXPECT_EQ(json["knock_offs"], 2 * (8 + 7));
    EXPECT_EQ(json["coins"]["balanced"], true);
    EXPECT_EQ(json["drops"]["malformed_payload"], 3);
    EXPECT_NEAR(json["ticks"]["max_ms"].get<double>(), 2.0, 1e-9);
    EXPECT_EQ(json["ticks"]["missed"], 7);
    EXPECT_EQ(json["cpu_s"], 1.5);
    EXPECT_NEAR(json["stages"]["match"]["max_us"].get<double>(), 1000.0, 1e-9);
    EXPECT_FALSE(json["stages"].contains("send"));
    EXPECT_EQ(json["audit"]["worst_energy_error"], 4e-16);
}

TEST(Report, names_the_file_it_cannot_write) {
    std::string error;
    EXPECT_FALSE(write_report("/no/such/folder/report.json", "{}", error));
    EXPECT_THAT(error, HasSubstr("/no/such/folder/report.json"));
}

}  // namespace
}  // namespace fts::server
