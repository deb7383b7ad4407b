#include "server/economy/journal.h"

#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "tests/server/memory_store.h"
#include "tests/server/random_economy.h"

namespace fts::server {
namespace {

constexpr JournalConfig kImpatient{.max_unwritten = 1000,
                                   .first_retry_s = 0.001,
                                   .slowest_retry_s = 0.002,
                                   .finish_within_s = 20.0};

// Drains until `done` says so; the last state, with everything that was loaded meanwhile.
Journal::State wait_until(Journal& journal,
                          const std::function<bool(const Journal::State&)>& done) {
    std::vector<Journal::Loaded> loaded;
    for (;;) {
        Journal::State state = journal.drain();
        loaded.insert(loaded.end(), state.loaded.begin(), state.loaded.end());
        state.loaded = loaded;
        if (done(state)) return state;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void expect_written_once_each(const MemoryDisk& disk, std::uint64_t last) {
    const auto sequences = disk.sequences();
    ASSERT_EQ(sequences.size(), last);
    for (std::uint64_t i = 0; i < last; ++i) EXPECT_EQ(sequences[i], i + 1);
}

TEST(Journal, writes_what_it_is_given_in_order) {
    MemoryDisk disk;
    Journal journal(std::make_unique<MemoryStore>(disk));
    RandomEconomy economy(1);
    for (int i = 0; i < 50; ++i) journal.commit(economy.batch(10), {});
    wait_until(journal, [](const auto& state) { return state.committed_up_to == 500; });
    expect_written_once_each(disk, 500);
    EXPECT_EQ(journal.finish(), 0U);
}

TEST(Journal, loads_a_record_with_all_that_was_handed_over_before) {
    MemoryDisk disk;
    disk.fail_next(3);
    Journal journal(std::make_unique<MemoryStore>(disk), kImpatient);
    RandomEconomy economy(2);
    journal.commit(economy.batch(100), {});
    const auto ticket = journal.load(numbered_key(1));
    ASSERT_TRUE(ticket);
    const auto state =
        wait_until(journal, [](const Journal::State& s) { return !s.loaded.empty(); });
    ASSERT_EQ(state.loaded.size(), 1U);
    EXPECT_EQ(state.loaded[0].ticket, *ticket);
    EXPECT_EQ(state.loaded[0].record->coins, economy.ledger().coins(numbered_key(1)));
}

TEST(Journal, tries_again_until_a_failing_store_recovers) {
    MemoryDisk disk;
    disk.fail_always();
    Journal journal(std::make_unique<MemoryStore>(disk), kImpatient);
    RandomEconomy economy(3);
    journal.commit(economy.batch(20), {});
    const auto failing =
        wait_until(journal, [](const Journal::State& state) { return state.failures >= 3; });
    EXPECT_TRUE(failing.failing);
    EXPECT_EQ(failing.error, "the disk is on strike");
    EXPECT_EQ(failing.committed_up_to, 0U);

    journal.commit(economy.batch(20), {});
    disk.work_again();
    const auto recovered =
        wait_until(journal, [](const auto& state) { return state.committed_up_to == 40; });
    EXPECT_FALSE(recovered.failing);
    expect_written_once_each(disk, 40);
}

TEST(Journal, writes_everything_before_it_finishes) {
    MemoryDisk disk;
    disk.fail_next(4);
    Journal journal(std::make_unique<MemoryStore>(disk), kImpatient);
    RandomEconomy economy(4);
    for (int i = 0; i < 9; ++i) journal.commit(economy.batch(100), {});
    EXPECT_EQ(journal.finish(), 0U);
    expect_written_once_each(disk, 900);
    EXPECT_EQ(journal.drain().committed_up_to, 900U);
}

TEST(Journal, says_how_much_it_could_not_write_when_the_store_never_recovers) {
    MemoryDisk disk;
    disk.fail_always();
    JournalConfig config = kImpatient;
    config.finish_within_s = 0.02;
    Journal journal(std::make_unique<MemoryStore>(disk), config);
    RandomEconomy economy(5);
    journal.commit(economy.batch(30), {});
    EXPECT_EQ(journal.finish(), 30U);
    EXPECT_TRUE(disk.sequences().empty());
}

TEST(Journal, has_no_room_when_too_much_waits_and_room_again_once_it_is_written) {
    MemoryDisk disk;
    disk.hold_commits();
    Journal journal(std::make_unique<MemoryStore>(disk), kImpatient);
    RandomEconomy economy(6);
    int batches = 0;
    while (journal.has_room()) {
        journal.commit(economy.batch(100), {});
        ++batches;
    }
    EXPECT_EQ(batches, 10);
    disk.release_commits();
    wait_until(journal, [](const auto& state) { return state.committed_up_to == 1000; });
    EXPECT_TRUE(journal.has_room());
}

TEST(Journal, survives_a_store_that_fails_at_random_while_it_is_fed_and_drained) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        MemoryDisk disk;
        Journal journal(std::make_unique<MemoryStore>(disk), kImpatient);
        RandomEconomy economy(seed);
        std::mt19937_64 random(seed);
        std::uint64_t committed_up_to = 0;
        for (int i = 0; i < 300; ++i) {
            if (random() % 8 == 0) disk.fail_next(static_cast<int>(random() % 3));
            if (journal.has_room()) journal.commit(economy.batch(1 + random() % 5), {});
            if (random() % 4 == 0) journal.load(numbered_key(1));
            const Journal::State state = journal.drain();
            ASSERT_GE(state.committed_up_to, committed_up_to);
            committed_up_to = state.committed_up_to;
        }
        disk.work_again();
        EXPECT_EQ(journal.finish(), 0U);
        expect_written_once_each(disk, journal.drain().committed_up_to);
        EXPECT_EQ(disk.player(numbered_key(1)).coins, economy.ledger().coins(numbered_key(1)));
    }
}

}  // namespace
}  // namespace fts::server
