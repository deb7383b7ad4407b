#include "server/economy/store_sqlite.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "server/economy/ledger_schema.h"
#include "server/economy/lock_file.h"
#include "server/economy/sqlite_database.h"

namespace fts::server {

namespace {

std::span<const std::uint8_t> key_of(const Account& account) {
    if (account.kind != AccountKind::kPlayer) return {};
    return account.player;
}

class SqliteStore final : public Store {
  public:
    explicit SqliteStore(std::string path) : path_(std::move(path)) {}

    bool open(std::string& error);

    Loaded load(const PlayerKey& key) override;
    std::optional<std::string> commit(std::span<const Transaction> transactions,
                                      std::span<const Rename> renames) override;
    Totals totals_at_open() const override { return totals_at_open_; }

  private:
    struct Statements {
        explicit Statements(SqliteDatabase& database);
        SqliteStatement rename, insert_transaction, open_account, move_coins, set_tier,
            insert_request;
        SqliteStatement player_name, player_coins, player_tiers, player_requests;
    };

    bool lock(std::string& error);
    bool connect(std::string& error);
    bool begin_run();
    bool sweep_fields();
    bool read_totals();
    bool write(std::int64_t sequence, const Transaction& transaction);
    bool move(const Account& account, std::int64_t coins);
    std::string failure() const;

