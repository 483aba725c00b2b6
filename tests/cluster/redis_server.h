// A Redis server for one test, on a free port, without persistence.
#ifndef PHRENIC_TESTS_CLUSTER_REDIS_SERVER_H_
#define PHRENIC_TESTS_CLUSTER_REDIS_SERVER_H_

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "absl/time/clock.h"
#include "server/cluster/redis.h"
#include "tests/support/free_ports.h"

namespace phrenic::cluster {

// Not thread-safe.
class RedisServer {
 public:
  static bool Installed() { return std::system("command -v redis-server > /dev/null") == 0; }

  // `flags` are added to its command line.
  explicit RedisServer(std::vector<std::string> flags = {}) : port_(FreePorts()), flags_(std::move(flags)) { Start(); }
  ~RedisServer() { Kill(); }
  RedisServer(const RedisServer&) = delete;
  RedisServer& operator=(const RedisServer&) = delete;

  // Starts it empty on its port, and returns once it answers. Fails the test if it does not within 20 s.
  void Start() {
    pid_ = fork();
    if (pid_ == 0) Exec();
    for (const absl::Time end = absl::Now() + absl::Seconds(20); absl::Now() < end;) {
      Redis redis({.host = "127.0.0.1", .port = port_, .password = ""});
      if (redis.Run({"PING"}).ok()) return;
      absl::SleepFor(absl::Milliseconds(20));
    }
    Kill();
    ADD_FAILURE() << "redis-server does not answer on port " << port_;
  }
  void Kill() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  void Signal(int signal) const { kill(pid_, signal); }
  int port() const { return port_; }
  std::string url() const { return "redis://127.0.0.1:" + std::to_string(port_); }

 private:
  [[noreturn]] void Exec() const {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 1);
    std::vector<std::string> words = {"redis-server",        "--bind", "127.0.0.1", "--port",
                                      std::to_string(port_), "--save", ""};
    words.insert(words.end(), flags_.begin(), flags_.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execvp("redis-server", arguments.data());
    _exit(127);
  }

  const int port_;
  const std::vector<std::string> flags_;
  pid_t pid_ = -1;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_TESTS_CLUSTER_REDIS_SERVER_H_
