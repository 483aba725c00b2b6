// A phrenicd of its own on a store that outlives it, as somebody else's process: started, killed, frozen, starved.
#ifndef PHRENIC_TESTS_FAULTS_DAEMON_H_
#define PHRENIC_TESTS_FAULTS_DAEMON_H_

#include <sys/types.h>

#include <csignal>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic::faults {

class Daemon {
 public:
  // `store` is a folder; what it says goes to STORE.said. `environment` is set for it alone: "NAME=value".
  explicit Daemon(std::string store, std::vector<std::string> environment = {});
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Returns once it listens. UNAVAILABLE, with what it said, where it ends instead or takes a minute.
  absl::Status Start();
  void Signal(int signal) const { kill(pid_, signal); }
  // Waits for its end, at most so many seconds; its exit code, 128 and the signal, or -1 where it still runs.
  int Await(double seconds);
  bool running() { return pid_ > 0 && Await(0) < 0; }
  pid_t pid() const { return pid_; }
  const std::string& address() const { return address_; }          // "127.0.0.1:PORT", of gRPC
  const std::string& web_address() const { return web_address_; }  // of the web
  const std::string& store() const { return store_; }
  std::string said() const;

 private:
  const std::string store_;
  const std::vector<std::string> environment_;
  pid_t pid_ = -1;
  int ended_ = -1;
  std::string address_, web_address_;
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_DAEMON_H_
