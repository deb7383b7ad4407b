#include "server/economy/ledger_schema.h"

#include <array>
#include <cstdint>
#include <optional>

namespace fts::server {

namespace {

// "FTSL" in the file's header tells our ledgers from other SQLite files.
constexpr const char* kSetApplicationId = "PRAGMA application_id = 1179931468";
constexpr std::int64_t kApplicationId = 1179931468;

// Step i brings a file from version i to i + 1.
constexpr std::array<const char*, kLedgerSchemaVersion> kMigrations = {R"sql(
    CREATE TABLE players (
        key BLOB PRIMARY KEY CHECK (length(key) = 32),
        name TEXT NOT NULL DEFAULT '',
        first_seen INTEGER NOT NULL DEFAULT (unixepoch())
    ) WITHOUT ROWID;

    -- kind: 0 mint, 1 player, 2 field, 3 shop. The mint goes below zero by what was minted.
    CREATE TABLE balances (
        kind INTEGER NOT NULL CHECK (kind BETWEEN 0 AND 3),
        player BLOB NOT NULL CHECK (length(player) = CASE kind WHEN 1 THEN 32 ELSE 0 END),
        arena INTEGER NOT NULL,
        coins INTEGER NOT NULL CHECK (kind = 0 OR coins >= 0),
        PRIMARY KEY (kind, player, arena)
    ) WITHOUT ROWID;

    CREATE TABLE tiers (
        player BLOB NOT NULL CHECK (length(player) = 32),
        stat INTEGER NOT NULL CHECK (stat BETWEEN 0 AND 5),
        tier INTEGER NOT NULL CHECK (tier BETWEEN 1 AND 6),
        PRIMARY KEY (player, stat)
    ) WITHOUT ROWID;

    CREATE TABLE runs (
        id INTEGER PRIMARY KEY AUTOINCREMENT,
        opened_at INTEGER NOT NULL DEFAULT (unixepoch())
    );

    -- sequence < 0: written while the file was opened.
    CREATE TABLE transactions (
        run INTEGER NOT NULL REFERENCES runs (id),
        sequence INTEGER NOT NULL,
        written_at INTEGER NOT NULL DEFAULT (unixepoch()),
        reason INTEGER NOT NULL,
        from_kind INTEGER NOT NULL, from_player BLOB NOT NULL, from_arena INTEGER NOT NULL,
        to_kind INTEGER NOT NULL, to_player BLOB NOT NULL, to_arena INTEGER NOT NULL,
        coins INTEGER NOT NULL CHECK (coins > 0),
        PRIMARY KEY (run, sequence)
    ) WITHOUT ROWID;

    CREATE TABLE requests (
        player BLOB NOT NULL CHECK (length(player) = 32),
        request_id INTEGER NOT NULL,
        stat INTEGER NOT NULL,
        new_tier INTEGER NOT NULL,
        run INTEGER NOT NULL,
        sequence INTEGER NOT NULL,
        PRIMARY KEY (player, request_id)
    ) WITHOUT ROWID;
)sql"};

// Accounts whose balance is not what the journal adds up to.
constexpr const char* kMisbalancedAccounts = R"sql(
    SELECT count(*) FROM (
        SELECT sum(coins) AS difference FROM (
            SELECT to_kind AS kind, to_player AS player, to_arena AS arena, coins FROM transactions
            UNION ALL
            SELECT from_kind, from_player, from_arena, -coins FROM transactions
            UNION ALL
            SELECT kind, player, arena, -coins FROM balances)
        GROUP BY kind, player, arena HAVING difference <> 0)
)sql";

std::string failure(const SqliteDatabase& database, const std::string& path) {
    return "ledger '" + path + "': " + database.message();
}

std::optional<std::int64_t> query_integer(SqliteDatabase& database, const std::string& sql) {
    SqliteStatement query(database, sql);
    std::optional<std::int64_t> value;
    while (query.next()) value = query.integer(0);
    return query.failed() ? std::nullopt : value;
}

}  // namespace

bool check_ledger_identity(SqliteDatabase& database, const std::string& path, std::string& error) {
    const auto version = query_integer(database, "PRAGMA user_version");
    const auto application = query_integer(database, "PRAGMA application_id");
    const auto tables = query_integer(database, "SELECT count(*) FROM sqlite_schema");
    if (!version || !application || !tables) {
        error = failure(database, path) +
                (database.is_damaged()
                     ? "; the file is damaged and was left as it is: restore a copy of "
                       "it, or move it away to start an empty ledger"
                     : "; see that this user may read and write the file");
        return false;
    }
    if (*tables > 0 && *application != kApplicationId) {
        error =
            "'" + path + "' is a database of another program and was left as it is; move it away";
        return false;
    }
    if (*version > kLedgerSchemaVersion) {
        error = "ledger '" + path + "' was written by a newer server (schema " +
                std::to_string(*version) + ", this one knows " +
                std::to_string(kLedgerSchemaVersion) +
                "); run that server, or restore an older copy";
        return false;
    }
    return true;
}

bool check_ledger_integrity(SqliteDatabase& database, const std::string& path, std::string& error) {
    const char* remedy =
        "; it was left as it is: restore a copy of it, or move it away to start an empty ledger";
    std::string verdict;
    {
        SqliteStatement check(database, "PRAGMA integrity_check(1)");
        while (check.next()) verdict = check.text(0);
        if (check.failed()) verdict = database.message();
    }
    if (verdict != "ok") {
        error = "ledger '" + path + "' is damaged (" + verdict + ")" + remedy;
        return false;
    }
    if (query_integer(database, "PRAGMA user_version") == 0) return true;

    const auto misbalanced = query_integer(database, kMisbalancedAccounts);
    if (!misbalanced) {
        error = failure(database, path) + remedy;
        return false;
    }
    if (*misbalanced != 0) {
        error = "ledger '" + path + "': the balances of " + std::to_string(*misbalanced) +
                " accounts are not what the journal adds up to" + remedy;
        return false;
    }
    return true;
}

bool migrate_ledger(SqliteDatabase& database, const std::string& path, std::string& error) {
    bool ok = database.execute("PRAGMA journal_mode = WAL") &&
              database.execute("PRAGMA synchronous = FULL") &&
              database.execute("PRAGMA foreign_keys = ON");
    const auto version = query_integer(database, "PRAGMA user_version");
    ok = ok && version;
    for (std::int64_t from = version.value_or(0); ok && from < kLedgerSchemaVersion; ++from) {
        ok = database.execute("BEGIN IMMEDIATE") &&
             database.execute(kMigrations[static_cast<std::size_t>(from)]) &&
             database.execute(kSetApplicationId) &&
             database.execute("PRAGMA user_version = " + std::to_string(from + 1)) &&
             database.execute("COMMIT");
    }
    if (!ok) {
        error = failure(database, path) +
                "; see that the disk is not full and this user may write to the folder";
    }
    return ok;
}

}  // namespace fts::server
