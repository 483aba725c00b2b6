#include "server/store/sqlite.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace phrenic::store {

absl::StatusOr<Database> Database::Open(const std::string& file, Access access) {
  sqlite3* handle = nullptr;
  const int flags = access == Access::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int code = sqlite3_open_v2(file.c_str(), &handle, flags, nullptr);
  Database database(file, handle);
  if (code == SQLITE_CANTOPEN) {
    return absl::NotFoundError(absl::StrCat("cannot open ", file, ": does the folder exist, and is it writable?"));
  }
  if (code != SQLITE_OK) return database.Status(code);
  sqlite3_extended_result_codes(handle, 0);
  return database;
}

absl::Status Database::Status(int code) const {
  switch (code) {
    case SQLITE_OK:
    case SQLITE_ROW:
    case SQLITE_DONE:
      return absl::OkStatus();
    case SQLITE_FULL:
      return absl::ResourceExhaustedError(absl::StrCat("the disk of ", file_, " is full"));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return absl::FailedPreconditionError(
          absl::StrCat(file_, " is in use by another server: stop it, or name another folder with --store"));
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
      return absl::DataLossError(absl::StrCat(file_, " is damaged, or is not a store (", sqlite3_errmsg(handle_.get()),
                                              "): nothing was changed; phrenicd check lists what can be read"));
    default:
      return absl::UnavailableError(absl::StrCat(file_, ": ", sqlite3_errmsg(handle_.get())));
  }
}

absl::Status Database::Run(const std::string& sql) {
  return Status(sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

absl::Status Database::Sync() {
  sqlite3_file* log = nullptr;
  const int code = sqlite3_file_control(handle_.get(), "main", SQLITE_FCNTL_JOURNAL_POINTER, static_cast<void*>(&log));
  if (code != SQLITE_OK) return Status(code);
  if (log == nullptr || log->pMethods == nullptr) return absl::OkStatus();  // nothing is written yet
  if (log->pMethods->xSync(log, SQLITE_SYNC_NORMAL) == SQLITE_OK) return absl::OkStatus();
  return absl::UnavailableError(absl::StrCat(file_, "-wal: the disk does not take what was written"));
}

absl::StatusOr<std::int64_t> Database::Number(const std::string& sql) {
  auto statement = Statement::Prepare(*this, sql);
  if (!statement.ok()) return statement.status();
  const absl::StatusOr<bool> row = statement->Next();
  if (!row.ok()) return row.status();
  return *row ? statement->Number(0) : 0;
}

absl::StatusOr<std::string> Database::Text(const std::string& sql) {
  auto statement = Statement::Prepare(*this, sql);
  if (!statement.ok()) return statement.status();
  const absl::StatusOr<bool> row = statement->Next();
  if (!row.ok()) return row.status();
  return *row ? std::string(statement->Bytes(0)) : "";
}

absl::StatusOr<Statement> Statement::Prepare(const Database& database, const std::string& sql) {
  sqlite3_stmt* handle = nullptr;
  const int code = sqlite3_prepare_v2(database.get(), sql.c_str(), static_cast<int>(sql.size()), &handle, nullptr);
  Statement statement(database, handle);
  if (code != SQLITE_OK) return database.Status(code);
  return statement;
}

Statement& Statement::Bind(int parameter, std::string_view text) {
  sqlite3_bind_text(handle_.get(), parameter, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  return *this;
}

Statement& Statement::BindBytes(int parameter, std::string_view bytes) {
  sqlite3_bind_blob64(handle_.get(), parameter, bytes.data(), bytes.size(), SQLITE_TRANSIENT);
  return *this;
}

Statement& Statement::Bind(int parameter, std::int64_t number) {
  sqlite3_bind_int64(handle_.get(), parameter, number);
  return *this;
}

absl::Status Statement::Run() {
  sqlite3_step(handle_.get());
  return database_->Status(sqlite3_reset(handle_.get()));
}

absl::StatusOr<bool> Statement::Next() {
  const int code = sqlite3_step(handle_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) return database_->Status(code);
  return code == SQLITE_ROW;
}

std::string_view Statement::Bytes(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(handle_.get(), column));
  return {bytes == nullptr ? "" : bytes, static_cast<size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

}  // namespace phrenic::store
