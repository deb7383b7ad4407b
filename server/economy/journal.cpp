#include "server/economy/journal.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace fts::server {

namespace {

std::chrono::steady_clock::duration seconds(double value_s) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(value_s));
}

template <typename T>
void append(std::vector<T>& to, std::vector<T>&& more) {
    to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

Journal::Journal(std::unique_ptr<Store> store, const JournalConfig& config)
    : store_(std::move(store)), config_(config), worker_([this] { work(); }) {}

Journal::~Journal() {
    finish();
}

bool Journal::has_room() const {
    const std::lock_guard lock(mutex_);
    return unwritten_ < config_.max_unwritten;
}

void Journal::commit(std::vector<Transaction> transactions, std::vector<Rename> renames) {
    if (transactions.empty() && renames.empty()) return;
    {
        const std::lock_guard lock(mutex_);
        assert(!give_up_at_);
        unwritten_ += transactions.size();
        jobs_.push_back(Batch{std::move(transactions), std::move(renames)});
    }
    wake_.notify_one();
}

std::optional<std::uint64_t> Journal::load(const PlayerKey& key) {
    std::uint64_t ticket = 0;
    {
        const std::lock_guard lock(mutex_);
        if (waiting_loads_ >= kMaxWaitingLoads) return std::nullopt;
        ++waiting_loads_;
        ticket = next_ticket_++;
        jobs_.push_back(Load{ticket, key});
    }
    wake_.notify_one();
    return ticket;
}

Journal::State Journal::drain() {
    const std::lock_guard lock(mutex_);
    State now = state_;
    state_.loaded.clear();
    return now;
}

std::size_t Journal::finish() {
    {
        const std::lock_guard lock(mutex_);
        if (!give_up_at_) {
            give_up_at_ = std::chrono::steady_clock::now() + seconds(config_.finish_within_s);
        }
    }
    wake_.notify_one();
    if (worker_.joinable()) worker_.join();
    return unwritten_;
}

void Journal::work() {
    while (std::optional<Job> job = next_job()) {
        if (const Load* load = std::get_if<Load>(&*job)) {
            perform(*load);
        } else if (!write(std::get<Batch>(*job))) {
            return;
        }
    }
}

// The oldest job; batches that wait one behind the other become one commit. Nothing when finished.
std::optional<Journal::Job> Journal::next_job() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return !jobs_.empty() || give_up_at_; });
    if (jobs_.empty()) return std::nullopt;

    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    Batch* batch = std::get_if<Batch>(&job);
    while (batch && batch->transactions.size() < kMaxTransactionsPerCommit && !jobs_.empty()) {
        Batch* more = std::get_if<Batch>(&jobs_.front());
        if (!more) break;
        append(batch->transactions, std::move(more->transactions));
        append(batch->renames, std::move(more->renames));
        jobs_.pop_front();
    }
    return job;
}

void Journal::perform(const Load& load) {
    Store::Loaded loaded = store_->load(load.key);
    const std::lock_guard lock(mutex_);
    --waiting_loads_;
    state_.loaded.push_back({load.ticket, std::move(loaded.record), std::move(loaded.error)});
}

// Tries until it succeeds; false when time to finish ran out first.
bool Journal::write(const Batch& batch) {
    double pause_s = config_.first_retry_s;
    while (std::optional<std::string> error = store_->commit(batch.transactions, batch.renames)) {
        {
            const std::lock_guard lock(mutex_);
            state_.failing = true;
            state_.error = std::move(*error);
            ++state_.failures;
        }
        if (!may_try_again(pause_s)) return false;
        pause_s = std::min(2.0 * pause_s, config_.slowest_retry_s);
    }
    const std::lock_guard lock(mutex_);
    state_.failing = false;
    unwritten_ -= batch.transactions.size();
    if (!batch.transactions.empty()) {
        state_.committed_up_to = batch.transactions.back().sequence;
    }
    return true;
}

bool Journal::may_try_again(double pause_s) {
    std::unique_lock lock(mutex_);
    const bool was_finishing = give_up_at_.has_value();
    wake_.wait_for(lock, seconds(pause_s), [&] { return give_up_at_ && !was_finishing; });
    return !give_up_at_ || std::chrono::steady_clock::now() < *give_up_at_;
}

}  // namespace fts::server
