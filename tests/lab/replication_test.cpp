// fts-lab replication: what it writes, how it ends, and what our ways of coding promise.
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/lab/replication_study.h"
#include "server/lab/snapshot_coders.h"
#include "tests/harness/temp_folder.h"
#include "tests/lab/program.h"

namespace fts::lab {
namespace {

using testing::HasSubstr;
using testing::Not;

std::map<std::string, CoderRow> rows_of(const ReplicationRequest& request) {
    const ReplicationStudy study = study_replication(
        request, [] { return true; }, [](std::size_t, std::size_t) {});
    EXPECT_EQ(study.error, "");
    EXPECT_EQ(study.done, study.of);
    std::map<std::string, CoderRow> rows;
    for (const CoderRow& row : study.rows) rows[row.coder] = row;
    return rows;
}

TEST(ReplicationStudy, decodes_every_snapshot_to_what_was_sent_and_shows_none_of_ours_damaged) {
    ReplicationRequest request;
    request.count = 150;
    request.seconds = 13.0;
    request.loss = 0.2;
    const auto rows = rows_of(request);
    EXPECT_EQ(rows.size(), 8U);
    for (const auto& [name, row] : rows) {
        SCOPED_TRACE(name);
        EXPECT_GT(row.decoded, 60U);
        EXPECT_EQ(row.wrong, 0U);
        EXPECT_NEAR(row.bits_per_ball, 8.0 * row.bytes_per_snapshot / 150.0, 1e-9);
        if (!name.starts_with("ours")) continue;
        EXPECT_GT(row.damaged, 5U);
        EXPECT_EQ(row.damaged_shown, 0U);
        EXPECT_NEAR(row.usable, 0.8, 0.05);
    }
}

TEST(ReplicationStudy, takes_under_12_6_and_1_5_bits_a_ball_of_901_the_more_both_ends_know) {
    ReplicationRequest request;
    request.seconds = 11.0;
    const auto rows = rows_of(request);
    EXPECT_NEAR(rows.at("protobuf floats").bits_per_ball, 199.0, 1.0);
    EXPECT_LT(rows.at("ours, collisions").bits_per_ball, 12.0);
    EXPECT_LT(rows.at("ours, the same on the lattice").bits_per_ball, 6.0);
    EXPECT_LT(rows.at("ours, control events only").bits_per_ball, 1.5);
    EXPECT_LT(rows.at("ours, straight lines").bits_per_ball,
              rows.at("the game's delta format").bits_per_ball);
}

TEST(ReplicationStudy, with_another_seed_is_another_arena_that_costs_about_the_same) {
    ReplicationRequest request;
    request.count = 150;
    request.seconds = 12.0;
    const auto rows = rows_of(request);
    request.seed = 2;
    const auto others = rows_of(request);
    for (const auto& [name, row] : rows) {
        SCOPED_TRACE(name);
        if (!name.starts_with("ours")) continue;
        EXPECT_EQ(others.at(name).wrong, 0U);
        EXPECT_NE(others.at(name).bits_per_ball, row.bits_per_ball);
        EXPECT_NEAR(others.at(name).bits_per_ball / row.bits_per_ball, 1.0, 0.3);
    }
}

// A client that hears late must still find its baseline kept, and every snapshot sent against one.
TEST(ReplicationStudy, keeps_what_a_late_acknowledgement_asks_for) {
    ReplicationRequest request;
    request.count = 10;
    request.seconds = 11.2;
    request.rate_hz = 60.0;
    request.delay_ms = 1100.0;
    for (const auto& [name, row] : rows_of(request)) {
        SCOPED_TRACE(name);
        EXPECT_GT(row.decoded, 70U);
        EXPECT_EQ(row.wrong, 0U);
        EXPECT_EQ(row.keyframes, 0U);
    }
}

TEST(ReplicationStudy, says_what_putting_the_state_on_the_lattice_costs) {
    ReplicationRequest request;
    request.count = 150;
    request.seconds = 12.0;
    const ReplicationStudy study = study_replication(
        request, [] { return true; }, [](std::size_t, std::size_t) {});
    EXPECT_NE(study.snapping_energy_per_s, 0.0);
    EXPECT_LT(std::abs(study.snapping_energy_per_s), 0.01);
    EXPECT_THAT(table_of(request, study), HasSubstr("kinetic energy by"));
    EXPECT_THAT(table_of(request, study), Not(HasSubstr("of nothing")));
}

TEST(ReplicationStudy, shows_what_had_to_be_sent_of_nothing) {
    ReplicationRequest request;
    request.count = 10;
    request.seconds = 11.0;
    request.loss = 0.9;
    const ReplicationStudy study = study_replication(
        request, [] { return true; }, [](std::size_t, std::size_t) {});
    EXPECT_GT(study.rows.front().keyframes, 0U);
    EXPECT_THAT(table_of(request, study), HasSubstr("of nothing"));
    for (const CoderRow& row : study.rows) EXPECT_EQ(row.wrong, 0U) << row.coder;
}

// As a live match does.
TEST(SnapshotCoders, lead_on_in_steps_where_too_much_has_happened) {
    std::string error;
    constexpr replication::Tick kTicks = 30;
    auto trace = ArenaTrace::make(2000, 1, kTicks, true, error);
    ASSERT_TRUE(trace) << error;
    std::vector<TraceSnapshot> history;
    for (int i = 0; i < 5; ++i) history.push_back(trace->next());
    const auto coder = std::move(all_coders(kTicks).back());
    const std::vector<Datagram> payloads = coder->encode(history);
    ASSERT_GT(payloads.size(), 1U);
    for (const Datagram& payload : payloads) EXPECT_LE(payload.size(), kMaxDatagramBytes);
    EXPECT_EQ(coder->decode(&history.front(), payloads), history.back().balls);
    EXPECT_FALSE(coder->decode(&history.front(), std::span(payloads).first(1)));
}

// Who has lost the same acknowledgements holds the same snapshot.
TEST(ReplicationStudy, encodes_once_for_all_clients_that_hold_the_same) {
    ReplicationRequest request;
    request.count = 20;
    request.seconds = 12.0;
    request.loss = 0.0;
    for (const auto& [name, row] : rows_of(request)) EXPECT_EQ(row.baselines, 1.0) << name;
    request.loss = 0.05;
    for (const auto& [name, row] : rows_of(request)) {
        EXPECT_GT(row.baselines, 1.5) << name;
        EXPECT_LT(row.baselines, 4.0) << name;
    }
}

Ended replication(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "replication");
    return lab(arguments);
}

TEST(ReplicationCommand, says_everything_to_programs_and_draws_it) {
    harness::TempFolder folder;
    const std::string json_file = folder.file("rows.json"), svg_file = folder.file("rows.svg");
    const Ended ended = replication({"--count", "20", "--seconds", "11", "--rate", "30", "--json",
                                     json_file, "--svg", svg_file});
    ASSERT_EQ(ended.code, 0) << ended.output;
    EXPECT_THAT(ended.output, HasSubstr("ours, control events only"));
    const auto json = nlohmann::json::parse(content_of(json_file), nullptr, false);
    ASSERT_TRUE(json.is_object());
    EXPECT_EQ(json["count"], 20);
    ASSERT_EQ(json["rows"].size(), 8U);
    for (const auto& row : json["rows"]) {
        for (const char* key : {"coder", "bits_per_ball", "bytes_per_snapshot", "datagrams",
                                "usable", "encode_us", "decode_us", "baselines"}) {
            EXPECT_TRUE(row.contains(key)) << key;
        }
        EXPECT_EQ(row["wrong"], 0);
    }
    EXPECT_EQ(json["seed"], 1);
    EXPECT_TRUE(json["snapping_energy_per_s"].is_number());
    EXPECT_EQ(json["rows"][0]["trace"], "free");
    EXPECT_EQ(json["rows"][7]["trace"], "snapped");
    EXPECT_THAT(content_of(svg_file), HasSubstr("ours, collisions"));
}

TEST(ReplicationCommand, refuses_what_makes_no_sense_in_words) {
    const Ended rate = replication({"--rate", "25"});
    EXPECT_EQ(rate.code, 2);
    EXPECT_THAT(rate.output, HasSubstr("60 over a whole number"));
    const Ended loss = replication({"--loss", "1.5"});
    EXPECT_EQ(loss.code, 2);
    EXPECT_THAT(loss.output, HasSubstr("--loss"));
    const Ended delay = replication({"--rate", "1", "--delay-ms", "4100"});
    EXPECT_EQ(delay.code, 2);
    EXPECT_THAT(delay.output, HasSubstr("give a --delay-ms of at most 4000"));
    EXPECT_EQ(replication({"--json", "-", "--svg", "-"}).code, 1);
}

}  // namespace
}  // namespace fts::lab
