// A bot does what its script says and counts what happens to it.
#include "client/bot/bot.h"

#include <gtest/gtest.h>

#include "tests/client/fake_server.h"

namespace fts::bot {
namespace {

using client::FakeServer;

constexpr double kTickS = 1.0 / 60.0;

struct Stage {
    explicit Stage(const std::string& script_text, const std::string& pilot = "idle")
        : server(network, {}), transport(network, net::address_of(2)) {
        const ParsedScript parsed = parse_script(script_text, "test.json", 1);
        EXPECT_TRUE(parsed.script) << parsed.error;
        script = parsed.script.value_or(Script{});
        BotConfig config;
        config.session.name = "bot-0";
        config.session.key = net::generate_key_pair();
        config.session.server = FakeServer::address();
        config.pilot = pilot;
        bot.emplace(config, script, transport,
                    [this](int, const replication::CollisionReport&) { ++hits_heard; });
    }

    void run(double seconds) {
        for (const double end_s = now_s + seconds; now_s < end_s; now_s += kTickS) {
            server.tick(now_s);
            bot->update(now_s + 0.4 * kTickS);
        }
    }

    template <typename Request>
    std::vector<Request> received() const {
        std::vector<Request> found;
        for (const auto& message : server.received) {
            if (const auto* request = std::get_if<Request>(&message)) found.push_back(*request);
        }
        return found;
    }

    net::MemoryNetwork network;
    FakeServer server;
    net::MemoryTransport transport;
    Script script;
    std::optional<Bot> bot;
    double now_s = 0.0;
    int hits_heard = 0;
};

TEST(Bot, acts_at_the_times_and_moments_of_its_script) {
    Stage stage(R"({"steps": [{"at_s": 1.0, "do": "chat", "text": "one second"},
                              {"when": "joined", "do": "chat", "text": "I am in"},
                              {"at_s": 1.0, "bot": 0, "do": "steer", "x": 0, "y": 1}]})");
    stage.run(0.8);
    ASSERT_EQ(stage.received<replication::ChatRequest>().size(), 1U);
    EXPECT_EQ(stage.received<replication::ChatRequest>()[0].text, "I am in");
    stage.run(1.0);
    ASSERT_EQ(stage.received<replication::ChatRequest>().size(), 2U);
    EXPECT_EQ(stage.server.applied.back(), (game::InputCommand{0, 127, false, false}));
    EXPECT_TRUE(stage.bot->tally().joined);
}

TEST(Bot, comes_back_as_the_same_player) {
    Stage stage(R"({"steps": [{"at_s": 1.0, "do": "leave"}, {"at_s": 2.0, "do": "join"}]})");
    stage.run(1.5);
    EXPECT_FALSE(stage.bot->finished());
    EXPECT_FALSE(stage.bot->tally().ended_because.empty());
    const auto counted = stage.bot->tally().session.snapshots_received;
    EXPECT_GT(counted, 10U);
    stage.run(2.0);
    EXPECT_TRUE(stage.bot->tally().ended_because.empty());
    EXPECT_EQ(stage.received<replication::JoinRequest>().size(), 2U);
    EXPECT_GT(stage.bot->tally().session.snapshots_received, counted + 20);
}

TEST(Bot, is_finished_once_nothing_will_bring_it_back) {
    Stage stage(R"({"steps": [{"at_s": 1.0, "do": "leave"}]})");
    stage.run(0.9);
    EXPECT_FALSE(stage.bot->finished());
    stage.run(0.5);
    EXPECT_TRUE(stage.bot->finished());
}

TEST(Bot, is_not_finished_while_its_end_sets_a_step_off_but_retires_for_good) {
    Stage stage(R"({"steps": [{"at_s": 1.0, "do": "leave"},
                              {"when": "ended", "each_time": true, "after_s": 0.2, "do": "join"}]})");
    for (int i = 0; i < 180; ++i) {
        stage.run(kTickS);
        ASSERT_FALSE(stage.bot->finished()) << "tick " << i;
    }
    EXPECT_EQ(stage.received<replication::JoinRequest>().size(), 2U);
    stage.bot->retire(stage.now_s);
    stage.run(1.0);
    EXPECT_EQ(stage.received<replication::JoinRequest>().size(), 2U);
    EXPECT_TRUE(stage.server.disconnected);
}

