#include "server/economy/store_sqlite.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/economy/ledger_schema.h"
#include "server/economy/sqlite_database.h"
#include "tests/harness/temp_folder.h"
#include "tests/server/random_economy.h"

namespace fts::server {
namespace {

using ::testing::HasSubstr;

class StoreSqlite : public ::testing::Test {
  protected:
    std::unique_ptr<Store> open() {
        error_.clear();
        auto store = open_sqlite_store(path_, error_);
        EXPECT_EQ(store == nullptr, !error_.empty());
        return store;
    }
    std::string content() const {
        std::ifstream file(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void overwrite(const std::string& bytes) const {
        std::ofstream(path_, std::ios::binary) << bytes;
    }
    void execute(const std::string& sql) const {
        SqliteDatabase database(path_);
        ASSERT_TRUE(database.execute(sql)) << database.message();
    }
    // A ledger with some history in it, closed.
    void live(std::uint64_t seed, std::size_t transactions) {
        RandomEconomy economy(seed);
        auto store = open();
        ASSERT_TRUE(store) << error_;
        ASSERT_EQ(store->commit(economy.batch(transactions), {}), std::nullopt);
    }

    harness::TempFolder folder_;
    std::string path_ = folder_.file("ledger.sqlite3");
    std::string error_;
};

TEST_F(StoreSqlite, has_an_empty_purse_for_a_player_it_never_saw) {
    auto store = open();
    ASSERT_TRUE(store) << error_;
    const auto loaded = store->load(numbered_key(9));
    ASSERT_TRUE(loaded.record) << loaded.error;
    EXPECT_EQ(loaded.record->key, numbered_key(9));
    EXPECT_EQ(loaded.record->coins, 0);
    EXPECT_EQ(loaded.record->tiers, game::Tiers{});
    EXPECT_TRUE(store->totals_at_open().balanced());
}

TEST_F(StoreSqlite, gives_back_after_a_restart_what_the_ledger_held) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::filesystem::remove(path_);
        RandomEconomy economy(seed);
        {
            auto store = open();
            ASSERT_TRUE(store) << error_;
            for (int i = 0; i < 10; ++i) {
                ASSERT_EQ(store->commit(economy.batch(50), {}), std::nullopt);
            }
        }
        auto store = open();
        ASSERT_TRUE(store) << error_;
        for (std::uint8_t i = 1; i <= RandomEconomy::kPlayers; ++i) {
            const auto loaded = store->load(numbered_key(i));
            ASSERT_TRUE(loaded.record) << loaded.error;
            EXPECT_EQ(loaded.record->coins, economy.ledger().coins(numbered_key(i)));
            EXPECT_EQ(loaded.record->tiers, economy.ledger().tiers(numbered_key(i)));
            for (const std::uint64_t request : loaded.record->settled_requests) {
                EXPECT_TRUE(economy.ledger().is_settled(numbered_key(i), request));
            }
        }
        const Totals ours = economy.ledger().totals();
        const Totals stored = store->totals_at_open();
        EXPECT_TRUE(stored.balanced());
        EXPECT_EQ(stored.dropped, 0) << "coins on a field go back to the mint";
        EXPECT_EQ(stored.minted, ours.minted - ours.dropped);
        EXPECT_EQ(stored.held, ours.held);
        EXPECT_EQ(stored.spent, ours.spent);
    }
}

TEST_F(StoreSqlite, keeps_names) {
    {
        auto store = open();
        ASSERT_EQ(store->commit({}, std::vector<Rename>{{numbered_key(1), "Ada"}}), std::nullopt);
        ASSERT_EQ(store->commit({}, std::vector<Rename>{{numbered_key(1), "Ada L."}}),
                  std::nullopt);
    }
    EXPECT_EQ(open()->load(numbered_key(1)).record->name, "Ada L.");
}

TEST_F(StoreSqlite, writes_a_repeated_transaction_once) {
    RandomEconomy economy(3);
    const auto batch = economy.batch(40);
    auto store = open();
    ASSERT_EQ(store->commit(batch, {}), std::nullopt);
    ASSERT_EQ(store->commit(batch, {}), std::nullopt);
    EXPECT_EQ(store->load(numbered_key(1)).record->coins, economy.ledger().coins(numbered_key(1)));
}

TEST_F(StoreSqlite, writes_nothing_of_a_batch_that_breaks_a_rule) {
    auto store = open();
    std::vector<Transaction> batch(2);
    batch[0].sequence = 1;
    batch[0].to = {AccountKind::kPlayer, numbered_key(1), 0};
    batch[0].coins = 5;
    batch[1].sequence = 2;
    batch[1].from = {AccountKind::kPlayer, numbered_key(2), 0};  // who holds nothing
    batch[1].to = {AccountKind::kShop, {}, 0};
    batch[1].coins = 1;
    const auto error = store->commit(batch, {});
    ASSERT_TRUE(error);
    EXPECT_THAT(*error, HasSubstr(path_));
    EXPECT_EQ(store->load(numbered_key(1)).record->coins, 0);

    batch.pop_back();
    EXPECT_EQ(store->commit(batch, {}), std::nullopt) << "the store goes on after a failure";
    EXPECT_EQ(store->load(numbered_key(1)).record->coins, 5);
}

TEST_F(StoreSqlite, keeps_a_second_server_out) {
    auto first = open();
    ASSERT_TRUE(first) << error_;
    EXPECT_FALSE(open());
    EXPECT_THAT(error_, HasSubstr("another server"));
    EXPECT_THAT(error_, HasSubstr(path_));
    first.reset();
    EXPECT_TRUE(open()) << error_;
}

TEST_F(StoreSqlite, names_a_folder_it_cannot_write_to) {
    overwrite("a file, not a folder");
    path_ += "/ledger.sqlite3";
    EXPECT_FALSE(open());
    EXPECT_THAT(error_, HasSubstr(path_));
    EXPECT_THAT(error_, HasSubstr("--data"));
}

TEST_F(StoreSqlite, leaves_a_file_that_is_no_database_as_it_is) {
    const std::string letter(5000, 'x');
    overwrite(letter);
    EXPECT_FALSE(open());
    EXPECT_THAT(error_, HasSubstr(path_));
    EXPECT_THAT(error_, HasSubstr("restore a copy"));
    EXPECT_EQ(content(), letter);
}

TEST_F(StoreSqlite, leaves_a_damaged_ledger_as_it_is) {
    live(1, 500);
    std::string damaged = content();
    ASSERT_GT(damaged.size(), 12000U);
    for (std::size_t i = 4096; i < 12000; ++i) damaged[i] = static_cast<char>(i * 7);
    overwrite(damaged);
    EXPECT_FALSE(open());
    EXPECT_THAT(error_, HasSubstr(path_));
    EXPECT_THAT(error_, HasSubstr("restore a copy"));
    EXPECT_EQ(content(), damaged);
}

TEST_F(StoreSqlite, refuses_a_truncated_ledger) {
    live(1, 500);
    const std::string half = content().substr(0, content().size() / 2);
    overwrite(half);
    EXPECT_FALSE(open());
    EXPECT_THAT(error_, HasSubstr("restore a copy"));
    EXPECT_EQ(content(), half);
}

TEST_F(StoreSqlite, notices_a_purse_that_was_changed_by_hand) {
    live(1, 500);
    execute("UPDATE balances SET coins = coins + 1000 WHERE kind = 1");
    EXPECT_FALSE(open());
    EXPECT_THAT(error_, HasSubstr("not what the journal adds up to"));
}

TEST_F(StoreSqlite, refuses_a_ledger_of_a_newer_server) {
    live(1, 10);
    execute("PRAGMA user_version = " + std::to_string(kLedgerSchemaVersion + 1));
    EXPECT_FALSE(open());
    EXPECT_THAT(error_, HasSubstr("newer server"));
}

TEST_F(StoreSqlite, refuses_a_database_of_another_program) {
    execute("CREATE TABLE recipes (name TEXT)");
    const std::string before = content();
    EXPECT_FALSE(open());
    EXPECT_THAT(error_, HasSubstr("another program"));
    EXPECT_EQ(content(), before);
}

TEST_F(StoreSqlite, can_be_read_by_others_while_a_server_uses_it) {
    auto store = open();
    RandomEconomy economy(5);
    ASSERT_EQ(store->commit(economy.batch(20), {}), std::nullopt);
    SqliteDatabase reader(path_);
    SqliteStatement count(reader, "SELECT count(*) FROM transactions");
    ASSERT_TRUE(count.next()) << reader.message();
    EXPECT_EQ(count.integer(0), 20);
}

}  // namespace
}  // namespace fts::server
