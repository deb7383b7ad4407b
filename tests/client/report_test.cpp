// The report of a run of bots.
#include "client/bot/report.h"

#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fts::bot {
namespace {

using testing::HasSubstr;
using testing::Not;

Report report_of(std::size_t bots) {
    Report report;
    report.seconds = 30.0;
    report.loop_mean_hz = 120.0;
    report.passed = true;
    for (std::size_t i = 0; i < bots; ++i) {
        Tally tally;
        tally.name = "bot-" + std::to_string(i);
        tally.joined = true;
        tally.coins = 7;
        tally.session.snapshots_received = 900;
        tally.session.snapshots_missed = 100;
        tally.session.snapshots_late = 25;
        for (int k = 1; k <= 100; ++k) tally.rtt.add(k * 0.001 - 0.0001);
        report.tallies.push_back(tally);
    }
    return report;
}

double metric(std::string_view name, const std::vector<Tally>& tallies) {
    return metric_named(name)->value(tallies);
}

TEST(Metrics, have_names_of_their_own) {
    std::set<std::string_view> names;
    for (const Metric& each : metrics()) EXPECT_TRUE(names.insert(each.name).second) << each.name;
    EXPECT_EQ(metric_named("glory"), nullptr);
}

TEST(Metrics, are_all_finite_when_nobody_joined) {
    const std::vector<Tally> nobody(2);
    for (const Metric& each : metrics()) EXPECT_EQ(each.value(nobody), 0.0) << each.name;
}

TEST(Metrics, add_up_over_bots) {
    const Report report = report_of(2);
    EXPECT_EQ(metric("joined", report.tallies), 2.0);
    EXPECT_EQ(metric("coins", report.tallies), 14.0);
    EXPECT_DOUBLE_EQ(metric("loss", report.tallies), 75.0 / 1000.0);
    EXPECT_NEAR(metric("rtt_mean_ms", report.tallies), 50.4, 0.01);
    EXPECT_NEAR(metric("rtt_p99_ms", report.tallies), 99.0, 0.26);
}

TEST(Report, lines_its_columns_up) {
    Report report = report_of(3);
    report.tallies[1].name = "b\xc3\xb6t-1";
    report.tallies[2].coins = 123456;
    std::istringstream lines(as_tables(report));
    std::string line;
    std::getline(lines, line);  // the summary
    int tables = 0;
    for (std::size_t width = 0; std::getline(lines, line);) {
        if (line.empty()) {
            width = 0;
            continue;
        }
        std::size_t characters = 0;
        for (const char c : line) characters += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
        if (width == 0) {
            width = characters;
            ++tables;
        }
        EXPECT_EQ(characters, width) << line;
        EXPECT_LE(characters, 120U);
    }
    EXPECT_EQ(tables, 2);
}

TEST(Report, shows_only_the_whole_of_a_crowd) {
    EXPECT_THAT(as_tables(report_of(3)), HasSubstr("bot-2"));
    const std::string crowd = as_tables(report_of(100));
    EXPECT_THAT(crowd, Not(HasSubstr("bot-2")));
    EXPECT_THAT(crowd, HasSubstr("all 100"));
}

TEST(Report, shows_why_instead_of_empty_tables_when_nobody_joined) {
    Report report = report_of(2);
    for (Tally& tally : report.tallies) {
        tally.joined = false;
        tally.ended_because = "No answer.";
    }
    EXPECT_EQ(as_tables(report), "No bot could join.\n\nEnded, 2 bots: No answer.\n");
}

TEST(Report, tells_each_reason_for_an_end_once_with_how_many_it_met) {
    Report report = report_of(3);
    report.tallies[0].ended_because = report.tallies[2].ended_because = "It was full.";
    EXPECT_THAT(as_tables(report), HasSubstr("2 bots: It was full."));
}

TEST(Report, prints_what_was_expected_and_what_was_seen) {
    Report report = report_of(1);
    report.verdicts = {{"coins at least 9", "7", false}};
    EXPECT_THAT(as_tables(report), HasSubstr("NOT MET  coins at least 9; seen 7"));
}

TEST(Report, is_json_with_every_metric_in_total_and_of_each_bot) {
    Report report = report_of(2);
    report.tallies[0].name = "bad \xff utf8";
    report.verdicts = {{"coins at least 9", "7", false}};
    const auto json = nlohmann::json::parse(as_json(report));
    ASSERT_EQ(json.at("bots").size(), 2U);
    for (const Metric& each : metrics()) {
        const std::string name(each.name);
        EXPECT_TRUE(json.at("total").at(name).is_number()) << name;
        EXPECT_TRUE(json.at("bots").at(1).at(name).is_number()) << name;
    }
    EXPECT_EQ(json.at("bots").at(1).at("name"), "bot-1");
    EXPECT_EQ(json.at("expectations").at(0).at("met"), false);
    EXPECT_EQ(json.at("passed"), true);
}

}  // namespace
}  // namespace fts::bot
