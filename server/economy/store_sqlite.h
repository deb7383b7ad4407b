// The ledger in one SQLite file, for a server on one machine. Write-ahead log and synchronous=FULL:
// what `commit` has acknowledged survives a kill and a power cut. Other programs may read the file
// meanwhile
// (`sqlite3 ledger.sqlite3`, `.backup`); a second server is kept out by a lock file beside it.
#pragma once

#include <memory>
#include <string>

#include "server/economy/store.h"

namespace fts::server {

// Opens or creates the file, brings an older schema up to date, checks the file's integrity and
// that its balances are those its journal adds up to. On failure returns nullptr and sets `error`
// to a message that names the file and the remedy. A damaged file is never written to.
std::unique_ptr<Store> open_sqlite_store(const std::string& path, std::string& error);

}  // namespace fts::server
