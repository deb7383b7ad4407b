// fts-lab interpolation: what it writes, how it ends, and how close to the truth we draw.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/lab/interpolation_study.h"
#include "tests/harness/temp_folder.h"
#include "tests/lab/program.h"

namespace fts::lab {
namespace {

using testing::HasSubstr;

using RowsByWay = std::map<std::pair<std::string, int>, InterpolationRow>;

RowsByWay interpolation_rows(const InterpolationRequest& request) {
    const InterpolationStudy study = study_interpolation(
        request, [] { return true; }, [](std::size_t, std::size_t) {});
    EXPECT_EQ(study.error, "");
    EXPECT_EQ(study.done, study.of);
    RowsByWay rows;
    for (const InterpolationRow& row : study.rows) rows[{row.way, row.rate_hz}] = row;
    return rows;
}

TEST(InterpolationStudy, draws_nearer_to_the_truth_than_a_twentieth_of_a_radius_at_20_hz) {
    const RowsByWay rows = interpolation_rows({.seconds = 11.5});
    EXPECT_LT(rows.at({std::string(kBlindWay), 20}).p99, 0.05);
    EXPECT_LT(rows.at({std::string(kToldWay), 20}).p99, 0.05);
    EXPECT_LT(rows.at({std::string(kLatticeWay), 20}).p99, 0.05);
    EXPECT_GT(rows.at({std::string(kStraightWay), 20}).p99, 0.4);
}

TEST(InterpolationStudy, is_never_worse_than_straight_lines_or_smooth_curves) {
    for (const std::uint64_t seed : {2U, 3U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const RowsByWay rows = interpolation_rows({.count = 300, .seed = seed, .seconds = 13.0});
        EXPECT_EQ(rows.size(), 5U * std::size(kStudyRatesHz));
        for (const auto& [key, row] : rows) {
            SCOPED_TRACE(key.first + " " + std::to_string(key.second));
            EXPECT_GE(row.samples, 300U * 3U * 230U);
            EXPECT_LE(row.mean, row.p99);
            EXPECT_LE(row.p99, row.max);
            if (!key.first.starts_with("ours")) continue;
            const double straight = rows.at({std::string(kStraightWay), key.second}).p99;
            const double smooth = rows.at({std::string(kHermiteWay), key.second}).p99;
            EXPECT_LE(row.p99, std::min(straight, smooth));
        }
    }
}

// What is left is that the next snapshot is rounded: half a step of the lattice each way.
TEST(InterpolationStudy, leaves_nothing_but_rounding_where_nothing_is_unknown) {
    const RowsByWay rows = interpolation_rows({.count = 300, .seconds = 13.0});
    const double rounding = 64.0 / 4096.0 / 0.6211;
    for (const int rate_hz : kStudyRatesHz) {
        EXPECT_LT(rows.at({std::string(kLatticeWay), rate_hz}).max, 1.5 * rounding) << rate_hz;
    }
}

Ended interpolation(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "interpolation");
    return lab(arguments);
}

TEST(InterpolationCommand, says_everything_to_programs_and_draws_it) {
    harness::TempFolder folder;
    const std::string json_file = folder.file("rows.json"), svg_file = folder.file("rows.svg");
    const std::string hit_file = folder.file("hit.svg");
    const Ended ended = interpolation({"--count", "200", "--seconds", "12", "--json", json_file,
                                       "--svg", svg_file, "--hit-svg", hit_file});
    ASSERT_EQ(ended.code, 0) << ended.output;
    EXPECT_THAT(ended.output, HasSubstr("ours, controls unknown"));
    const auto json = nlohmann::json::parse(content_of(json_file), nullptr, false);
    ASSERT_TRUE(json.is_object());
    EXPECT_EQ(json["count"], 200);
    ASSERT_EQ(json["rows"].size(), 20U);
    for (const auto& row : json["rows"]) {
        for (const char* key :
             {"way", "rate_hz", "mean_radii", "p99_radii", "max_radii", "us_per_ball"}) {
            EXPECT_TRUE(row.contains(key)) << key;
        }
    }
    EXPECT_THAT(content_of(svg_file), HasSubstr("ours, controls unknown"));
    EXPECT_THAT(content_of(hit_file), HasSubstr("One hit"));
}

TEST(InterpolationCommand, refuses_what_makes_no_sense_in_words) {
    const Ended seconds = interpolation({"--seconds", "3"});
    EXPECT_EQ(seconds.code, 2);
    EXPECT_THAT(seconds.output, HasSubstr("--seconds"));
    EXPECT_EQ(interpolation({"--json", "-", "--svg", "-"}).code, 1);
    EXPECT_EQ(interpolation({"--hit-svg", "-", "--svg", "-"}).code, 1);
}

}  // namespace
}  // namespace fts::lab
