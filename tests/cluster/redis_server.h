// A Redis server for one test, on a free port, without persistence.
#ifndef PHRENIC_TESTS_CLUSTER_REDIS_SERVER_H_
#define PHRENIC_TESTS_CLUSTER_REDIS_SERVER_H_

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "absl/time/clock.h"
#include "server/cluster/redis.h"

namespace phrenic::cluster {

// Not thread-safe.
class RedisServer {
 public:
  static bool Installed() { return std::system("command -v redis-server > /dev/null") == 0; }

  RedisServer() : port_(33'000 + getpid() % 20'000) { Start(); }
  ~RedisServer() { Kill(); }
  RedisServer(const RedisServer&) = delete;
  RedisServer& operator=(const RedisServer&) = delete;

  // Starts it empty and returns once it answers.
  void Start() {
    pid_ = fork();
    if (pid_ == 0) {
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, 1);
      execlp("redis-server", "redis-server", "--bind", "127.0.0.1", "--port", std::to_string(port_).c_str(), "--save",
             "", nullptr);
      _exit(127);
    }
    for (int tries = 0; tries < 200; ++tries) {
      Redis redis({.host = "127.0.0.1", .port = port_, .password = ""});
      if (redis.Run({"PING"}).ok()) return;
      absl::SleepFor(absl::Milliseconds(20));
    }
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
  const int port_;
  pid_t pid_ = -1;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_TESTS_CLUSTER_REDIS_SERVER_H_
