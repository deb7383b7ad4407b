// A server that is killed at any moment: what it had acknowledged is there, and nothing is there by
// half.
#include <cstdint>
#include <memory>
#include <random>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "server/economy/sqlite_database.h"
#include "server/economy/store_sqlite.h"
#include "tests/harness/temp_folder.h"
#include "tests/server/random_economy.h"

namespace fts::server {
namespace {

constexpr std::size_t kBatch = 13;

// Commits batch after batch and acknowledges each through `pipe`, until killed.
[[noreturn]] void live_until_killed(const std::string& path, std::uint64_t seed, int pipe) {
    std::string error;
    auto store = open_sqlite_store(path, error);
    if (!store) _exit(1);
    RandomEconomy economy(seed);
    for (std::uint32_t batch = 1;; ++batch) {
        if (store->commit(economy.batch(kBatch), {})) _exit(2);
        if (write(pipe, &batch, sizeof(batch)) != sizeof(batch)) _exit(3);
    }
}

// Starts such a process, kills it `after_us` after its first acknowledgement, and returns how many
// batches it had acknowledged.
std::uint32_t live_and_kill(const std::string& path, std::uint64_t seed, unsigned after_us) {
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0) return 0;
    const pid_t child = fork();
    if (child == 0) live_until_killed(path, seed, pipe_ends[1]);
    close(pipe_ends[1]);

    std::uint32_t acknowledged = 0;
    EXPECT_EQ(read(pipe_ends[0], &acknowledged, sizeof(acknowledged)),
              static_cast<ssize_t>(sizeof(acknowledged)));
    usleep(after_us);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the child ended by itself: " << WEXITSTATUS(status);
    while (read(pipe_ends[0], &acknowledged, sizeof(acknowledged)) > 0) {
    }
    close(pipe_ends[0]);
    return acknowledged;
}

std::size_t transactions_in(const std::string& path) {
    SqliteDatabase database(path);
    SqliteStatement count(database, "SELECT count(*) FROM transactions WHERE sequence > 0");
    EXPECT_TRUE(count.next()) << database.message();
    return static_cast<std::size_t>(count.integer(0));
}

TEST(KilledServer, leaves_a_balanced_ledger_with_everything_it_acknowledged) {
    std::mt19937_64 random(2013);
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const harness::TempFolder folder;
        const std::string path = folder.file("ledger.sqlite3");
        const auto after_us = static_cast<unsigned>(random() % 40'000);
        const std::uint32_t acknowledged = live_and_kill(path, seed, after_us);
        ASSERT_GT(acknowledged, 0U);

        std::string error;
        auto store = open_sqlite_store(path, error);
        ASSERT_TRUE(store) << error;
        const std::size_t written = transactions_in(path);
        EXPECT_EQ(written % kBatch, 0U) << "a batch was written by half";
        ASSERT_GE(written, acknowledged * kBatch) << "something acknowledged was lost";

        RandomEconomy economy(seed);
        for (std::size_t i = 0; i < written / kBatch; ++i) economy.batch(kBatch);
        for (std::uint8_t player = 1; player <= RandomEconomy::kPlayers; ++player) {
            const auto loaded = store->load(numbered_key(player));
            ASSERT_TRUE(loaded.record) << loaded.error;
            EXPECT_EQ(loaded.record->coins, economy.ledger().coins(numbered_key(player)));
            EXPECT_EQ(loaded.record->tiers, economy.ledger().tiers(numbered_key(player)));
        }
        const Totals ours = economy.ledger().totals();
        EXPECT_TRUE(store->totals_at_open().balanced());
        EXPECT_EQ(store->totals_at_open().minted, ours.minted - ours.dropped);
        EXPECT_EQ(store->totals_at_open().spent, ours.spent);
    }
}

}  // namespace
}  // namespace fts::server
