// fts-lab replication: what it writes, how it ends, and what our ways of coding promise.
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/lab/replication_study.h"
#include "tests/harness/temp_folder.h"
#include "tests/lab/program.h"

namespace fts::lab {
namespace {

using testing::HasSubstr;

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

TEST(ReplicationStudy, needs_no_more_bits_for_a_thousand_balls_than_was_asked_for) {
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
                                "usable", "encode_us", "decode_us"}) {
            EXPECT_TRUE(row.contains(key)) << key;
        }
        EXPECT_EQ(row["wrong"], 0);
    }
    EXPECT_THAT(content_of(svg_file), HasSubstr("ours, collisions"));
}

TEST(ReplicationCommand, refuses_what_makes_no_sense_in_words) {
    const Ended rate = replication({"--rate", "25"});
    EXPECT_EQ(rate.code, 2);
    EXPECT_THAT(rate.output, HasSubstr("60 over a whole number"));
    const Ended loss = replication({"--loss", "1.5"});
    EXPECT_EQ(loss.code, 2);
    EXPECT_THAT(loss.output, HasSubstr("--loss"));
    EXPECT_EQ(replication({"--json", "-", "--svg", "-"}).code, 1);
}

}  // namespace
}  // namespace fts::lab
