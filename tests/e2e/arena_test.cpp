// Whole games between real processes over loopback UDP.
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "client/core/session.h"
#include "common/game/upgrades.h"
#include "common/net/udp_transport.h"
#include "common/replication/snapshot.h"
#include "tests/e2e/arena_process.h"
#include "tests/harness/clock.h"

namespace fts::e2e {
namespace {

constexpr double kRoundOff = 1e-12;

double total(const BotRun& run, const std::string& metric) {
    return run.report.at("total").at(metric).get<double>();
}

void expect_conserved(const nlohmann::json& report) {
    const auto& audit = report.at("audit");
    EXPECT_LE(audit.at("worst_energy_error").get<double>(), kRoundOff);
    EXPECT_LE(audit.at("worst_momentum_error").get<double>(), kRoundOff);
    EXPECT_TRUE(report.at("coins").at("balanced").get<bool>()) << report.at("coins");
    EXPECT_EQ(report.at("ticks").at("event_budget_overruns"), 0);
    EXPECT_EQ(report.at("store_failures"), 0);
    EXPECT_EQ(report.at("unwritten_transactions"), 0);
}

TEST(Arena, BotsJoinAndPlayALevelToItsEnd) {
    const harness::TempFolder data;
    ServerProcess server(data.path());
    const BotRun run =
        run_bots(server.address(), {"--bots", "4", "--seconds", "600", "--pilot", "chaser"}, R"({
            "until": {"levels_cleared": 1},
            "expect": [{"what": "joined", "at_least": 4},
                       {"what": "levels_cleared", "at_least": 1},
                       {"what": "knock_offs", "at_least": 1},
                       {"what": "coins", "at_least": 6},
                       {"what": "hits_malformed", "at_most": 0},
                       {"what": "malformed", "at_most": 0}]})",
                 900.0);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    ASSERT_TRUE(run.report.is_object()) << run.output;
    EXPECT_LE(total(run, "worst_energy_error"), kRoundOff);
    EXPECT_LE(total(run, "worst_momentum_error"), kRoundOff);

    const nlohmann::json report = server.stop();
    expect_conserved(report);
    EXPECT_GE(report.at("arenas").at(0).at("levels_cleared").get<int>(), 1);
    EXPECT_GE(report.at("audit").at("ball_collisions").get<int>(), 1);
}

TEST(Arena, CoinsSurviveARestartOfTheServer) {
    const harness::TempFolder data;
    const harness::TempFolder bots;
    const std::vector<std::string> same_players = {"--bots",    "2",       "--data",
                                                   bots.path(), "--pilot", "chaser"};
    auto arguments = same_players;
    arguments.insert(arguments.end(), {"--seconds", "400"});
    double earned = 0.0;
    {
        ServerProcess server(data.path());
        const BotRun run = run_bots(server.address(), arguments,
                                    R"({"auto_shop": false, "until": {"coins": 6}})", 600.0);
        ASSERT_EQ(run.exit_code, 0) << run.output;
        const nlohmann::json report = server.stop();
        expect_conserved(report);
        earned = report.at("coins").at("held").get<double>();
        EXPECT_GE(earned, 6.0);
    }
    ServerProcess server(data.path());
    arguments = same_players;
    arguments.insert(arguments.end(), {"--seconds", "200"});
    const BotRun run = run_bots(
        server.address(), arguments,
        R"({"auto_shop": false, "until": {"coins": )" + std::to_string(earned) +
            R"(}, "expect": [{"what": "coins", "at_least": )" + std::to_string(earned) + "}]}",
        400.0);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const nlohmann::json report = server.stop();
    expect_conserved(report);
    EXPECT_GE(report.at("coins").at("held").get<double>(), earned);
}

// The velocity that equations (18) to (21) give to the own ball along the line of centres.
double predicted_normal_speed_mps(const replication::CollisionReport& hit, double own_mass_kg) {
    const double own = hit.own.velocity_before_mps.dot(hit.normal);
    const double other = hit.other.velocity_before_mps.dot(hit.normal);
    return ((own_mass_kg - hit.other.mass_kg) * own + 2.0 * hit.other.mass_kg * other) /
           (own_mass_kg + hit.other.mass_kg);
}

