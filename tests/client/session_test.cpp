// A session against a server in memory: joining, snapshots, inputs, messages and every way to end.
// Time is passed in; the network between is simulated.
#include "client/core/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/net/simulated_link.h"
#include "tests/client/fake_server.h"

namespace fts::client {
namespace {

using testing::HasSubstr;

constexpr double kTickS = 1.0 / 60.0;

// One client, one server, and what lies between them.
struct Table {
    explicit Table(const net::LinkConditions& conditions = {}, SessionConfig config = {},
                   const net::ListenerConfig& listener = {})
        : server(network, listener),
          link(std::make_unique<net::MemoryTransport>(network, net::address_of(2)), conditions) {
        config.name = "Ada";
        config.key = net::generate_key_pair();
        config.server = FakeServer::address();
        session.emplace(config, link);
    }

    // `each_tick` runs before the client's update.
    template <typename EachTick>
    void run(double seconds, EachTick each_tick) {
        const double end_s = now_s + seconds;
        for (; now_s < end_s; now_s += kTickS) {
            if (server_runs) server.tick(now_s);
            each_tick();
            session->update(now_s + 0.3 * kTickS);
        }
    }
    void run(double seconds) {
        run(seconds, [] {});
    }

    // However long the handshake takes on a bad link.
    void run_until_playing() {
        for (int i = 0; i < 100 && session->status() != Status::kPlaying; ++i) run(0.1);
        ASSERT_EQ(session->status(), Status::kPlaying);
        run(1.0);
    }

    net::MemoryNetwork network;
    FakeServer server;
    net::SimulatedLink link;
    std::optional<Session> session;
    bool server_runs = true;
    double now_s = 50.0;
};

TEST(Session, joins_and_plays) {
    Table table;
    EXPECT_EQ(table.session->status(), Status::kConnecting);
    table.run(1.0);
    EXPECT_EQ(table.session->status(), Status::kPlaying);
    EXPECT_EQ(table.session->server_key(), table.server.key().public_key);
    const auto* join = std::get_if<replication::JoinRequest>(&table.server.received.at(0));
    ASSERT_NE(join, nullptr);
    EXPECT_EQ(join->name, "Ada");
    const View view = table.session->view(table.now_s);
    ASSERT_TRUE(view.own_ball);
    EXPECT_EQ(view.own_player_id, table.server.welcome.player_id);
}

TEST(Session, draws_the_ball_where_it_is_at_the_moment_drawn) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Table table({.loss = 0.1, .delay_s = 0.05, .jitter_s = 0.02, .seed = seed});
        table.run_until_playing();
        double last_s = 0.0;
        table.run(5.0, [&] {
            const View view = table.session->view(table.now_s);
            ASSERT_TRUE(view.own_ball);
            EXPECT_GE(view.server_time_s, last_s);
            last_s = view.server_time_s;
            const auto expected_m = FakeServer::ball_at_m(view.server_time_s);
            EXPECT_LT((view.balls[0].position_m - expected_m).norm(), 2e-3);
        });
    }
}

TEST(Session, acknowledges_snapshots_so_that_deltas_follow_the_keyframe) {
    Table table({.delay_s = 0.03});
    table.run_until_playing();
    table.run(2.0);
    EXPECT_GT(table.session->stats().snapshots_received, 80U);
    EXPECT_EQ(table.session->stats().snapshots_missed, 0U);
    EXPECT_EQ(table.session->stats().snapshots_malformed, 0U);
    EXPECT_LT(table.server.keyframes_sent, 10U);
    EXPECT_GT(table.server.deltas_sent, 75U);
    for (const auto tick : table.server.acked_ticks) {
        EXPECT_TRUE(table.server.sent_ticks.contains(tick)) << tick;
    }
}

TEST(Session, counts_snapshots_that_never_came) {
    Table table;
    table.run(1.0);
    const auto before = table.session->stats().snapshots_missed;
    for (int i = 0; i < 5; ++i) {
        table.server.skip_next_snapshot();
        table.run(0.2);
    }
    EXPECT_EQ(table.session->stats().snapshots_missed, before + 5);
    EXPECT_GT(table.session->view(table.now_s).link.loss, 0.02);
}

