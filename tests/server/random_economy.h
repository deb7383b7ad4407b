// A ledger that lives through a random but repeatable history: players earn, drop, pick up and buy.
// The same seed gives the same transactions, so that a history can be lived through twice.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "server/economy/ledger.h"

namespace fts::server {

inline PlayerKey numbered_key(std::uint8_t number) {
    PlayerKey key{};
    key.fill(number);
    return key;
}

class RandomEconomy {
  public:
    static constexpr std::uint8_t kPlayers = 4;
    static constexpr int kArenas = 2;

    explicit RandomEconomy(std::uint64_t seed) : random_(seed) {
        for (std::uint8_t i = 1; i <= kPlayers; ++i) {
            PlayerRecord record;
            record.key = numbered_key(i);
            ledger_.load(record);
        }
    }

    void step() {
        const PlayerKey player = numbered_key(static_cast<std::uint8_t>(1 + below(kPlayers)));
        const int arena = below(kArenas);
        switch (below(7)) {
            case 0:
            case 1:
                return ledger_.award(player, 1 + below(20), Reason::kKnockOff);
            case 2:
                return ledger_.spawn_on_field(arena, 1 + below(5));
            case 3:
                if (ledger_.field_coins(arena) > 0) ledger_.pick_up(arena, player, 1);
                return;
            case 4:
                return ledger_.drop(player, arena, below(10));
            case 5:
                if (below(10) == 0) ledger_.sweep_field(arena);
                return;
            default: {
                const auto stat = static_cast<game::Stat>(below(game::kStatCount));
                const int tier = ledger_.tiers(player)[static_cast<std::size_t>(stat)];
                ledger_.buy(player, ++request_, stat, tier);
            }
        }
    }

    // Lives on until exactly `size` transactions have happened, and returns them.
    std::vector<Transaction> batch(std::size_t size) {
        while (ledger_.pending_count() < size) step();
        return ledger_.drain_transactions();
    }

    Ledger& ledger() { return ledger_; }

  private:
    template <typename Integer>
    int below(Integer limit) {
        return static_cast<int>(random_() % static_cast<std::uint64_t>(limit));
    }

    std::mt19937_64 random_;
    Ledger ledger_;
    std::uint64_t request_ = 0;
};

}  // namespace fts::server
