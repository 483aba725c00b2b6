#include "client/connection/tokens.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/files/whole_file.h"

namespace phrenic::client {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTokens = 1000;

struct Entry {
  std::string server, session, token;
};

// Empty where the environment names no place.
fs::path Folder() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/') {
    return fs::path(state) / "phrenic";
  }
  const char* home = std::getenv("HOME");
  return home == nullptr || *home == '\0' ? fs::path() : fs::path(home) / ".local/state/phrenic";
}

std::vector<Entry> ReadEntries(const fs::path& file) {
  std::vector<Entry> entries;
  std::ifstream in(file);
  for (Entry entry; in >> entry.server >> entry.session >> entry.token;) entries.push_back(entry);
  return entries;
}

// One command at a time changes the file.
class Lock {
 public:
  explicit Lock(const fs::path& file) : file_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    if (file_ >= 0) flock(file_, LOCK_EX);
  }
  ~Lock() {
    if (file_ >= 0) close(file_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  const int file_;
};

absl::Status WriteEntries(const fs::path& file, const std::vector<Entry>& entries) {
  std::string text;
  const std::size_t first = entries.size() - std::min(entries.size(), kMostTokens);
  for (std::size_t i = first; i < entries.size(); ++i) {
    absl::StrAppend(&text, entries[i].server, " ", entries[i].session, " ", entries[i].token, "\n");
  }
  const mode_t before = umask(0077);  // nobody else's to read from its first byte on
  absl::Status status = WriteWhole(file.string(), text);
  umask(before);
  return status;
}

// In place of what there was of this session; an empty token leaves nothing.
absl::Status Replace(const Entry& entry) {
  const fs::path folder = Folder();
  if (folder.empty()) return absl::NotFoundError("neither XDG_STATE_HOME nor HOME says where");
  std::error_code error;
  fs::create_directories(folder, error);
  fs::permissions(folder, fs::perms::owner_all, error);
  if (error) return absl::NotFoundError(absl::StrCat(folder.string(), ": ", error.message()));
  const Lock lock(folder / "control.lock");
  std::vector<Entry> entries = ReadEntries(folder / "control");
  const auto gone = std::erase_if(
      entries, [&](const Entry& each) { return each.server == entry.server && each.session == entry.session; });
  if (entry.token.empty() && gone == 0) return absl::OkStatus();
  if (!entry.token.empty()) entries.push_back(entry);
  return WriteEntries(folder / "control", entries);
}

}  // namespace

std::string TokenOf(const Context& context, const std::string& session_id) {
  const fs::path folder = Folder();
  if (folder.empty()) return "";
  for (const Entry& entry : ReadEntries(folder / "control")) {
    if (entry.server == context.server && entry.session == session_id) return entry.token;
  }
  return "";
}

void KeepToken(const Context& context, const std::string& session_id, const std::string& token) {
  const absl::Status status = Replace({context.server, session_id, token});
  if (status.ok()) return;
  std::cerr << "phrenic: warning: the session's token could not be kept (" << std::string(status.message())
            << "): later commands will not own it; set XDG_STATE_HOME to a folder of yours\n";
}

void ForgetToken(const Context& context, const std::string& session_id) {
  (void)Replace({context.server, session_id, ""});  // a token of nothing does no harm
}

}  // namespace phrenic::client