TEST(Session, gets_every_input_through_exactly_once_and_in_order_at_30_percent_loss) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Table table(
            {.loss = 0.3, .duplicate = 0.1, .delay_s = 0.04, .jitter_s = 0.02, .seed = seed});
        const auto say_the_tick = [&] {
            // What is sent says in which tick.
            const auto tick = static_cast<int>(table.session->stats().inputs_sent % 100);
            table.session->set_input({static_cast<std::int8_t>(tick), 1, false, false});
        };
        while (table.session->status() == Status::kConnecting ||
               table.session->status() == Status::kJoining) {
            table.run(kTickS, say_the_tick);
        }
        table.run(5.0, say_the_tick);
        ASSERT_EQ(table.session->status(), Status::kPlaying);
        EXPECT_EQ(table.server.sequences_lost, 0U);
        EXPECT_GT(table.server.applied.size(), 200U);
        for (std::size_t i = 0; i < table.server.applied.size(); ++i) {
            ASSERT_EQ(table.server.applied[i].thrust_x, static_cast<int>(i % 100)) << i;
        }
        const auto sent = table.session->stats().inputs_sent;
        EXPECT_LE(sent - table.server.applied.size(), replication::kMaxInputsPerPacket);
    }
}

TEST(Session, sends_one_input_for_each_tick_however_rarely_it_is_updated) {
    Table table;
    table.run(1.0);
    const auto before = table.session->stats().inputs_sent;
    for (int i = 0; i < 40; ++i) {  // a client at 20 frames per second, for two seconds
        for (int tick = 0; tick < 3; ++tick, table.now_s += kTickS) table.server.tick(table.now_s);
        table.session->update(table.now_s);
    }
    EXPECT_NEAR(static_cast<double>(table.session->stats().inputs_sent - before), 120.0, 2.0);
    EXPECT_EQ(table.session->stats().inputs_given_up, 0U);
    EXPECT_EQ(table.session->stats().inputs_skipped, 0U);
}

TEST(Session, does_not_make_up_for_a_long_stall_with_stale_inputs) {
    Table table;
    table.run(1.0);
    const auto before = table.session->stats();
    table.now_s += 2.0;
    table.session->update(table.now_s);
    const auto after = table.session->stats();
    EXPECT_LT(after.inputs_sent - before.inputs_sent, 20U);
    EXPECT_GT(after.inputs_skipped, 100U);
}

TEST(Session, hands_notices_over_in_order_and_once) {
    Table table({.loss = 0.2, .delay_s = 0.02, .seed = 4});
    table.run_until_playing();
    for (int i = 0; i < 50; ++i) {
        table.server.send(replication::ChatLine{1, "line " + std::to_string(i)});
    }
    replication::LevelEnded end;
    end.number = 2;
    table.server.send(end);
    std::vector<Notice> notices;
    table.run(5.0, [&] {
        for (Notice& notice : table.session->drain_notices()) notices.push_back(std::move(notice));
    });
    ASSERT_EQ(notices.size(), 51U);
    for (int i = 0; i < 50; ++i) {
        const auto* line = std::get_if<replication::ChatLine>(&notices[std::size_t(i)].message);
        ASSERT_NE(line, nullptr);
        EXPECT_EQ(line->text, "line " + std::to_string(i));
    }
    EXPECT_EQ(notices.back().kind, Notice::Kind::kLevelEnded);
    EXPECT_EQ(table.session->view(table.now_s).last_level_end->number, 2);
}

TEST(Session, forgets_the_oldest_notices_when_nobody_reads_them_and_counts_them) {
    Table table;
    table.run(1.0);
    for (std::size_t i = 0; i < kMaxPendingNotices + 10; ++i) {
        table.server.send(replication::ChatLine{1, std::to_string(i)});
        if (i % 20 == 0) table.run(0.1);
    }
    table.run(1.0);
    EXPECT_EQ(table.session->stats().notices_dropped, 10U);
    const auto notices = table.session->drain_notices();
    ASSERT_EQ(notices.size(), kMaxPendingNotices);
    EXPECT_EQ(std::get<replication::ChatLine>(notices.front().message).text, "10");
}

TEST(Session, asks_for_the_tier_that_the_player_has_seen_under_an_id_of_its_own) {
    Table table;
    table.run(1.0);
    replication::Wallet wallet;
    wallet.coins = 100;
    wallet.tiers[static_cast<std::size_t>(game::Stat::kThrust)] = 2;
    table.server.send(wallet);
    table.run(0.2);
    const auto first = table.session->buy(game::Stat::kThrust);
    const auto second = table.session->buy(game::Stat::kMass);
    EXPECT_NE(first, second);
    EXPECT_NE(first, 0U);
    table.run(0.2);
    ASSERT_EQ(table.server.received.size(), 3U);
    const auto& thrust = std::get<replication::BuyRequest>(table.server.received[1]);
    EXPECT_EQ(thrust.request_id, first);
    EXPECT_EQ(thrust.stat, game::Stat::kThrust);
    EXPECT_EQ(thrust.tier, 2);
    EXPECT_EQ(std::get<replication::BuyRequest>(table.server.received[2]).tier, 0);
}

