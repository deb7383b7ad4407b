// Purchases over the network: once, for its price, and durable before the buyer hears of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/server_fixture.h"

namespace fts::server {
namespace {

using Outcome = replication::PurchaseOutcome;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Shop : public ServerTest {
  protected:
    std::optional<Outcome> buy(FakeClient& client, std::uint64_t request, int tier = 0) {
        const std::size_t before = client.heard<replication::PurchaseResult>().size();
        client.say(replication::BuyRequest{request, game::Stat::kMass, tier});
        if (!run_until(
                [&] { return client.heard<replication::PurchaseResult>().size() > before; })) {
            return std::nullopt;
        }
        EXPECT_EQ(client.last<replication::PurchaseResult>()->request_id, request);
        return client.last<replication::PurchaseResult>()->outcome;
    }
    static int mass_tier(const FakeClient& client) {
        return client.last<replication::Wallet>()
            ->tiers[static_cast<std::size_t>(game::Stat::kMass)];
    }
};

TEST_F(Shop, sells_an_upgrade_that_is_there_after_a_restart) {
    const net::KeyPair key = rich_player(100);
    start();
    FakeClient& ada = join("Ada", -1, key);
    ASSERT_TRUE(run_until_shop());
    EXPECT_EQ(buy(ada, 1), Outcome::kBought);
    EXPECT_EQ(buy(ada, 2, 1), Outcome::kBought);
    const std::int64_t left = disk.player(key.public_key).coins;
    EXPECT_EQ(left, 100 - *game::price_coins(0) - *game::price_coins(1));

    restart();
    FakeClient& again = join("Ada", -1, key);
    EXPECT_EQ(again.last<replication::Wallet>()->coins, left);
    EXPECT_EQ(mass_tier(again), 2);
}

TEST_F(Shop, gives_coins_and_upgrades_back_to_a_player_who_left_and_returns) {
    const net::KeyPair key = rich_player(60);
    start();
    FakeClient& ada = join("Ada", -1, key);
    ASSERT_TRUE(run_until_shop());
    ASSERT_EQ(buy(ada, 1), Outcome::kBought);
    ada.leave();
    ASSERT_TRUE(run_until([&] { return server->player_count() == 0; }));
    FakeClient& again = join("Ada", -1, key);
    EXPECT_EQ(again.last<replication::Wallet>()->coins, 60 - *game::price_coins(0));
    EXPECT_EQ(mass_tier(again), 1);
}

TEST_F(Shop, answers_only_when_the_purchase_is_durable) {
    const net::KeyPair key = rich_player(100);
    start();
    FakeClient& ada = join("Ada", -1, key);
    ASSERT_TRUE(run_until_shop());
    disk.hold_commits();
    ada.say(replication::BuyRequest{1, game::Stat::kMass, 0});
    ada.say(replication::BuyRequest{1, game::Stat::kMass, 0});
    run(2.0);
    EXPECT_THAT(ada.heard<replication::PurchaseResult>(), IsEmpty());
    EXPECT_EQ(disk.player(key.public_key).tiers, game::Tiers{});

    disk.release_commits();
    ASSERT_TRUE(run_until([&] { return ada.heard<replication::PurchaseResult>().size() == 2; }));
    EXPECT_EQ(ada.heard<replication::PurchaseResult>()[0].outcome, Outcome::kBought);
    EXPECT_EQ(ada.heard<replication::PurchaseResult>()[1].outcome, Outcome::kAlreadyBought);
    EXPECT_EQ(disk.player(key.public_key).coins, 100 - *game::price_coins(0));
}

TEST_F(Shop, charges_a_repeated_request_once_even_after_a_restart_and_with_the_shop_closed) {
    const net::KeyPair key = rich_player(100);
    start();
    FakeClient& ada = join("Ada", -1, key);
    ASSERT_TRUE(run_until_shop());
    ASSERT_EQ(buy(ada, 7), Outcome::kBought);
    EXPECT_EQ(buy(ada, 7), Outcome::kAlreadyBought);
    restart();
    FakeClient& again = join("Ada", -1, key);
    EXPECT_EQ(buy(again, 7), Outcome::kAlreadyBought);
    EXPECT_EQ(disk.player(key.public_key).coins, 100 - *game::price_coins(0));
}

TEST_F(Shop, refuses_what_cannot_be_bought) {
    const net::KeyPair key = rich_player(*game::price_coins(0) - 1);
    start();
    FakeClient& ada = join("Ada", -1, key);
    EXPECT_EQ(buy(ada, 1), Outcome::kShopClosed);
    ASSERT_TRUE(run_until_shop());
    EXPECT_EQ(buy(ada, 2), Outcome::kTooExpensive);
    EXPECT_EQ(buy(ada, 3, 4), Outcome::kStalePrice);
}

TEST_F(Shop, sells_and_admits_nothing_while_the_ledger_cannot_be_written_and_everything_after) {
    const net::KeyPair key = rich_player(100);
    start();
    FakeClient& ada = join("Ada", -1, key);
    ASSERT_TRUE(run_until_shop());
    disk.fail_always();
    ada.say(replication::BuyRequest{1, game::Stat::kMass, 0});  // finds out
    ASSERT_TRUE(run_until([&] { return server->report().store_failures > 0; }));
    EXPECT_THAT(log, Contains(HasSubstr("cannot be written")));
    EXPECT_EQ(buy(ada, 2), Outcome::kStoreFailed);
    EXPECT_EQ(ada.heard<replication::PurchaseResult>().size(), 1U);

    FakeClient& bob = connect();
    bob.say(replication::JoinRequest{"Bob", -1});
    ASSERT_TRUE(run_until([&] { return bob.last<replication::JoinRefused>().has_value(); }));
    EXPECT_THAT(bob.last<replication::JoinRefused>()->reason, HasSubstr("ledger"));

    disk.work_again();
    ASSERT_TRUE(run_until([&] { return ada.heard<replication::PurchaseResult>().size() == 2; }));
    EXPECT_EQ(ada.last<replication::PurchaseResult>()->request_id, 1U);
    EXPECT_EQ(ada.last<replication::PurchaseResult>()->outcome, Outcome::kBought);
    EXPECT_EQ(disk.player(key.public_key).coins, 100 - *game::price_coins(0));
    join("Bob");
}

TEST_F(Shop, pauses_the_game_when_too_much_waits_to_be_written) {
    config.journal.max_unwritten = 1;
    start();
    FakeClient& ada = join("Ada");  // whose level puts coins on the field
    ASSERT_TRUE(run_until_shop());
    disk.hold_commits();
    ada.say(replication::ReadyRequest{});  // the next level puts coins on the field again
    const auto stands_still = [&] {
        const std::uint64_t before = server->report().ticks;
        for (int i = 0; i < 10; ++i) step();
        return server->report().ticks == before;
    };
    ASSERT_TRUE(run_until(stands_still));
    ASSERT_TRUE(run_until([&] {
        const auto line = ada.last<replication::ChatLine>();
        return line && line->text.find("paused") != std::string::npos;
    }));
    const std::uint64_t ticks = server->report().ticks;
    run(1.0);
    EXPECT_EQ(server->report().ticks, ticks);
    EXPECT_TRUE(ada.is_connected());

    disk.release_commits();
    ASSERT_TRUE(run_until([&] { return server->report().ticks > ticks + 30; }));
    EXPECT_THAT(ada.last<replication::ChatLine>()->text, HasSubstr("goes on"));
}

TEST_F(Shop, says_what_is_lost_when_the_store_fails_to_the_end) {
    config.journal.finish_within_s = 0.01;
    start();
    join("Ada");
    disk.fail_always();
    ASSERT_TRUE(run_until_shop());  // coins of the level went back to the mint
    server->shut_down(now_s, "");
    EXPECT_GT(server->report().unwritten_transactions, 0U);
}

}  // namespace
}  // namespace fts::server
