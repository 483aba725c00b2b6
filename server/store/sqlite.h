// SQLite's C interface as values: a database, a statement, errors as absl::Status.
#ifndef PHRENIC_SERVER_STORE_SQLITE_H_
#define PHRENIC_SERVER_STORE_SQLITE_H_

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace phrenic::store {

enum class Access { kRead, kWrite };

// Of one thread at a time.
class Database {
 public:
  // kWrite makes the file where there is none. Errors name the file: NOT_FOUND, DATA_LOSS where it is no database,
  // FAILED_PRECONDITION where another program has it open for itself.
  static absl::StatusOr<Database> Open(const std::string& file, Access access);

  absl::Status Run(const std::string& sql);
  absl::StatusOr<std::int64_t> Number(const std::string& sql);
  absl::StatusOr<std::string> Text(const std::string& sql);
  // OK, or RESOURCE_EXHAUSTED for a full disk, else as Open.
  absl::Status Status(int code) const;
  sqlite3* get() const { return handle_.get(); }

 private:
  Database(std::string file, sqlite3* handle) : file_(std::move(file)), handle_(handle, &sqlite3_close) {}

  std::string file_;
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> handle_;
};

// A prepared statement; its places are numbered from 1, a row's columns from 0.
class Statement {
 public:
  static absl::StatusOr<Statement> Prepare(const Database& database, const std::string& sql);

  Statement& Bind(int place, std::string_view text);
  Statement& BindBytes(int place, std::string_view bytes);
  Statement& Bind(int place, std::int64_t number);
  // Runs it to its end, and makes it ready to be bound anew.
  absl::Status Run();
  // The next row; false when there is none.
  absl::StatusOr<bool> Next();
  std::string_view Bytes(int column) const;
  std::int64_t Number(int column) const { return sqlite3_column_int64(handle_.get(), column); }

 private:
  Statement(const Database& database, sqlite3_stmt* handle)
      : database_(&database), handle_(handle, &sqlite3_finalize) {}

  const Database* database_;
  std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> handle_;
};

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_SQLITE_H_
