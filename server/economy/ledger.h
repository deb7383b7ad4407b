// Every coin, double entry, in memory. Each change is a transaction that moves coins between
// accounts: the mint (where coins come from and unclaimed ones go back to), a player's purse, the
// field of an arena (coins lying on its platform), and the shop. At every instant
//     minted = held + spent + dropped.
//
// The ledger is the tick thread's; it does no I/O. Transactions leave through `drain_transactions`
// to the journal (journal.h), which writes them down. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/game/upgrades.h"
#include "common/net/connection.h"

namespace fts::server {

using PlayerKey = net::PublicKey;

enum class AccountKind : std::uint8_t { kMint = 0, kPlayer = 1, kField = 2, kShop = 3 };
struct Account {
    AccountKind kind = AccountKind::kMint;
    PlayerKey player{};      // kPlayer only
    std::int32_t arena = 0;  // kField only
    friend auto operator<=>(const Account&, const Account&) = default;
};

enum class Reason : std::uint8_t {
    kKnockOff,
    kLevelClear,
    kFieldSpawn,
    kPickUp,
    kDrop,
    kFieldSweep,
    kPurchase,
};

struct Transaction {
    std::uint64_t sequence = 0;  // 1, 2, 3, ... within one run of the server
    Reason reason = Reason::kKnockOff;
    Account from, to;
    int coins = 0;  // > 0
    // With kPurchase: what was bought and under which request.
    std::uint64_t request_id = 0;
    game::Stat stat = game::Stat::kMass;
    std::uint8_t new_tier = 0;
};

// What the store knows of a player.
struct PlayerRecord {
    PlayerKey key{};
    std::string name;
    std::int64_t coins = 0;
    game::Tiers tiers{};
    std::vector<std::uint64_t> settled_requests;
};

struct Totals {
    std::int64_t minted = 0, held = 0, spent = 0, dropped = 0;
    bool balanced() const { return minted == held + spent + dropped; }
};

enum class BuyOutcome : std::uint8_t {
    kBought,
    kAlreadyBought,
    kTooExpensive,
    kLastTier,
    kStalePrice
};

class Ledger {
  public:
    // Takes over what the store held at start, of players that are not (yet) present.
    void open(const Totals& totals);
    // A player's record, before any of the calls below that name the player.
    void load(const PlayerRecord& record);
    // The player left; the record stays in the store once the journal has written everything.
    void unload(const PlayerKey& player);
    bool is_loaded(const PlayerKey& player) const;

    std::int64_t coins(const PlayerKey& player) const;
    const game::Tiers& tiers(const PlayerKey& player) const;

    void award(const PlayerKey& player, int coins, Reason reason);  // mint -> player
    void spawn_on_field(int arena, int coins);                      // mint -> field
    void pick_up(int arena, const PlayerKey& player, int coins);    // field -> player
    void drop(const PlayerKey& player, int arena,
              int coins);         // player -> field, at most what is held
    void sweep_field(int arena);  // field -> mint, all of it
    std::int64_t field_coins(int arena) const;

    // Outcomes are tested in this order: already bought, last tier, stale price, too expensive.
    // Only a purchase settles its request id, so one that was refused may be asked again.
    struct Purchase {
        BuyOutcome outcome = BuyOutcome::kBought;
        // Durable once the journal has passed it. With kBought that of the transaction, with
        // kAlreadyBought one that is not before it; 0 otherwise.
        std::uint64_t sequence = 0;
    };
    Purchase buy(const PlayerKey& player, std::uint64_t request_id, game::Stat stat, int seen_tier);

    bool is_settled(const PlayerKey& player, std::uint64_t request_id) const;

    Totals totals() const;
    // Of the latest transaction; as long as it stays the same nobody's coins or tiers change.
    std::uint64_t last_sequence() const { return next_sequence_ - 1; }
    std::size_t pending_count() const { return pending_.size(); }
    std::vector<Transaction> drain_transactions();

  private:
    struct Purse {
        std::int64_t coins = 0;
        game::Tiers tiers{};
        std::vector<std::uint64_t> settled_requests;
    };
    Purse& purse_of(const PlayerKey& player);
    const Purse& purse_of(const PlayerKey& player) const;
    void post(Transaction transaction);

    std::map<PlayerKey, Purse> purses_;
    std::map<int, std::int64_t> fields_;
    Totals totals_;
    std::uint64_t next_sequence_ = 1;
    std::vector<Transaction> pending_;
};

}  // namespace fts::server
