#include "server/economy/sqlite_database.h"

#include <sqlite3.h>

namespace fts::server {

namespace {

// How long a write waits for another program that holds the file.
constexpr int kBusyTimeoutMs = 1000;

}  // namespace

void SqliteDatabase::Close::operator()(sqlite3* database) const {
    sqlite3_close_v2(database);
}

SqliteDatabase::SqliteDatabase(const std::string& path) {
    sqlite3* database = nullptr;
    const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
    open_ = sqlite3_open_v2(path.c_str(), &database, flags, nullptr) == SQLITE_OK;
    handle_.reset(database);
    if (!open_) return;
    sqlite3_busy_timeout(database, kBusyTimeoutMs);
    tidy_on_close(false);
}

bool SqliteDatabase::execute(const std::string& sql) {
    return sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
}

std::string SqliteDatabase::message() const {
    return handle_ ? sqlite3_errmsg(handle_.get()) : "out of memory";
}

bool SqliteDatabase::is_damaged() const {
    const int code = sqlite3_errcode(handle_.get());
    return code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
}

void SqliteDatabase::tidy_on_close(bool tidy) {
    sqlite3_db_config(handle_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, tidy ? 0 : 1, nullptr);
}

int SqliteDatabase::changed_rows() const {
    return sqlite3_changes(handle_.get());
}

std::int64_t SqliteDatabase::last_row_id() const {
    return sqlite3_last_insert_rowid(handle_.get());
}

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

SqliteStatement::SqliteStatement(SqliteDatabase& database, const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    failed_ = sqlite3_prepare_v2(database.handle_.get(), sql.c_str(), -1, &statement, nullptr) !=
              SQLITE_OK;
    handle_.reset(statement);
}

SqliteStatement& SqliteStatement::start() {
    if (!handle_) return *this;
    sqlite3_reset(handle_.get());
    sqlite3_clear_bindings(handle_.get());
    next_parameter_ = 1;
    failed_ = false;
    return *this;
}

SqliteStatement& SqliteStatement::bind(std::int64_t value) {
    if (sqlite3_bind_int64(handle_.get(), next_parameter_++, value) != SQLITE_OK) failed_ = true;
    return *this;
}

SqliteStatement& SqliteStatement::bind(const std::string& text) {
    if (sqlite3_bind_text64(handle_.get(), next_parameter_++, text.data(), text.size(),
                            SQLITE_TRANSIENT, SQLITE_UTF8) != SQLITE_OK) {
        failed_ = true;
    }
    return *this;
}

SqliteStatement& SqliteStatement::bind(std::span<const std::uint8_t> blob) {
    if (blob.empty()) {
        if (sqlite3_bind_zeroblob(handle_.get(), next_parameter_++, 0) != SQLITE_OK) failed_ = true;
        return *this;
    }
    if (sqlite3_bind_blob64(handle_.get(), next_parameter_++, blob.data(), blob.size(),
                            SQLITE_TRANSIENT) != SQLITE_OK) {
        failed_ = true;
    }
    return *this;
}

bool SqliteStatement::run() {
    if (failed_ || !handle_) return false;
    const bool done = sqlite3_step(handle_.get()) == SQLITE_DONE;
    failed_ = !done;
    sqlite3_reset(handle_.get());
    return done;
}

bool SqliteStatement::next() {
    if (failed_ || !handle_) return false;
    const int code = sqlite3_step(handle_.get());
    failed_ = code != SQLITE_ROW && code != SQLITE_DONE;
    return code == SQLITE_ROW;
}

std::int64_t SqliteStatement::integer(int column) const {
    return sqlite3_column_int64(handle_.get(), column);
}

std::string SqliteStatement::text(int column) const {
    const unsigned char* bytes = sqlite3_column_text(handle_.get(), column);
    const int size = sqlite3_column_bytes(handle_.get(), column);
    return bytes ? std::string(bytes, bytes + size) : std::string();
}

}  // namespace fts::server
