#include "server/economy/ledger.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace fts::server {

namespace {

Account mint() {
    return Account{};
}

Account purse_account(const PlayerKey& player) {
    return Account{.kind = AccountKind::kPlayer, .player = player, .arena = 0};
}

Account field_account(int arena) {
    return Account{.kind = AccountKind::kField, .player = {}, .arena = arena};
}

Account shop() {
    return Account{.kind = AccountKind::kShop, .player = {}, .arena = 0};
}

bool contains(const std::vector<std::uint64_t>& requests, std::uint64_t request_id) {
    return std::find(requests.begin(), requests.end(), request_id) != requests.end();
}

}  // namespace

void Ledger::open(const Totals& totals) {
    assert(totals.balanced() && totals.dropped == 0);
    assert(purses_.empty() && fields_.empty() && next_sequence_ == 1);
    totals_ = totals;
}

void Ledger::load(const PlayerRecord& record) {
    assert(!is_loaded(record.key));
    assert(record.coins >= 0 && game::valid(record.tiers));
    purses_[record.key] = Purse{record.coins, record.tiers, record.settled_requests};
}

void Ledger::unload(const PlayerKey& player) {
    purses_.erase(player);
}

bool Ledger::is_loaded(const PlayerKey& player) const {
    return purses_.contains(player);
}

Ledger::Purse& Ledger::purse_of(const PlayerKey& player) {
    const auto found = purses_.find(player);
    assert(found != purses_.end());
    return found->second;
}

const Ledger::Purse& Ledger::purse_of(const PlayerKey& player) const {
    const auto found = purses_.find(player);
    assert(found != purses_.end());
    return found->second;
}

std::int64_t Ledger::coins(const PlayerKey& player) const {
    return purse_of(player).coins;
}

const game::Tiers& Ledger::tiers(const PlayerKey& player) const {
    return purse_of(player).tiers;
}

void Ledger::award(const PlayerKey& player, int coins, Reason reason) {
    post({.reason = reason, .from = mint(), .to = purse_account(player), .coins = coins});
}

void Ledger::spawn_on_field(int arena, int coins) {
    post({.reason = Reason::kFieldSpawn,
          .from = mint(),
          .to = field_account(arena),
          .coins = coins});
}

void Ledger::pick_up(int arena, const PlayerKey& player, int coins) {
    post({.reason = Reason::kPickUp,
          .from = field_account(arena),
          .to = purse_account(player),
          .coins = coins});
}

void Ledger::drop(const PlayerKey& player, int arena, int coins) {
    const std::int64_t held = purse_of(player).coins;
    post({.reason = Reason::kDrop,
          .from = purse_account(player),
          .to = field_account(arena),
          .coins = static_cast<int>(std::min<std::int64_t>(coins, held))});
}

void Ledger::sweep_field(int arena) {
    post({.reason = Reason::kFieldSweep,
          .from = field_account(arena),
          .to = mint(),
          .coins = static_cast<int>(field_coins(arena))});
}

std::int64_t Ledger::field_coins(int arena) const {
    const auto found = fields_.find(arena);
    return found == fields_.end() ? 0 : found->second;
}

Ledger::Purchase Ledger::buy(const PlayerKey& player, std::uint64_t request_id, game::Stat stat,
                             int seen_tier) {
    Purse& purse = purse_of(player);
    if (contains(purse.settled_requests, request_id)) {
        return {BuyOutcome::kAlreadyBought, next_sequence_ - 1};
    }
    std::uint8_t& tier = purse.tiers[static_cast<std::size_t>(stat)];
    const std::optional<int> price = game::price_coins(tier);
    if (!price) return {BuyOutcome::kLastTier, 0};
    if (seen_tier != tier) return {BuyOutcome::kStalePrice, 0};
    if (*price > purse.coins) return {BuyOutcome::kTooExpensive, 0};

    ++tier;
    purse.settled_requests.push_back(request_id);
    const std::uint64_t sequence = next_sequence_;
    post({.reason = Reason::kPurchase,
          .from = purse_account(player),
          .to = shop(),
          .coins = *price,
          .request_id = request_id,
          .stat = stat,
          .new_tier = tier});
    return {BuyOutcome::kBought, sequence};
}

bool Ledger::is_settled(const PlayerKey& player, std::uint64_t request_id) const {
    return contains(purse_of(player).settled_requests, request_id);
}

Totals Ledger::totals() const {
    return totals_;
}

std::vector<Transaction> Ledger::drain_transactions() {
    return std::exchange(pending_, {});
}

void Ledger::post(Transaction transaction) {
    assert(transaction.coins >= 0);
    if (transaction.coins == 0) return;

    const auto add = [this](const Account& account, std::int64_t coins) {
        switch (account.kind) {
            case AccountKind::kMint:
                totals_.minted -= coins;
                break;
            case AccountKind::kPlayer: {
                Purse& purse = purse_of(account.player);
                purse.coins += coins;
                totals_.held += coins;
                assert(purse.coins >= 0);
                break;
            }
            case AccountKind::kField: {
                std::int64_t& field = fields_[account.arena];
                field += coins;
                totals_.dropped += coins;
                assert(field >= 0);
                break;
            }
            case AccountKind::kShop:
                totals_.spent += coins;
                break;
        }
    };
    add(transaction.from, -transaction.coins);
    add(transaction.to, transaction.coins);
    assert(totals_.balanced());

    transaction.sequence = next_sequence_++;
    pending_.push_back(std::move(transaction));
}

}  // namespace fts::server