TEST(Session, counts_nonsense_and_plays_on) {
    Table table;
    table.run(1.0);
    for (int i = 0; i < 10; ++i) table.server.send_garbage();
    table.run(1.0);
    EXPECT_EQ(table.session->status(), Status::kPlaying);
    EXPECT_EQ(table.session->stats().snapshots_malformed, 10U);
    EXPECT_EQ(table.session->stats().messages_malformed, 10U);
    EXPECT_EQ(table.session->stats().snapshots_missed, 0U);
}

TEST(Session, tells_starved_frames_from_others) {
    Table table;
    table.run(2.0, [&] { table.session->view(table.now_s); });
    EXPECT_FALSE(table.session->view(table.now_s).link.starved);
    table.server_runs = false;
    table.run(1.0, [&] { table.session->view(table.now_s); });
    EXPECT_TRUE(table.session->view(table.now_s).link.starved);
    EXPECT_GT(table.session->stats().frames_starved, 40U);
}

TEST(Session, knows_at_a_glance_how_old_the_newest_snapshot_is) {
    Table table({.delay_s = 0.04});
    table.run_until_playing();
    table.run(3.0, [&] {
        const Glance glance = table.session->glance(table.now_s);
        ASSERT_TRUE(glance.newest);
        // A snapshot that arrives now was sent 40 ms ago, and one in two ticks is sent.
        const double arriving_s = table.server.now_tick * kTickS - 0.04;
        EXPECT_NEAR(glance.newest->tick * kTickS + glance.age_s, arriving_s, 1.5 * kTickS);
        EXPECT_GE(glance.age_s, 0.0);
        EXPECT_LT(glance.age_s, 3.0 * kTickS);
    });
    const SessionStats stats = table.session->stats();
    EXPECT_NEAR(double(stats.frames), 180.0, 2.0);
    EXPECT_LT(stats.frames_starved, 5U);
}

TEST(Session, seldom_starves_and_never_steps_at_5_percent_loss_and_20_ms_jitter) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Table table({.loss = 0.05, .delay_s = 0.035, .jitter_s = 0.02, .seed = seed});
        table.run_until_playing();
        table.run(10.0, [&] { table.session->view(table.now_s); });
        const SessionStats before = table.session->stats();
        double delay_sum_s = 0.0;
        table.run(60.0, [&] {
            delay_sum_s += table.session->view(table.now_s).link.interpolation_delay_s;
        });
        const SessionStats after = table.session->stats();
        const auto frames = static_cast<double>(after.frames - before.frames);
        EXPECT_LT(double(after.frames_starved - before.frames_starved), 0.005 * frames);
        EXPECT_LT(delay_sum_s / frames, 0.11);  // of 30 snapshots a second
        EXPECT_EQ(after.clock_steps, 0U);
    }
}

TEST(Session, says_that_the_moment_drawn_stepped_ahead_after_a_stall) {
    Table table({.delay_s = 0.03});
    table.run_until_playing();
    table.run(2.0, [&] { table.session->view(table.now_s); });
    table.network.is_cut = true;
    table.run(2.0, [&] { table.session->view(table.now_s); });
    table.network.is_cut = false;
    table.run(2.0, [&] { table.session->view(table.now_s); });
    EXPECT_EQ(table.session->status(), Status::kPlaying);
    EXPECT_EQ(table.session->stats().clock_steps, 1U);
    EXPECT_FALSE(table.session->view(table.now_s).link.starved);
}

TEST(Session, sends_later_inputs_when_they_arrive_too_early) {
    const auto sent = [](std::uint8_t input_slack) {
        Table table({.delay_s = 0.02});
        table.server.input_slack = input_slack;
        table.run_until_playing();
        table.run(1.8);
        return static_cast<double>(table.session->stats().inputs_sent);
    };
    constexpr std::uint8_t kRight = 4, kTooEarly = kRight + 5 * 16;
    EXPECT_NEAR(sent(kRight) - sent(kTooEarly), 5.0, 1.0) << "as many ticks later";
}