TEST(Bot, buys_what_its_pilot_wants_one_by_one_and_then_is_ready) {
    Stage stage("{}", "chaser");
    stage.run(1.0);
    replication::Wallet wallet;
    wallet.coins = 30;
    stage.server.send(wallet);
    stage.run(0.2);
    stage.server.phase = game::Phase::kShop;
    stage.run(1.0);
    auto bought = stage.received<replication::BuyRequest>();
    ASSERT_EQ(bought.size(), 1U);  // waits for the answer
    EXPECT_TRUE(stage.received<replication::ReadyRequest>().empty());
    wallet.coins = 16;
    wallet.tiers[static_cast<std::size_t>(bought[0].stat)] = 1;
    stage.server.send(wallet);
    stage.server.send(replication::PurchaseResult{bought[0].request_id, {}});
    stage.run(1.0);
    bought = stage.received<replication::BuyRequest>();
    ASSERT_EQ(bought.size(), 2U);
    EXPECT_NE(bought[1].stat, bought[0].stat);
    wallet.coins = 2;
    wallet.tiers[static_cast<std::size_t>(bought[1].stat)] = 1;
    stage.server.send(wallet);
    stage.server.send(replication::PurchaseResult{bought[1].request_id, {}});
    stage.run(1.0);
    EXPECT_EQ(stage.received<replication::BuyRequest>().size(), 2U);
    EXPECT_EQ(stage.received<replication::ReadyRequest>().size(), 1U);
    EXPECT_EQ(stage.bot->tally().purchases, 2);
    EXPECT_EQ(stage.bot->tally().coins_spent, 28);
}

TEST(Bot, does_not_ask_for_ever_for_what_it_is_refused) {
    Stage stage("{}", "chaser");
    stage.run(1.0);
    replication::Wallet wallet;
    wallet.coins = 30;
    stage.server.send(wallet);
    stage.server.phase = game::Phase::kShop;
    for (int i = 0; i < 10; ++i) {
        stage.run(0.5);
        const auto asked = stage.received<replication::BuyRequest>();
        if (asked.empty()) continue;
        stage.server.send(replication::PurchaseResult{asked.back().request_id,
                                                      replication::PurchaseOutcome::kStoreFailed});
    }
    EXPECT_EQ(stage.received<replication::BuyRequest>().size(), 1U);
    EXPECT_EQ(stage.received<replication::ReadyRequest>().size(), 1U);
}

TEST(Bot, leaves_the_shop_to_its_script_when_told_to) {
    Stage stage(R"({"auto_shop": false, "auto_ready": false,
                    "steps": [{"when": "shop", "after_s": 0.5, "do": "buy", "stat": "dash"}]})",
                "chaser");
    stage.run(1.0);
    replication::Wallet wallet;
    wallet.coins = 100;
    stage.server.send(wallet);
    stage.server.phase = game::Phase::kShop;
    stage.run(2.0);
    const auto bought = stage.received<replication::BuyRequest>();
    ASSERT_EQ(bought.size(), 1U);
    EXPECT_EQ(bought[0].stat, game::Stat::kDash);
    EXPECT_TRUE(stage.received<replication::ReadyRequest>().empty());
}

TEST(Bot, steers_by_the_newest_snapshot_while_the_level_is_played) {
    Stage stage("{}", "defender");
    stage.run(1.0);
    replication::LevelStarted level;
    level.number = 1;
    level.platform = physics::Disc{10.0};
    stage.server.send(level);
    stage.run(1.0);
    const physics::Vec2d ball_m = FakeServer::ball_at_m(stage.server.now_tick * kTickS);
    EXPECT_LT(game::thrust_of(stage.server.applied.back()).dot(ball_m), 0.0) << "inwards";
    stage.server.phase = game::Phase::kCountdown;
    stage.run(0.5);
    EXPECT_EQ(stage.server.applied.back(), game::InputCommand{});
}

TEST(Bot, counts_levels_hits_and_chat) {
    Stage stage("{}");
    stage.run(1.0);
    replication::LevelEnded cleared, lost;
    lost.outcome = replication::LevelOutcome::kTimeUp;
    stage.server.send(cleared);
    stage.server.send(lost);
    stage.server.send(replication::ChatLine{0, "hello"});
    replication::CollisionReport hit;
    hit.own.mass_kg = hit.other.mass_kg = 1.0;
    hit.own.velocity_before_mps = hit.other.velocity_after_mps = {3.0, 0.0};
    hit.own.velocity_after_mps = hit.other.velocity_before_mps = {0.0, 0.0};
    hit.own.position_m = hit.other.position_m = {0.0, 0.0};
    hit.own.radius_m = hit.other.radius_m = 0.5;
    hit.own.ball = 3;
    hit.other.ball = 4;
    hit.tick = 1000;
    hit.normal = {-1.0, 0.0};
    hit.impulse_ns = 3.0;
    stage.server.send(hit);
    stage.run(0.5);
    const Tally& tally = stage.bot->tally();
    EXPECT_EQ(tally.levels_cleared, 1);
    EXPECT_EQ(tally.levels_lost, 1);
    EXPECT_EQ(tally.chat_lines, 1);
    EXPECT_EQ(tally.hits, 1U);
    EXPECT_EQ(stage.hits_heard, 1);
    EXPECT_EQ(tally.worst_energy_error, 0.0);
}

}  // namespace
}  // namespace fts::bot
