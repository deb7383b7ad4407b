// Store: where the ledger survives. Holds every player's purse, tiers and settled requests, and the
// journal of all transactions. One implementation keeps them in a SQLite file (store_sqlite.h).
//
// Belongs to one thread at a time: whoever opened it until a Journal takes it over, then the
// Journal's worker. Calls may block on the disk.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "server/economy/ledger.h"

namespace fts::server {

struct Rename {
    PlayerKey key{};
    std::string name;
};

class Store {
  public:
    virtual ~Store() = default;

    struct Loaded {
        std::optional<PlayerRecord> record;
        std::string error;  // when there is no record: what went wrong, for the log
    };
    // A player the store has never seen has a record as well: no coins, no upgrades.
    virtual Loaded load(const PlayerKey& key) = 0;

    // Writes all of it durably or nothing at all. Empty on success, otherwise what went wrong. A
    // transaction whose sequence this run has already written is passed over, so a commit whose
    // answer got lost may be repeated.
    virtual std::optional<std::string> commit(std::span<const Transaction> transactions,
                                              std::span<const Rename> renames) = 0;

    // As they were when the store was opened, after coins that a crash had left on a field went
    // back to the mint: balanced, with nothing dropped.
    virtual Totals totals_at_open() const = 0;
};

}  // namespace fts::server