    std::string path_;
    LockFile lock_;
    std::unique_ptr<SqliteDatabase> database_;
    std::unique_ptr<Statements> statements_;
    std::int64_t run_ = 0;
    Totals totals_at_open_;
};

SqliteStore::Statements::Statements(SqliteDatabase& database)
    : rename(database,
             "INSERT INTO players (key, name) VALUES (?, ?)"
             " ON CONFLICT (key) DO UPDATE SET name = excluded.name"),
      insert_transaction(database,
                         "INSERT INTO transactions (run, sequence, reason, from_kind, from_player,"
                         " from_arena, to_kind, to_player, to_arena, coins)"
                         " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
                         " ON CONFLICT (run, sequence) DO NOTHING"),
      open_account(database,
                   "INSERT INTO balances (kind, player, arena, coins) VALUES (?, ?, ?, 0)"
                   " ON CONFLICT (kind, player, arena) DO NOTHING"),
      move_coins(
          database,
          "UPDATE balances SET coins = coins + ? WHERE kind = ? AND player = ? AND arena = ?"),
      set_tier(database,
               "INSERT INTO tiers (player, stat, tier) VALUES (?, ?, ?)"
               " ON CONFLICT (player, stat) DO UPDATE SET tier = excluded.tier"),
      insert_request(database,
                     "INSERT INTO requests (player, request_id, stat, new_tier, run, sequence)"
                     " VALUES (?, ?, ?, ?, ?, ?)"),
      player_name(database, "SELECT name FROM players WHERE key = ?"),
      player_coins(database,
                   "SELECT coins FROM balances WHERE kind = 1 AND player = ? AND arena = 0"),
      player_tiers(database, "SELECT stat, tier FROM tiers WHERE player = ?"),
      player_requests(database,
                      "SELECT request_id FROM requests WHERE player = ? ORDER BY run, sequence") {}

std::string SqliteStore::failure() const {
    return "ledger '" + path_ + "': " + (database_ ? database_->message() : "not open");
}

bool SqliteStore::open(std::string& error) {
    if (!lock(error) || !connect(error)) return false;
    if (!check_ledger_identity(*database_, path_, error) ||
        !check_ledger_integrity(*database_, path_, error) ||
        !migrate_ledger(*database_, path_, error)) {
        return false;
    }
    database_->tidy_on_close(true);
    statements_ = std::make_unique<Statements>(*database_);
    if (!begin_run() || !sweep_fields() || !read_totals()) {
        error = failure() + "; see that the disk is not full and the folder can be written to";
        return false;
    }
    return true;
}

bool SqliteStore::lock(std::string& error) {
    std::string cause;
    switch (lock_.acquire(path_ + "-lock", cause)) {
        case LockFile::Outcome::kHeld:
            return true;
        case LockFile::Outcome::kHeldByAnother:
            error = "another server is using the ledger '" + path_ +
                    "'; stop that one first, or give this one its own folder (--data)";
            return false;
        case LockFile::Outcome::kCannotWrite:
            error = "cannot write to '" + path_ + "-lock' (" + cause +
                    "); choose a data folder this user may write to (--data)";
            return false;
    }
    return false;
}

bool SqliteStore::connect(std::string& error) {
    database_ = std::make_unique<SqliteDatabase>(path_);
    if (database_->is_open()) return true;
    error = failure() + "; choose a data folder this user may write to (--data)";
    return false;
}

bool SqliteStore::begin_run() {
    if (!database_->execute("INSERT INTO runs DEFAULT VALUES")) return false;
    run_ = database_->last_row_id();
    return true;
}

bool SqliteStore::sweep_fields() {
    std::vector<Transaction> sweeps;
    SqliteStatement fields(*database_,
                           "SELECT arena, coins FROM balances WHERE kind = 2 AND coins > 0");
    while (fields.next()) {
        Transaction sweep;
        sweep.reason = Reason::kFieldSweep;
        sweep.from = {AccountKind::kField, {}, static_cast<std::int32_t>(fields.integer(0))};
        sweep.to = {AccountKind::kMint, {}, 0};
        sweep.coins = static_cast<int>(fields.integer(1));
        sweeps.push_back(sweep);
    }
    if (fields.failed() || !database_->execute("BEGIN IMMEDIATE")) return false;
    std::int64_t sequence = 0;
    for (const Transaction& sweep : sweeps) {
        if (!write(--sequence, sweep)) return false;
    }
    return database_->execute("COMMIT");
}

bool SqliteStore::read_totals() {
    SqliteStatement sums(*database_, "SELECT kind, sum(coins) FROM balances GROUP BY kind");
    while (sums.next()) {
        const std::int64_t coins = sums.integer(1);
        switch (static_cast<AccountKind>(sums.integer(0))) {
            case AccountKind::kMint:
                totals_at_open_.minted = -coins;
                break;
            case AccountKind::kPlayer:
                totals_at_open_.held = coins;
                break;
            case AccountKind::kField:
                totals_at_open_.dropped = coins;
                break;
            case AccountKind::kShop:
                totals_at_open_.spent = coins;
                break;
        }
    }
    return !sums.failed();
}

Store::Loaded SqliteStore::load(const PlayerKey& key) {
    PlayerRecord record;
    record.key = key;
    Statements& sql = *statements_;

    sql.player_name.start().bind(std::span<const std::uint8_t>(key));
    while (sql.player_name.next()) record.name = sql.player_name.text(0);

    sql.player_coins.start().bind(std::span<const std::uint8_t>(key));
    while (sql.player_coins.next()) record.coins = sql.player_coins.integer(0);

    sql.player_tiers.start().bind(std::span<const std::uint8_t>(key));
    while (sql.player_tiers.next()) {
        record.tiers[static_cast<std::size_t>(sql.player_tiers.integer(0))] =
            static_cast<std::uint8_t>(sql.player_tiers.integer(1));
    }

    sql.player_requests.start().bind(std::span<const std::uint8_t>(key));
    while (sql.player_requests.next()) {
        record.settled_requests.push_back(
            static_cast<std::uint64_t>(sql.player_requests.integer(0)));
    }

    if (sql.player_name.failed() || sql.player_coins.failed() || sql.player_tiers.failed() ||
        sql.player_requests.failed()) {
        return {std::nullopt, failure()};
    }
    return {std::move(record), {}};
}

std::optional<std::string> SqliteStore::commit(std::span<const Transaction> transactions,
                                               std::span<const Rename> renames) {
    bool ok = database_->execute("BEGIN IMMEDIATE");
    for (const Rename& rename : renames) {
        ok = ok && statements_->rename.start()
                       .bind(std::span<const std::uint8_t>(rename.key))
                       .bind(rename.name)
                       .run();
    }
    for (const Transaction& transaction : transactions) {
        ok = ok && write(static_cast<std::int64_t>(transaction.sequence), transaction);
    }
    ok = ok && database_->execute("COMMIT");
    if (ok) return std::nullopt;

    std::string error = failure();
    database_->execute("ROLLBACK");
    return error;
}

bool SqliteStore::write(std::int64_t sequence, const Transaction& transaction) {
    const bool inserted = statements_->insert_transaction.start()
                              .bind(run_)
                              .bind(sequence)
                              .bind(static_cast<std::int64_t>(transaction.reason))
                              .bind(static_cast<std::int64_t>(transaction.from.kind))
                              .bind(key_of(transaction.from))
                              .bind(static_cast<std::int64_t>(transaction.from.arena))
                              .bind(static_cast<std::int64_t>(transaction.to.kind))
                              .bind(key_of(transaction.to))
                              .bind(static_cast<std::int64_t>(transaction.to.arena))
                              .bind(static_cast<std::int64_t>(transaction.coins))
                              .run();
    if (!inserted) return false;
    const bool written_before = database_->changed_rows() == 0;
    if (written_before) return true;

    if (!move(transaction.from, -transaction.coins) || !move(transaction.to, transaction.coins)) {
        return false;
    }
    if (transaction.reason != Reason::kPurchase) return true;

    const std::span<const std::uint8_t> buyer = transaction.from.player;
    return statements_->set_tier.start()
               .bind(buyer)
               .bind(static_cast<std::int64_t>(transaction.stat))
               .bind(static_cast<std::int64_t>(transaction.new_tier))
               .run() &&
           statements_->insert_request.start()
               .bind(buyer)
               .bind(static_cast<std::int64_t>(transaction.request_id))
               .bind(static_cast<std::int64_t>(transaction.stat))
               .bind(static_cast<std::int64_t>(transaction.new_tier))
               .bind(run_)
               .bind(sequence)
               .run();
}

bool SqliteStore::move(const Account& account, std::int64_t coins) {
    return statements_->open_account.start()
               .bind(static_cast<std::int64_t>(account.kind))
               .bind(key_of(account))
               .bind(static_cast<std::int64_t>(account.arena))
               .run() &&
           statements_->move_coins.start()
               .bind(coins)
               .bind(static_cast<std::int64_t>(account.kind))
               .bind(key_of(account))
               .bind(static_cast<std::int64_t>(account.arena))
               .run();
}

}  // namespace

std::unique_ptr<Store> open_sqlite_store(const std::string& path, std::string& error) {
    auto store = std::make_unique<SqliteStore>(path);
    if (!store->open(error)) return nullptr;
    return store;
}

}  // namespace fts::server
