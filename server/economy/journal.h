// Journal: the thread that owns the store, so that the tick never waits for a disk. The tick thread
// hands over transactions and asks for players' records; it drains what came of it.
//
// Everything happens in the order it was asked for, so a record that is loaded after a commit was
// handed over contains it. A commit that fails is tried again, ever more slowly, until it succeeds:
// the transactions are kept, and `State::failing` says so meanwhile. All members are the tick
// thread's.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "server/economy/store.h"
#include "server/limits.h"

namespace fts::server {

struct JournalConfig {
    std::size_t max_unwritten = kMaxUnwrittenTransactions;
    double first_retry_s = 0.1;     // after a failed commit; doubles with each further failure ...
    double slowest_retry_s = 5.0;   // ... up to this
    double finish_within_s = 10.0;  // how long `finish` keeps trying
};

class Journal {
  public:
    explicit Journal(std::unique_ptr<Store> store, const JournalConfig& config = {});
    ~Journal();  // finishes, if nobody did
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    // False while `max_unwritten` transactions wait to be written.
    bool has_room() const;
    // Sequences ascend from one call to the next. To keep to `has_room` is up to the caller, except
    // at the very end, when everything must be handed over.
    void commit(std::vector<Transaction> transactions, std::vector<Rename> renames);
    // The ticket that its `Loaded` will carry; empty when too many loads are waiting.
    std::optional<std::uint64_t> load(const PlayerKey& key);

    struct Loaded {
        std::uint64_t ticket = 0;
        std::optional<PlayerRecord> record;
        std::string error;  // when there is no record
    };
    struct State {
        std::vector<Loaded> loaded;         // since the last call
        std::uint64_t committed_up_to = 0;  // every transaction up to this sequence is durable
        bool failing = false;               // the newest commit failed and is being tried again
        std::string error;                  // of the newest failure, empty if there never was one
        std::uint64_t failures = 0;         // of all time
    };
    State drain();

    // Writes everything that was handed over and ends the thread. Returns how many transactions
    // could not be written in time; 0 is what everybody hopes for.
    std::size_t finish();

  private:
    struct Load {
        std::uint64_t ticket = 0;
        PlayerKey key{};
    };
    struct Batch {
        std::vector<Transaction> transactions;
        std::vector<Rename> renames;
    };
    using Job = std::variant<Load, Batch>;

    void work();
    std::optional<Job> next_job();
    void perform(const Load& load);
    bool write(const Batch& batch);
    bool may_try_again(double pause_s);

    const std::unique_ptr<Store> store_;  // the worker's
    const JournalConfig config_;

    mutable std::mutex mutex_;  // guards everything below, except worker_
    std::condition_variable wake_;
    std::deque<Job> jobs_;
    std::size_t waiting_loads_ = 0;
    std::size_t unwritten_ = 0;
    std::uint64_t next_ticket_ = 1;
    std::optional<std::chrono::steady_clock::time_point> give_up_at_;  // set by `finish`
    State state_;

    std::thread worker_;
};

}  // namespace fts::server
