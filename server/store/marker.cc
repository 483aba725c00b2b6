#include "server/store/marker.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "server/crypto/secret.h"

namespace phrenic::store {
namespace {

constexpr char kSessions[] = "SELECT count(*) FROM sessions WHERE state IS NOT NULL";
constexpr std::size_t kIdLength = 16;

std::string Holdings(std::int64_t sessions, std::int64_t jobs) {
  return absl::StrCat(sessions, " sessions and ", jobs, " studies and exports");
}

absl::Status Lost(const std::string& folder, const Marker& marker, const std::string& found) {
  return absl::DataLossError(absl::StrCat(StoreFile(folder), " ", found, ", but ", MarkerFile(folder),
                                          " says that it holds ", Holdings(marker.sessions, marker.jobs),
                                          ": the database, or its write-ahead log phrenic.db-wal, was removed, emptied "
                                          "or replaced. Nothing was changed: put "
                                          "both files back, or remove ",
                                          MarkerFile(folder), " to go on with what there is"));
}

absl::Status WriteError(const std::string& file) {
  const std::string why = absl::StrCat("cannot write ", file, ": ", std::strerror(errno));
  return errno == ENOSPC || errno == EDQUOT ? absl::ResourceExhaustedError(why) : absl::UnavailableError(why);
}

bool ParseMarker(const std::string& text, Marker& marker) {
  std::istringstream words(text);
  std::string phrenic, store, saves, sessions, jobs;
  words >> phrenic >> store >> marker.id >> saves >> marker.saves >> sessions >> marker.sessions >> jobs >> marker.jobs;
  const bool named =
      phrenic == "phrenic" && store == "store" && saves == "saves" && sessions == "sessions" && jobs == "jobs";
  return words && named && marker.saves >= 0 && marker.sessions >= 0 && marker.jobs >= 0;
}

// Writes and syncs a file.
bool WriteSynced(const std::string& file, const std::string& text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) return false;
  const bool good =
      write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && fsync(descriptor) == 0;
  const int error = errno;
  close(descriptor);
  errno = error;
  return good;
}

bool SyncFolder(const std::string& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool good = fsync(descriptor) == 0;
  close(descriptor);
  return good;
}

}  // namespace

std::string StoreFile(const std::string& folder) { return folder + "/phrenic.db"; }

std::string MarkerFile(const std::string& folder) { return folder + "/phrenic.marker"; }

absl::StatusOr<std::optional<Marker>> ReadMarkerFile(const std::string& folder) {
  std::error_code error;
  if (!std::filesystem::exists(MarkerFile(folder), error)) return std::nullopt;
  std::ifstream file(MarkerFile(folder), std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  Marker marker;
  if (file && ParseMarker(text, marker)) return marker;
  return absl::DataLossError(absl::StrCat(MarkerFile(folder),
                                          " cannot be read or is damaged: check the database with phrenicd check, and "
                                          "remove the file to go on with what there is"));
}

absl::Status WriteMarkerFile(const std::string& folder, const Marker& marker) {
  const std::string file = MarkerFile(folder), next = file + ".new";
  const std::string text = absl::StrCat("phrenic store ", marker.id, "\nsaves ", marker.saves, "\nsessions ",
                                        marker.sessions, "\njobs ", marker.jobs, "\n");
  const bool good = WriteSynced(next, text) && std::rename(next.c_str(), file.c_str()) == 0 && SyncFolder(folder);
  return good ? absl::OkStatus() : WriteError(file);
}

absl::Status CheckDatabaseExists(const std::string& folder) {
  const auto marker = ReadMarkerFile(folder);
  if (!marker.ok()) return marker.status();
  if (!marker->has_value() || (*marker)->sessions + (*marker)->jobs == 0) return absl::OkStatus();
  std::error_code error;
  const auto size = std::filesystem::file_size(StoreFile(folder), error);
  if (error) return Lost(folder, **marker, "is missing");
  return size > 0 ? absl::OkStatus() : Lost(folder, **marker, "is empty");
}

absl::Status CheckMarker(const std::string& folder, Database& database) {
  const auto read = ReadMarkerFile(folder);
  if (!read.ok()) return read.status();
  if (!read->has_value() || (*read)->sessions + (*read)->jobs == 0) return absl::OkStatus();
  const Marker& marker = **read;
  const auto table = database.Number("SELECT count(*) FROM sqlite_master WHERE name = 'marker'");
  if (!table.ok()) return table.status();
  const auto sessions = database.Number(kSessions);
  if (!sessions.ok()) return sessions.status();
  const std::string holds = absl::StrCat("holds ", *sessions, " sessions");
  if (*table == 0) return Lost(folder, marker, absl::StrCat(holds, " of another store"));
  const auto id = database.Text("SELECT id FROM marker");
  if (!id.ok()) return id.status();
  const auto saves = database.Number("SELECT saves FROM marker");
  if (!saves.ok()) return saves.status();
  if (!id->empty() && *id != marker.id) return Lost(folder, marker, absl::StrCat(holds, " of another store"));
  if (*saves < marker.saves) return Lost(folder, marker, absl::StrCat(holds, " and is older"));
  if (*saves == marker.saves && *sessions < marker.sessions) return Lost(folder, marker, holds);
  return absl::OkStatus();
}

absl::StatusOr<Marker> UpdateMarker(Database& database) {
  const auto id = database.Text("SELECT id FROM marker");
  if (!id.ok()) return id.status();
  Marker marker;
  marker.id = id->empty() ? NewToken().substr(0, kIdLength) : *id;
  for (const auto& [query, number] : {std::pair("SELECT coalesce(max(saves), 0) + 1 FROM marker", &marker.saves),
                                      {kSessions, &marker.sessions},
                                      {"SELECT count(*) FROM records", &marker.jobs}}) {
    const auto found = database.Number(query);
    if (!found.ok()) return found.status();
    *number = *found;
  }
  auto write = Statement::Prepare(database, "INSERT OR REPLACE INTO marker (number, id, saves) VALUES (1, ?, ?)");
  if (!write.ok()) return write.status();
  if (absl::Status status = write->Bind(1, marker.id).Bind(2, marker.saves).Run(); !status.ok()) return status;
  return marker;
}

}  // namespace phrenic::store
