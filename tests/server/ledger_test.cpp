#include "server/economy/ledger.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/server/random_economy.h"

namespace fts::server {
namespace {

const PlayerKey kAlice = numbered_key(1);

PlayerRecord record_with(std::int64_t coins) {
    PlayerRecord record;
    record.key = kAlice;
    record.coins = coins;
    return record;
}

// A ledger in which Alice holds `coins`.
Ledger ledger_with(std::int64_t coins) {
    Ledger ledger;
    ledger.open({.minted = coins, .held = coins, .spent = 0, .dropped = 0});
    ledger.load(record_with(coins));
    return ledger;
}

TEST(Ledger, is_balanced_and_never_negative_whatever_happens) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomEconomy economy(seed);
        for (int i = 0; i < 2000; ++i) {
            economy.step();
            const Totals totals = economy.ledger().totals();
            std::int64_t held = 0;
            for (std::uint8_t player = 1; player <= RandomEconomy::kPlayers; ++player) {
                const std::int64_t coins = economy.ledger().coins(numbered_key(player));
                ASSERT_GE(coins, 0);
                held += coins;
            }
            ASSERT_EQ(totals.minted, totals.held + totals.spent + totals.dropped);
            ASSERT_EQ(totals.held, held);
            ASSERT_EQ(totals.dropped,
                      economy.ledger().field_coins(0) + economy.ledger().field_coins(1));
            ASSERT_GE(totals.spent, 0);
        }
    }
}

TEST(Ledger, transactions_add_up_to_the_balances_and_are_numbered_without_gaps) {
    RandomEconomy economy(7);
    const auto transactions = economy.batch(3000);
    std::map<Account, std::int64_t> balances;
    std::uint64_t expected = 1;
    for (const Transaction& transaction : transactions) {
        EXPECT_EQ(transaction.sequence, expected++);
        ASSERT_GT(transaction.coins, 0);
        balances[transaction.from] -= transaction.coins;
        balances[transaction.to] += transaction.coins;
    }
    for (std::uint8_t player = 1; player <= RandomEconomy::kPlayers; ++player) {
        const Account purse{AccountKind::kPlayer, numbered_key(player), 0};
        EXPECT_EQ(balances[purse], economy.ledger().coins(numbered_key(player)));
    }
    EXPECT_EQ(-balances[Account{}], economy.ledger().totals().minted);
}

TEST(Ledger, buys_an_upgrade_for_its_price) {
    Ledger ledger = ledger_with(30);
    EXPECT_EQ(ledger.buy(kAlice, 1, game::Stat::kThrust, 0).outcome, BuyOutcome::kBought);
    EXPECT_EQ(ledger.coins(kAlice), 30 - *game::price_coins(0));
    EXPECT_EQ(ledger.tiers(kAlice)[static_cast<std::size_t>(game::Stat::kThrust)], 1);
    EXPECT_EQ(ledger.totals().spent, *game::price_coins(0));
}

TEST(Ledger, charges_a_request_once_however_often_it_comes) {
    Ledger ledger = ledger_with(200);
    const auto first = ledger.buy(kAlice, 99, game::Stat::kMass, 0);
    const std::int64_t left = ledger.coins(kAlice);
    for (int i = 0; i < 5; ++i) {
        const auto again = ledger.buy(kAlice, 99, game::Stat::kMass, 0);
        EXPECT_EQ(again.outcome, BuyOutcome::kAlreadyBought);
        EXPECT_GE(again.sequence, first.sequence);
    }
    EXPECT_EQ(ledger.coins(kAlice), left);
    EXPECT_EQ(ledger.drain_transactions().size(), 1U);
}

TEST(Ledger, knows_a_request_that_was_settled_in_an_earlier_life) {
    Ledger ledger;
    ledger.open({.minted = 500, .held = 500, .spent = 0, .dropped = 0});
    PlayerRecord record = record_with(500);
    record.settled_requests = {42};
    ledger.load(record);
    EXPECT_TRUE(ledger.is_settled(kAlice, 42));
    EXPECT_EQ(ledger.buy(kAlice, 42, game::Stat::kMass, 0).outcome, BuyOutcome::kAlreadyBought);
    EXPECT_EQ(ledger.coins(kAlice), 500);
}

TEST(Ledger, refuses_what_cannot_be_bought_and_changes_nothing) {
    Ledger ledger = ledger_with(13);
    EXPECT_EQ(ledger.buy(kAlice, 1, game::Stat::kMass, 0).outcome, BuyOutcome::kTooExpensive);
    EXPECT_EQ(ledger.buy(kAlice, 2, game::Stat::kMass, 1).outcome, BuyOutcome::kStalePrice);
    EXPECT_EQ(ledger.coins(kAlice), 13);
    EXPECT_TRUE(ledger.drain_transactions().empty());

    ledger.award(kAlice, 1, Reason::kPickUp);
    EXPECT_EQ(ledger.buy(kAlice, 1, game::Stat::kMass, 0).outcome, BuyOutcome::kBought)
        << "a refused request may be asked again";
}

TEST(Ledger, sells_no_tier_beyond_the_last) {
    Ledger ledger = ledger_with(1000);
    for (int tier = 0; tier < game::kMaxTier; ++tier) {
        const auto request = static_cast<std::uint64_t>(tier + 1);
        ASSERT_EQ(ledger.buy(kAlice, request, game::Stat::kDash, tier).outcome,
                  BuyOutcome::kBought);
    }
    EXPECT_EQ(ledger.buy(kAlice, 77, game::Stat::kDash, game::kMaxTier).outcome,
              BuyOutcome::kLastTier);
}

TEST(Ledger, drops_no_more_than_a_player_holds) {
    Ledger ledger = ledger_with(3);
    ledger.drop(kAlice, 0, 10);
    EXPECT_EQ(ledger.coins(kAlice), 0);
    EXPECT_EQ(ledger.field_coins(0), 3);
}

TEST(Ledger, gives_the_coins_of_a_swept_field_back_to_the_mint) {
    Ledger ledger = ledger_with(0);
    ledger.spawn_on_field(0, 5);
    ledger.spawn_on_field(1, 2);
    ledger.sweep_field(0);
    EXPECT_EQ(ledger.field_coins(0), 0);
    EXPECT_EQ(ledger.field_coins(1), 2);
    EXPECT_EQ(ledger.totals().minted, 2);
}

TEST(Ledger, counts_the_coins_of_players_who_are_away) {
    Ledger ledger = ledger_with(40);
    ledger.award(kAlice, 2, Reason::kLevelClear);
    ledger.unload(kAlice);
    EXPECT_FALSE(ledger.is_loaded(kAlice));
    EXPECT_EQ(ledger.totals().held, 42);
    EXPECT_TRUE(ledger.totals().balanced());
}

}  // namespace
}  // namespace fts::server