// Joins as the player whose key is at `key_file`, drives into the nearest ball and returns the hit.
std::optional<replication::CollisionReport> next_hit_of(const std::string& address,
                                                        const std::string& key_file) {
    std::string error;
    const auto key = net::load_or_create_key_pair(key_file, error);
    const auto server = net::resolve(address, 0).address;
    const auto transport = net::UdpTransport::open("127.0.0.1", 0, error);
    if (!key || !server || !transport) {
        ADD_FAILURE() << error;
        return std::nullopt;
    }
    client::SessionConfig config;
    config.name = "heavier";
    config.key = *key;
    config.server = *server;
    client::Session session(config, *transport);
    std::optional<replication::CollisionReport> hit;
    const double deadline_s = harness::now_s() + 240.0;
    while (!hit && harness::now_s() < deadline_s) {
        session.update(harness::now_s());
        const client::View view = session.view(harness::now_s());
        if (view.own_ball) {
            const client::BallView& own = view.balls[*view.own_ball];
            const client::BallView* target = nullptr;
            for (const client::BallView& ball : view.balls) {
                if (ball.is_own) continue;
                const auto distance = [&](const client::BallView& b) {
                    return (b.position_m - own.position_m).norm();
                };
                if (target == nullptr || distance(ball) < distance(*target)) target = &ball;
            }
            if (target != nullptr) {
                session.set_input(game::command_toward(target->position_m - own.position_m));
            }
        }
        for (const client::Notice& notice : session.drain_notices()) {
            if (notice.kind != client::Notice::Kind::kOwnHit) continue;
            hit = std::get<replication::CollisionReport>(notice.message);
        }
        transport->wait_readable(0.005);
    }
    session.leave(harness::now_s());
    return hit;
}

TEST(Arena, ABoughtMassUpgradeChangesTheNextCollisionAsMomentumConservationPredicts) {
    const harness::TempFolder data;
    const harness::TempFolder bots;
    ServerProcess server(data.path());
    const BotRun run = run_bots(
        server.address(),
        {"--bots", "1", "--seconds", "600", "--pilot", "chaser", "--data", bots.path().string()},
        R"({
            "steps": [{"when": "shop", "each_time": true, "do": "buy", "stat": "mass"}],
            "auto_shop": false,
            "until": {"purchases": 1},
            "expect": [{"what": "purchases", "at_least": 1}]})",
        900.0);
    ASSERT_EQ(run.exit_code, 0) << run.output;

    const auto hit = next_hit_of(server.address(), bots.file("bot-0.key"));
    ASSERT_TRUE(hit);
    // 1.12 kg, to the step in which masses travel.
    const double bought_kg = replication::kMassStepKg *
                             replication::quantise(game::stats_for({1, 0, 0, 0, 0, 0}).mass_kg,
                                                   replication::kMassStepKg);
    EXPECT_EQ(hit->own.mass_kg, bought_kg);
    const double after = hit->own.velocity_after_mps.dot(hit->normal);
    EXPECT_NEAR(after, predicted_normal_speed_mps(*hit, bought_kg), 1e-9);
    const double closing_mps =
        (hit->own.velocity_before_mps - hit->other.velocity_before_mps).norm();
    EXPECT_GT(std::abs(after - predicted_normal_speed_mps(*hit, 1.0)), 1e-6 * closing_mps)
        << "the old mass would explain it as well";

    const physics::Vec2d before = hit->own.mass_kg * hit->own.velocity_before_mps +
                                  hit->other.mass_kg * hit->other.velocity_before_mps;
    const physics::Vec2d momentum = hit->own.mass_kg * hit->own.velocity_after_mps +
                                    hit->other.mass_kg * hit->other.velocity_after_mps;
    EXPECT_LE((momentum - before).norm(), kRoundOff * (1.0 + before.norm()));
    expect_conserved(server.stop());
}

TEST(Arena, LossAndDelayAreFeltButNothingBreaks) {
    const harness::TempFolder data;
    ServerProcess server(data.path());
    const BotRun run = run_bots(server.address(),
                                {"--bots", "4", "--seconds", "200", "--pilot", "chaser", "--loss",
                                 "0.05", "--delay-ms", "50", "--jitter-ms", "30", "--seed", "7"},
                                R"({
            "until": {"snapshots": 2000, "hits": 1},
            "expect": [{"what": "joined", "at_least": 4},
                       {"what": "snapshots", "at_least": 2000},
                       {"what": "loss", "at_least": 0.01, "at_most": 0.2},
                       {"what": "rtt_mean_ms", "at_least": 60},
                       {"what": "hits", "at_least": 1},
                       {"what": "malformed", "at_most": 0},
                       {"what": "hits_malformed", "at_most": 0}]})",
                                400.0);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    expect_conserved(server.stop());
}

