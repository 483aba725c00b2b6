#include "client/files/tokens.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/files/whole_file.h"
#include "client/terminal/environment.h"

namespace phrenic::client {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTokens = 1000;

struct Entry {
  std::string server, session, token;
};

// Empty if neither XDG_STATE_HOME nor HOME is set.
fs::path Folder() {
  const std::string state = EnvironmentVariable("XDG_STATE_HOME"), home = EnvironmentVariable("HOME");
  if (state.starts_with('/')) return fs::path(state) / "phrenic";
  return home.empty() ? fs::path() : fs::path(home) / ".local/state/phrenic";
}

std::vector<Entry> ReadEntries(const fs::path& file) {
  std::vector<Entry> entries;
  std::ifstream in(file);
  for (Entry entry; in >> entry.server >> entry.session >> entry.token;) entries.push_back(entry);
  return entries;
}

// Lets one process at a time change the file.
class FileLock {
 public:
  explicit FileLock(const fs::path& file) : file_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    if (file_ >= 0) flock(file_, LOCK_EX);
  }
  ~FileLock() {
    if (file_ >= 0) close(file_);
  }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  const int file_;
};

absl::Status WriteEntries(const fs::path& file, const std::vector<Entry>& entries) {
  std::string text;
  const std::size_t first = entries.size() - std::min(entries.size(), kMostTokens);
  for (std::size_t i = first; i < entries.size(); ++i) {
    absl::StrAppend(&text, entries[i].server, " ", entries[i].session, " ", entries[i].token, "\n");
  }
  const mode_t before = umask(0077);  // the new file is private from the start
  absl::Status status = WriteWhole(file.string(), text);
  umask(before);
  return status;
}

// Replaces the session's entry; an empty token removes it.
absl::Status ReplaceEntry(const Entry& entry) {
  const fs::path folder = Folder();
  if (folder.empty()) return absl::NotFoundError("neither XDG_STATE_HOME nor HOME is set");
  std::error_code error;
  fs::create_directories(folder, error);
  fs::permissions(folder, fs::perms::owner_all, error);
  if (error) return absl::NotFoundError(absl::StrCat(folder.string(), ": ", error.message()));
  const FileLock lock(folder / "control.lock");
  std::vector<Entry> entries = ReadEntries(folder / "control");
  const auto removed = std::erase_if(
      entries, [&](const Entry& each) { return each.server == entry.server && each.session == entry.session; });
  if (entry.token.empty() && removed == 0) return absl::OkStatus();
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
  const absl::Status status = ReplaceEntry({context.server, session_id, token});
  if (status.ok()) return;
  std::cerr << "phrenic: warning: cannot store the session's control token (" << std::string(status.message())
            << "): later commands will not control the session; set XDG_STATE_HOME to a folder that you may write\n";
}

void ForgetToken(const Context& context, const std::string& session_id) {
  (void)ReplaceEntry({context.server, session_id, ""});  // a token of a deleted session is harmless
}

}  // namespace phrenic::client
