// The tables of a ledger file and their versions (PRAGMA user_version): what may be opened, and how
// an older file is brought up to date.
#pragma once

#include <string>

#include "server/economy/sqlite_database.h"

namespace fts::server {

inline constexpr int kLedgerSchemaVersion = 1;

// Each returns false with `error` set to a message that names the file and the remedy. Nothing is
// written to the file unless both checks have passed.
bool check_ledger_identity(SqliteDatabase& database, const std::string& path, std::string& error);
// Pages and indices are whole, and every balance is what the journal adds up to.
bool check_ledger_integrity(SqliteDatabase& database, const std::string& path, std::string& error);
bool migrate_ledger(SqliteDatabase& database, const std::string& path, std::string& error);

}  // namespace fts::server
