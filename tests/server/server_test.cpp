#include "server/server.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/server_fixture.h"

namespace fts::server {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(ServerTest, welcomes_a_player_and_tells_the_present) {
    config.name = "Test arena";
    start();
    FakeClient& ada = join("Ada");
    EXPECT_GT(ada.welcome()->player_id, 0);
    EXPECT_EQ(ada.welcome()->tick_rate_hz, game::kTickRateHz);
    EXPECT_EQ(ada.welcome()->snapshot_rate_hz, game::kSnapshotRateHz);
    EXPECT_EQ(ada.welcome()->server_name, "Test arena");
    EXPECT_TRUE(std::holds_alternative<replication::Welcome>(ada.messages.front()));
    EXPECT_EQ(ada.last<replication::LevelStarted>()->name, "short");
    EXPECT_EQ(ada.last<replication::Roster>()->players.at(0).name, "Ada");
    EXPECT_EQ(ada.last<replication::Wallet>()->coins, 0);
    EXPECT_EQ(server->player_count(), 1U);
}

TEST_F(ServerTest, tells_its_host_once_of_clients_of_another_version_and_of_both_versions) {
    start();
    constexpr std::uint16_t kBefore = net::kProtocolVersion - 1;
    for (int i = 0; i < 3; ++i) {
        const FakeClient& old = dial(net::generate_key_pair(), kBefore);
        run(0.5);
        EXPECT_FALSE(old.is_connected());
    }
    EXPECT_EQ(dropped("wrong_version"), 3U);
    const std::string told = "refused a client of protocol version " + std::to_string(kBefore) +
                             ", where this server speaks version " +
                             std::to_string(net::kProtocolVersion);
    EXPECT_EQ(std::ranges::count_if(log, [&](const auto& line) { return line.starts_with(told); }),
              1);
}

TEST_F(ServerTest, sends_thirty_snapshots_a_second_to_be_replayed_from_what_the_client_holds) {
    start();
    FakeClient& ada = join("Ada");
    const std::uint64_t before = ada.snapshots;
    run(1.0);
    EXPECT_NEAR(static_cast<double>(ada.snapshots - before), 30.0, 1.0);
    EXPECT_GE(ada.replayed, ada.snapshots - 5);
    EXPECT_EQ(ada.snapshot.balls.size(), 2U);
}

TEST_F(ServerTest, shows_a_late_joiner_of_a_crowd_its_own_ball_at_once_and_everything_soon) {
    game::Level crowd = short_level();
    crowd.time_limit_s = 600.0;
    crowd.platform = physics::Disc{80.0};
    crowd.ai = {game::AiGroup{.count = 600}};
    config.levels = {crowd};
    config.client_bytes_per_s = 64000;
    start();
    join("Ada");
    run(6.0);
    FakeClient& bob = connect();
    bob.say(replication::JoinRequest{"Bob", -1});
    ASSERT_TRUE(run_until([&] { return bob.sketches > 0; }));
    EXPECT_EQ(bob.snapshots, 0U) << "more than fits a packet";
    const auto own = std::ranges::find(bob.sketch.balls, bob.welcome()->player_id,
                                       &replication::BallState::player_id);
    EXPECT_NE(own, bob.sketch.balls.end());
    ASSERT_TRUE(run_until([&] { return bob.snapshots > 0; }));
    EXPECT_GT(bob.keyframe_parts, 10U);
    EXPECT_GT(bob.snapshot.balls.size(), 500U);
    const std::uint64_t before = bob.snapshots;
    run(1.0);
    EXPECT_NEAR(static_cast<double>(bob.snapshots - before), 30.0, 2.0);
    EXPECT_EQ(bob.snapshot.balls, clients.front()->snapshot.balls) << "as Ada has it";
}

TEST_F(ServerTest, sends_as_many_snapshots_a_second_as_the_host_chose_and_says_so) {
    for (const int rate_hz : kSnapshotRatesHz) {
        config.snapshot_rate_hz = rate_hz;
        clients.clear();
        start();
        FakeClient& ada = join("Ada");
        EXPECT_EQ(ada.welcome()->snapshot_rate_hz, rate_hz);
        const std::uint64_t before = ada.snapshots;
        run(1.0);
        EXPECT_NEAR(static_cast<double>(ada.snapshots - before), rate_hz, 1.0);
    }
}

TEST_F(ServerTest, times_the_stages_of_each_tick_with_the_clock_it_is_given) {
    double clock_s = 0.0;
    config.stage_clock = [&clock_s] { return clock_s += 1e-6; };
    start();
    join("Ada");
    run(1.0);
    const ServerReport report = server->report();
    for (std::size_t i = 0; i < report.stages.size(); ++i) {
        EXPECT_GT(report.stages[i].mean_s(), 0.0) << kStageNames[i];
        EXPECT_NEAR(static_cast<double>(report.stages[i].count()),
                    static_cast<double>(report.ticks), 1.0);
    }
    EXPECT_GT(report.player_ticks, 59U);
}

TEST_F(ServerTest, acknowledges_the_inputs_it_has_applied) {
    start();
    FakeClient& ada = join("Ada");
    run(0.5);
    EXPECT_GT(ada.acked_input_sequence, 20U);
    EXPECT_LE(ada.acked_input_sequence, ada.input_sequence);
}

TEST_F(ServerTest, cleans_names) {
    start();
    EXPECT_EQ(join("\x1b[31mEve\n").last<replication::Roster>()->players.back().name, "[31mEve");
    EXPECT_THAT(join("\x01 \x02").last<replication::Roster>()->players.back().name,
                HasSubstr("player "));
}

TEST_F(ServerTest, passes_chat_on_cleaned_and_not_too_much_of_it) {
    start();
    FakeClient& ada = join("Ada");
    FakeClient& bob = join("Bob");
    for (int i = 0; i < 10; ++i) ada.say(replication::ChatRequest{"hello\x07 there"});
    run(0.5);
    const auto lines = bob.heard<replication::ChatLine>();
    ASSERT_EQ(lines.size(), static_cast<std::size_t>(kChatBurst));
    EXPECT_EQ(lines[0].text, "hello there");
    EXPECT_EQ(lines[0].player_id, ada.welcome()->player_id);
    EXPECT_EQ(dropped("chat_flood"), 6U);
    std::size_t warnings = 0;
    for (const auto& line : ada.heard<replication::ChatLine>()) {
        if (line.player_id == 0 && line.text.find("too fast") != std::string::npos) ++warnings;
    }
    EXPECT_EQ(warnings, 6U);
}

TEST_F(ServerTest, takes_a_leaver_off_the_arena) {
    start();
    FakeClient& ada = join("Ada");
    FakeClient& bob = join("Bob");
    ada.leave();
    ASSERT_TRUE(run_until([&] { return server->player_count() == 1; }));
    run(0.5);
    EXPECT_EQ(bob.last<replication::Roster>()->players.size(), 1U);
    EXPECT_EQ(bob.snapshot.balls.size(), 2U);
}

TEST_F(ServerTest, frees_the_place_of_a_player_who_falls_silent) {
    start();
    join("Ada");
    clients.clear();
    run(net::kDefaultTimeoutS + 1.0);
    EXPECT_EQ(server->player_count(), 0U);
}

TEST_F(ServerTest, refuses_who_comes_when_it_is_full_and_lets_in_when_a_place_is_free) {
    config.players_per_arena = 1;
    start();
    FakeClient& ada = join("Ada");
    FakeClient& bob = connect();
    bob.say(replication::JoinRequest{"Bob", -1});
    ASSERT_TRUE(run_until([&] { return bob.disconnected.has_value(); }));
    EXPECT_THAT(bob.last<replication::JoinRefused>()->reason, HasSubstr("full"));
    ada.leave();
    ASSERT_TRUE(run_until([&] { return server->player_count() == 0; }));
    join("Bob");
    EXPECT_EQ(server->player_count(), 1U);
}

TEST_F(ServerTest, refuses_an_arena_it_does_not_have) {
    config.arenas = 2;
    start();
    FakeClient& ada = connect();
    ada.say(replication::JoinRequest{"Ada", 2});
    ASSERT_TRUE(run_until([&] { return ada.last<replication::JoinRefused>().has_value(); }));
    EXPECT_THAT(ada.last<replication::JoinRefused>()->reason, HasSubstr("0 to 1"));
}

TEST_F(ServerTest, keeps_arenas_apart) {
    config.arenas = 2;
    start();
    FakeClient& ada = join("Ada", 0);
    FakeClient& bob = join("Bob", 1);
    ada.say(replication::ChatRequest{"anybody here?"});
    run(0.5);
    EXPECT_EQ(ada.welcome()->arena, 0);
    EXPECT_EQ(bob.welcome()->arena, 1);
    EXPECT_EQ(ada.heard<replication::ChatLine>().size(), 1U);
    EXPECT_THAT(bob.heard<replication::ChatLine>(), IsEmpty());
    EXPECT_EQ(ada.snapshot.arena, 0);
    EXPECT_EQ(bob.snapshot.arena, 1);
    EXPECT_EQ(bob.last<replication::Roster>()->players.size(), 1U);
    const ServerReport report = server->report();
    ASSERT_EQ(report.arenas.size(), 2U);
    EXPECT_EQ(report.arenas[0].scoreboard.at(0).name, "Ada");
    EXPECT_EQ(report.arenas[1].scoreboard.at(0).name, "Bob");
}

TEST_F(ServerTest, brings_people_together_unless_they_wish_otherwise) {
    config.arenas = 3;
    start();
    const int arena = join("Ada", 1).welcome()->arena;
    EXPECT_EQ(arena, 1);
    EXPECT_EQ(join("Bob").welcome()->arena, arena);
}

TEST_F(ServerTest, lets_the_newer_session_of_a_player_replace_the_older_one) {
    const net::KeyPair key = rich_player(50);
    start();
    FakeClient& first = join("Ada", -1, key);
    FakeClient& second = join("Ada", -1, key);
    ASSERT_TRUE(run_until([&] { return first.disconnected.has_value(); }));
    EXPECT_EQ(first.disconnected->reason, net::DisconnectReason::kKicked);
    EXPECT_THAT(first.disconnected->detail, HasSubstr("joined again"));
    EXPECT_EQ(second.last<replication::Wallet>()->coins, 50);
    EXPECT_EQ(server->player_count(), 1U);
    run(1.0);
    EXPECT_TRUE(second.is_connected());
}

TEST_F(ServerTest, drops_the_session_that_never_asks_to_join) {
    start();
    FakeClient& idler = connect();
    run(kJoinTimeoutS + 1.0);
    EXPECT_TRUE(idler.disconnected);
    EXPECT_EQ(dropped("never_joined"), 1U);
}

TEST_F(ServerTest, applies_one_input_a_tick_however_many_arrive) {
    start();
    FakeClient& flooder = join("Flooder");
    flooder.sends_inputs = false;
    const std::uint64_t before = server->report().ticks;
    const std::uint32_t first = flooder.acked_input_sequence;
    for (int i = 0; i < 60; ++i) {
        for (int j = 0; j < 20; ++j) flooder.send_input({127, 0, false, true});
        step();
    }
    const std::uint64_t ticks = server->report().ticks - before;
    EXPECT_LE(flooder.acked_input_sequence - first, 20 * ticks);
    EXPECT_GT(dropped("input_flood") + dropped("input_excess"), 900U);
    EXPECT_TRUE(flooder.is_connected());
}

TEST_F(ServerTest, counts_nonsense_and_throws_out_who_sends_much_of_it) {
    start();
    FakeClient& ada = join("Ada");
    FakeClient& fuzzer = join("Fuzzer");
    for (int i = 0; i < kMaxMalformedPayloads - 1; ++i) fuzzer.say_nonsense();
    run(0.5);
    EXPECT_TRUE(fuzzer.is_connected());
    fuzzer.say_nonsense();
    ASSERT_TRUE(run_until([&] { return fuzzer.disconnected.has_value(); }));
    EXPECT_EQ(fuzzer.disconnected->reason, net::DisconnectReason::kKicked);
    EXPECT_EQ(dropped("malformed_payload"), static_cast<std::uint64_t>(kMaxMalformedPayloads));
    EXPECT_TRUE(ada.is_connected());
}

TEST_F(ServerTest, treats_inputs_from_the_far_future_as_nonsense) {
    start();
    FakeClient& ada = join("Ada");
    ada.send({0, 0xfffffff0U, {game::InputCommand{}}});
    ada.send({0, 0, {game::InputCommand{}}});
    run(0.2);
    EXPECT_EQ(dropped("malformed_payload"), 2U);
}

TEST_F(ServerTest, counts_what_comes_before_its_time) {
    start();
    FakeClient& ada = connect();
    ada.say(replication::ReadyRequest{});
    ada.say(replication::BuyRequest{1, game::Stat::kMass, 0});
    ada.send({0, 1, {game::InputCommand{}}});
    run(0.2);
    EXPECT_EQ(dropped("request_out_of_place"), 2U);
    EXPECT_EQ(dropped("input_out_of_place"), 1U);
}

TEST_F(ServerTest, survives_random_bytes_from_an_established_session) {
    std::mt19937_64 random(2013);
    start();
    for (int round = 0; round < 20; ++round) {
        FakeClient& fuzzer = join("Fuzzer");
        for (int i = 0; i < 100 && fuzzer.is_connected(); ++i) {
            std::vector<std::uint8_t> bytes(random() % 64);
            for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
            fuzzer.send_raw(bytes);
            step();
        }
        EXPECT_TRUE(fuzzer.disconnected) << "round " << round;
        clients.clear();
    }
    join("Ada");
    EXPECT_EQ(server->player_count(), 1U);
}

TEST_F(ServerTest, says_goodbye_and_writes_everything_down_when_it_shuts_down) {
    const net::KeyPair key = rich_player(100);
    start();
    FakeClient& ada = join("Ada", -1, key);
    server->shut_down(now_s, "the server is shutting down");
    ada.update(now_s);
    ASSERT_TRUE(ada.disconnected);
    EXPECT_EQ(ada.disconnected->detail, "the server is shutting down");
    const ServerReport report = server->report();
    EXPECT_EQ(report.unwritten_transactions, 0U);
    EXPECT_TRUE(report.coins.balanced());
    EXPECT_EQ(report.coins.dropped, 0);
    EXPECT_EQ(disk.player(key.public_key).name, "Ada");
    EXPECT_EQ(report.arenas[0].scoreboard.at(0).name, "Ada");
}

TEST_F(ServerTest, logs_that_ticks_were_dropped_and_goes_on) {
    start();
    FakeClient& ada = join("Ada");
    now_s += 2.0;
    step();
    EXPECT_GT(server->report().dropped_ticks, 100U);
    EXPECT_THAT(log, Contains(HasSubstr("too slow or busy")));
    run(0.5);
    EXPECT_TRUE(ada.is_connected());
}

}  // namespace
}  // namespace fts::server
