#include "tests/faults/daemon.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"

namespace phrenic::faults {
namespace {

// What stands behind the word to the line's end, without a slash; empty while there is no such whole line.
std::string LineBehind(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word), end = text.find('\n', at);
  if (at == std::string::npos || end == std::string::npos) return "";
  const std::string line = text.substr(at + word.size(), end - at - word.size());
  return line.substr(0, line.find('/'));
}

}  // namespace

Daemon::Daemon(std::string store, std::vector<std::string> environment)
    : store_(std::move(store)), environment_(std::move(environment)) {}

Daemon::~Daemon() {
  if (!running()) return;
  Signal(SIGKILL);
  Await(60);
}

std::string Daemon::said() const {
  std::ifstream in(store_ + ".said");
  return {std::istreambuf_iterator<char>(in), {}};
}

absl::Status Daemon::Start() {
  const std::string out = store_ + ".said";
  std::filesystem::remove(out);
  ended_ = -1;
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const std::string& variable : environment_) putenv(const_cast<char*>(variable.c_str()));
    const int file = open(out.c_str(), O_CREAT | O_WRONLY, 0600);
    dup2(file, 1);
    dup2(file, 2);
    execl(PHRENIC_BINARY_DIR "/phrenicd", "phrenicd", "--listen", "127.0.0.1:0", "--web", "127.0.0.1:0", "--start",
          "none", "--store", store_.c_str(), nullptr);
    _exit(127);
  }
  for (int tries = 0; tries < 12'000 && running(); ++tries) {
    const std::string text = said();
    address_ = LineBehind(text, "gRPC:   ");
    web_address_ = LineBehind(text, "Viewer: http://");
    if (!address_.empty() && !web_address_.empty()) return absl::OkStatus();
    absl::SleepFor(absl::Milliseconds(5));
  }
  return absl::UnavailableError(said());
}

int Daemon::Await(double seconds) {
  const absl::Time until = absl::Now() + absl::Seconds(seconds);
  while (ended_ < 0) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_)
      ended_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (ended_ >= 0 || absl::Now() >= until) break;
    absl::SleepFor(absl::Milliseconds(1));
  }
  return ended_;
}

}  // namespace phrenic::faults
