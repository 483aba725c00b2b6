#include "client/terminal/open_page.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>

#include "absl/strings/str_cat.h"

namespace phrenic::client {
namespace {

// Starts a program of $PATH with its output discarded. False if it cannot be started.
bool StartOpener(const char* program, const std::string& address) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  }
  char* const arguments[] = {const_cast<char*>(program), const_cast<char*>(address.c_str()), nullptr};
  pid_t pid = 0;
  const int failed = posix_spawnp(&pid, program, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed == 0;
}

}  // namespace

absl::Status OpenPage(const std::string& address) {
  const char* const chosen = std::getenv("BROWSER");
  if (chosen != nullptr && *chosen != '\0' && StartOpener(chosen, address)) return absl::OkStatus();
  if (StartOpener("xdg-open", address)) return absl::OkStatus();
  return absl::NotFoundError(
      absl::StrCat("--web: neither xdg-open nor the program that $BROWSER names can be started; "
                   "open ",
                   address, " yourself"));
}

}  // namespace phrenic::client
