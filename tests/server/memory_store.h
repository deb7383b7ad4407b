// A store in memory for tests, which can be told to fail or to take its time. Every member but the
// Store interface may be called from another thread than the one that owns it.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "server/economy/store.h"

namespace fts::server {

// What the store does and holds; outlives the store, so that a test can look at it and a second
// store can carry on with it.
class MemoryDisk {
  public:
    void fail_next(int commits) {
        set([&] { failures_left_ = commits; });
    }
    void fail_always() { fail_next(1 << 30); }
    void work_again() { fail_next(0); }
    void hold_commits() {
        set([&] { held_ = true; });
    }
    void release_commits() {
        set([&] { held_ = false; });
    }
    void put(const PlayerRecord& record) {
        set([&] { players_[record.key] = record; });
    }

    PlayerRecord player(const PlayerKey& key) const {
        const std::lock_guard lock(mutex_);
        const auto found = players_.find(key);
        return found == players_.end() ? fresh(key) : found->second;
    }
    std::vector<std::uint64_t> sequences() const {
        const std::lock_guard lock(mutex_);
        return sequences_;
    }

  private:
    friend class MemoryStore;

    static PlayerRecord fresh(const PlayerKey& key) {
        PlayerRecord record;
        record.key = key;
        return record;
    }
    template <typename Change>
    void set(Change change) {
        {
            const std::lock_guard lock(mutex_);
            change();
        }
        changed_.notify_all();
    }

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    int failures_left_ = 0;
    bool held_ = false;
    std::map<PlayerKey, PlayerRecord> players_;
    std::vector<std::uint64_t> sequences_;
};

class MemoryStore final : public Store {
  public:
    explicit MemoryStore(MemoryDisk& disk) : disk_(disk) {
        for (const auto& [key, record] : disk_.players_) totals_.held += record.coins;
        totals_.minted = totals_.held;
    }

    Loaded load(const PlayerKey& key) override { return {disk_.player(key), {}}; }

    std::optional<std::string> commit(std::span<const Transaction> transactions,
                                      std::span<const Rename> renames) override {
        std::unique_lock lock(disk_.mutex_);
        disk_.changed_.wait(lock, [this] { return !disk_.held_; });
        if (disk_.failures_left_ > 0) {
            --disk_.failures_left_;
            return "the disk is on strike";
        }
        for (const Rename& rename : renames) player(rename.key).name = rename.name;
        for (const Transaction& transaction : transactions) write(transaction);
        return std::nullopt;
    }

    Totals totals_at_open() const override { return totals_; }

  private:
    PlayerRecord& player(const PlayerKey& key) {
        return disk_.players_.try_emplace(key, MemoryDisk::fresh(key)).first->second;
    }
    void write(const Transaction& transaction) {
        disk_.sequences_.push_back(transaction.sequence);
        if (transaction.from.kind == AccountKind::kPlayer) {
            player(transaction.from.player).coins -= transaction.coins;
        }
        if (transaction.to.kind == AccountKind::kPlayer) {
            player(transaction.to.player).coins += transaction.coins;
        }
        if (transaction.reason != Reason::kPurchase) return;
        PlayerRecord& buyer = player(transaction.from.player);
        buyer.tiers[static_cast<std::size_t>(transaction.stat)] = transaction.new_tier;
        buyer.settled_requests.push_back(transaction.request_id);
    }

    MemoryDisk& disk_;
    Totals totals_;
};

}  // namespace fts::server
