#include "tests/faults/guard.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "absl/time/clock.h"
#include "tests/faults/raw.h"
#include "tests/support/free_ports.h"

namespace phrenic::faults {
namespace {

constexpr char kScript[] = PHRENIC_SOURCE_DIR "/deploy/guard";

}  // namespace

Guard::Guard(const std::string& folder, const std::string& listen, const std::string& web) {
  const int port = FreePorts();
  if (port == 0 || !std::filesystem::exists(kScript)) return;
  std::filesystem::create_directories(folder);
  const std::string log = folder + "/guard.log", text = std::to_string(port);
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    const int file = open(log.c_str(), O_CREAT | O_WRONLY, 0600);
    dup2(file, STDOUT_FILENO), dup2(file, STDERR_FILENO);
    execl(kScript, kScript, "--port", text.c_str(), "--listen", listen.c_str(), "--web", web.c_str(), "--dir",
          folder.c_str(), nullptr);
    _exit(127);
  }
  const absl::Time until = absl::Now() + absl::Seconds(10);
  while (pid_ > 0 && absl::Now() < until && waitpid(pid_, nullptr, WNOHANG) == 0) {
    if (RawConnection(port, true).open()) {
      port_ = port;
      return;
    }
    absl::SleepFor(absl::Milliseconds(50));
  }
}

Guard::~Guard() {
  if (pid_ <= 0) return;
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

}  // namespace phrenic::faults
