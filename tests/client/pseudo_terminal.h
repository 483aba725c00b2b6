// A program on a terminal of a given width.
#ifndef PHRENIC_TESTS_CLIENT_PSEUDO_TERMINAL_H_
#define PHRENIC_TESTS_CLIENT_PSEUDO_TERMINAL_H_

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace phrenic::client {

// Starts the program. The destructor kills it. Not thread-safe.
class PseudoTerminal {
 public:
  // `environment` is added to the test's environment.
  PseudoTerminal(const std::vector<std::string>& words, unsigned short columns,
                 const std::map<std::string, std::string>& environment = {}) {
    winsize size = {};
    size.ws_col = columns;
    size.ws_row = 40;
    pid_ = forkpty(&master_, nullptr, nullptr, &size);
    if (pid_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setenv("TERM", "xterm-256color", 1);
    unsetenv("NO_COLOR");
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  ~PseudoTerminal() {
    close(master_);
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  // Sends keys to the program.
  void Type(const std::string& keys) const { (void)!write(master_, keys.data(), keys.size()); }

  // Returns the output since the last call, up to `words`, the program's end, or the timeout.
  std::string ReadUntil(const std::string& words, std::chrono::seconds timeout = std::chrono::seconds(20)) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    std::string text;
    while (text.find(words) == std::string::npos && std::chrono::steady_clock::now() < end) {
      pollfd ready = {master_, POLLIN, 0};
      if (poll(&ready, 1, 100) <= 0) continue;
      char part[4096];
      const ssize_t length = read(master_, part, sizeof part);
      if (length <= 0) break;
      text.append(part, static_cast<std::size_t>(length));
    }
    return text;
  }
  // Returns all output up to the program's end.
  std::string ReadAll() { return ReadUntil(std::string(1, '\0')); }

 private:
  int master_ = -1;
  pid_t pid_ = -1;
};

}  // namespace phrenic::client

#endif  // PHRENIC_TESTS_CLIENT_PSEUDO_TERMINAL_H_