TEST(Arena, SixtyFourBotsForAMinuteLeaveStateAndLedgerRight) {
    const harness::TempFolder data;
    nlohmann::json first;
    {
        ServerProcess server(data.path(), {"--arenas", "4", "--players", "16"});
        const BotRun run =
            run_bots(server.address(), {"--bots", "64", "--seconds", "60", "--pilot", "chaser"},
                     R"({"expect": [{"what": "joined", "at_least": 64},
                                    {"what": "malformed", "at_most": 0},
                                    {"what": "hits_malformed", "at_most": 0},
                                    {"what": "coins", "at_least": 1}]})",
                     400.0);
        EXPECT_EQ(run.exit_code, 0) << run.output;
        first = server.stop();
        expect_conserved(first);
        EXPECT_EQ(first.at("joins"), 64);
        ASSERT_EQ(first.at("arenas").size(), 4U);
        std::size_t players = 0;
        for (const auto& arena : first.at("arenas")) {
            players += arena.at("scoreboard").size();
            EXPECT_GT(arena.at("audit").at("ball_collisions").get<int>(), 0);
        }
        EXPECT_EQ(players, 64U);
        std::cout << "ticks: " << first.at("ticks").dump() << '\n';
    }
    ServerProcess server(data.path());
    const nlohmann::json second = server.stop();
    const auto& before = first.at("coins");
    const auto& after = second.at("coins");
    EXPECT_EQ(after.at("held"), before.at("held"));
    EXPECT_EQ(after.at("spent"), before.at("spent"));
    EXPECT_EQ(after.at("dropped"), 0) << "coins on the field go back to the mint at a restart";
    EXPECT_EQ(after.at("minted").get<int>(),
              before.at("minted").get<int>() - before.at("dropped").get<int>());
}

// Where contact is found late the line of centres is off; what a collision keeps is kept all the
// same.
TEST(Arena, AHostWhoToleratesErrorsIsToldWhatThatMeansAndHitsStillConserve) {
    const harness::TempFolder data;
    ServerProcess server(data.path(), {"--fidelity", "0.3"});
    EXPECT_NE(server.process().output().find("discrete, double"), std::string::npos)
        << server.process().output();
    const BotRun run =
        run_bots(server.address(), {"--bots", "4", "--seconds", "120", "--pilot", "chaser"}, R"({
            "until": {"hits": 20},
            "expect": [{"what": "joined", "at_least": 4}, {"what": "hits", "at_least": 20}]})",
                 300.0);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    ASSERT_TRUE(run.report.is_object()) << run.output;
    EXPECT_LE(total(run, "worst_energy_error"), kRoundOff);
    EXPECT_LE(total(run, "worst_momentum_error"), kRoundOff);
    expect_conserved(server.stop());
}

TEST(Arena, AFullServerSaysSo) {
    const harness::TempFolder data;
    ServerProcess server(data.path(), {"--players", "1"});
    const BotRun run =
        run_bots(server.address(), {"--bots", "2", "--seconds", "10", "--pilot", "idle"},
                 R"({"expect": [{"what": "joined", "at_least": 1, "at_most": 1},
                       {"what": "ended_because", "contains": "full"}]})",
                 200.0);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    server.stop();
}

TEST(Arena, AnotherProtocolVersionIsToldBothVersions) {
    const harness::TempFolder data;
    ServerProcess server(data.path());
    const BotRun run =
        run_bots(server.address(),
                 {"--bots", "1", "--seconds", "6", "--pilot", "idle", "--protocol-version", "999"},
                 R"({"expect": [{"what": "joined", "at_most": 0},
                       {"what": "ended_because", "contains": "999"}]})",
                 200.0);
    ASSERT_TRUE(run.report.is_object()) << run.output;
    const auto reason = run.report.at("bots").at(0).at("ended_because").get<std::string>();
    EXPECT_NE(reason.find("999"), std::string::npos) << reason;
    EXPECT_NE(reason.find(std::to_string(net::kProtocolVersion)), std::string::npos) << reason;
    EXPECT_EQ(total(run, "joined"), 0.0);
    server.stop();
}

TEST(Arena, GarbageIsCountedAndTheGameGoesOn) {
    const harness::TempFolder data;
    ServerProcess server(data.path());
    std::string error;
    const auto transport = net::UdpTransport::open("127.0.0.1", 0, error);
    ASSERT_TRUE(transport) << error;
    const auto to = net::resolve(server.address(), 0).address;
    ASSERT_TRUE(to);
    constexpr int kGarbagePackets = 200;
    for (std::size_t i = 0; i < kGarbagePackets; ++i) {
        std::vector<std::uint8_t> datagram(1 + i * 6);
        for (std::size_t k = 0; k < datagram.size(); ++k) {
            datagram[k] = static_cast<std::uint8_t>(i * 31 + k * 7);
        }
        transport->send(*to, datagram);
    }
    const BotRun run = run_bots(
        server.address(), {"--bots", "2", "--seconds", "30", "--pilot", "chaser"},
        R"({"until": {"snapshots": 200}, "expect": [{"what": "joined", "at_least": 2}]})", 200.0);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const nlohmann::json report = server.stop();
    int drops = 0;
    for (const auto& [reason, count] : report.at("drops").items()) drops += count.get<int>();
    EXPECT_GE(drops, kGarbagePackets / 2) << report.at("drops");
    expect_conserved(report);
}

}  // namespace
}  // namespace fts::e2e