TEST(Session, counts_ticks_that_found_no_input_of_its_own) {
    Table table;
    table.run(1.0);
    EXPECT_EQ(table.session->stats().inputs_late, 0U);
    EXPECT_GT(table.session->view(table.now_s).link.input_slack_s, 0.0);
    table.server.input_slack = replication::kNoInputWaited;
    table.run(1.0);
    EXPECT_NEAR(double(table.session->stats().inputs_late), 30.0, 1.0);  // snapshots
    EXPECT_EQ(table.session->view(table.now_s).link.input_slack_s, 0.0);
}

// ---- how it ends

TEST(SessionEnd, is_unreachable_when_nothing_ever_answers) {
    Table table;
    table.server_runs = false;
    table.run(10.0);
    EXPECT_EQ(table.session->status(), Status::kEnded);
    EXPECT_EQ(table.session->end_reason(), net::DisconnectReason::kUnreachable);
    EXPECT_THAT(table.session->ended_because(), HasSubstr("No answer from 10.0.0.1:7777"));
}

TEST(SessionEnd, is_a_timeout_when_the_server_falls_silent) {
    Table table;
    table.run(1.0);
    table.server_runs = false;
    table.run(10.0);
    EXPECT_EQ(table.session->end_reason(), net::DisconnectReason::kTimeout);
    EXPECT_THAT(table.session->ended_because(), HasSubstr("nothing arrived"));
}

TEST(SessionEnd, names_both_versions_when_they_differ) {
    SessionConfig config;
    config.protocol_version = 99;
    Table table({}, config);
    table.run(2.0);
    EXPECT_EQ(table.session->end_reason(), net::DisconnectReason::kWrongVersion);
    EXPECT_THAT(table.session->ended_because(), HasSubstr("99"));
    EXPECT_THAT(table.session->ended_because(),
                HasSubstr("version " + std::to_string(net::kProtocolVersion)));
}

TEST(SessionEnd, says_when_the_server_is_full) {
    net::ListenerConfig listener;
    listener.max_connections = 0;
    Table table({}, {}, listener);
    table.run(2.0);
    EXPECT_EQ(table.session->end_reason(), net::DisconnectReason::kServerFull);
    EXPECT_THAT(table.session->ended_because(), HasSubstr("full"));
}

TEST(SessionEnd, refuses_a_server_with_another_key_than_the_pinned_one) {
    SessionConfig config;
    config.pinned_server_key = net::generate_key_pair().public_key;
    Table table({}, config);
    table.run(2.0);
    EXPECT_EQ(table.session->status(), Status::kEnded);
    EXPECT_EQ(table.session->end_reason(), net::DisconnectReason::kKeyChanged);
    EXPECT_TRUE(table.server.received.empty());
}

TEST(SessionEnd, passes_on_why_it_was_not_let_in) {
    Table table;
    table.server.refuse_everybody = true;
    table.run(1.0);
    EXPECT_EQ(table.session->end_reason(), net::DisconnectReason::kRefused);
    EXPECT_THAT(table.session->ended_because(), HasSubstr("we are closed"));
    EXPECT_TRUE(table.server.disconnected);
}

TEST(SessionEnd, passes_on_why_it_was_kicked) {
    Table table;
    table.run(1.0);
    table.server.kick("mind your language");
    table.run(1.0);
    EXPECT_EQ(table.session->end_reason(), net::DisconnectReason::kKicked);
    EXPECT_THAT(table.session->ended_because(), HasSubstr("mind your language"));
}

TEST(SessionEnd, is_no_crash_when_a_server_announces_impossible_rates) {
    Table table;
    table.server.welcome.snapshot_rate_hz = 100000;
    table.run(2.0);
    EXPECT_NE(table.session->status(), Status::kPlaying);
}

TEST(SessionEnd, reaches_the_server_when_the_player_leaves) {
    Table table({.delay_s = 0.05});
    table.run(1.0);
    table.session->leave(table.now_s);
    EXPECT_EQ(table.session->status(), Status::kEnded);
    EXPECT_THAT(table.session->ended_because(), HasSubstr("You left"));
    table.run(0.5);
    ASSERT_TRUE(table.server.disconnected);
    EXPECT_EQ(table.server.disconnected->reason, net::DisconnectReason::kClosed);
}

}  // namespace
}  // namespace fts::client
