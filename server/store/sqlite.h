// SQLite's C interface as C++ classes, with errors as absl::Status.
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

// An open file. Not thread-safe.
class Database {
 public:
  // Opens a file; kWrite creates it if it is missing. Errors name the file: NOT_FOUND, DATA_LOSS if it is no database,
  // FAILED_PRECONDITION if another process has locked it.
  static absl::StatusOr<Database> Open(const std::string& file, Access access);

  // Runs statements that return no rows.
  absl::Status Run(const std::string& sql);
  // Has the disk hold all committed transactions, also after a power failure. Requires: journal_mode = WAL.
  absl::Status Sync();
  // Return the first column of the first row; 0 or empty without a row.
  absl::StatusOr<std::int64_t> Number(const std::string& sql);
  absl::StatusOr<std::string> Text(const std::string& sql);
  // Converts a result code of SQLite: RESOURCE_EXHAUSTED for a full disk, the errors of Open, otherwise UNAVAILABLE.
  absl::Status Status(int code) const;
  sqlite3* get() const { return handle_.get(); }

 private:
  Database(std::string file, sqlite3* handle) : file_(std::move(file)), handle_(handle, &sqlite3_close) {}

  std::string file_;
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> handle_;
};

// A prepared statement. Parameters are numbered from 1, the columns of a row from 0. Not thread-safe.
class Statement {
 public:
  static absl::StatusOr<Statement> Prepare(const Database& database, const std::string& sql);

  Statement& Bind(int parameter, std::string_view text);
  Statement& BindBytes(int parameter, std::string_view bytes);
  Statement& Bind(int parameter, std::int64_t number);
  // Runs a statement that returns no rows, and resets it so that it can be bound again.
  absl::Status Run();
  // Steps to the next row. Returns false if there is none.
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
