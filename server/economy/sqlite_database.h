// SQLite as values with owners: a database that closes itself, and statements that are prepared
// once. Failures come back as false with `message()`; nothing throws. One thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace fts::server {

class SqliteDatabase {
  public:
    // Opens for reading and writing, creates when missing. Check `is_open` before anything else.
    explicit SqliteDatabase(const std::string& path);

    bool is_open() const { return open_; }
    bool execute(const std::string& sql);
    // Of the last failure, in SQLite's words.
    std::string message() const;
    // The last failure says that the file's content is damaged or is no database.
    bool is_damaged() const;
    // Closing normally tidies the write-ahead log into the file. Off until the file has been found
    // whole, so that a damaged one stays as it was found.
    void tidy_on_close(bool tidy);
    // Rows the last insert, update or delete touched.
    int changed_rows() const;
    std::int64_t last_row_id() const;

  private:
    friend class SqliteStatement;
    struct Close {
        void operator()(sqlite3* database) const;
    };
    std::unique_ptr<sqlite3, Close> handle_;
    bool open_ = false;
};

class SqliteStatement {
  public:
    // The SQL must be right; what can go wrong is the file, and shows up in `run` or `next`.
    SqliteStatement(SqliteDatabase& database, const std::string& sql);

    // Parameters in order of appearance. Begins a new execution.
    SqliteStatement& start();
    SqliteStatement& bind(std::int64_t value);
    SqliteStatement& bind(const std::string& text);
    SqliteStatement& bind(std::span<const std::uint8_t> blob);

    // Executes a statement that returns no rows.
    bool run();
    // Moves on to the next row. False at the end and on failure; `failed` tells which.
    bool next();
    bool failed() const { return failed_; }

    std::int64_t integer(int column) const;
    std::string text(int column) const;

  private:
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    std::unique_ptr<sqlite3_stmt, Finalize> handle_;
    int next_parameter_ = 1;
    bool failed_ = false;
};

}  // namespace fts::server
