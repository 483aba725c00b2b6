// Runs the phrenicd of this build as a child process on free loopback ports, without a first session. Tests send it
// signals and read its resources from /proc.
#ifndef PHRENIC_TESTS_SUPPORT_SERVER_PROCESS_H_
#define PHRENIC_TESTS_SUPPORT_SERVER_PROCESS_H_

#include <grpcpp/channel.h>
#include <sys/types.h>

#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic {

// Not thread-safe.
class ServerProcess {
 public:
  // Writes the child's output to the file `log`; passes `flags` after the addresses and "--start none"; sets variables
  // `environment`, "NAME=value", for the child only. Does not start it.
  explicit ServerProcess(std::string log, std::vector<std::string> flags = {},
                         std::vector<std::string> environment = {});
  ~ServerProcess() { Kill(); }
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  // Returns once the server listens. UNAVAILABLE, with its output, if it exits or does not listen within a minute.
  absl::Status Start() { return StartOn("127.0.0.1:0", "127.0.0.1:0"); }
  // Starts it on the same ports as before.
  absl::Status Restart() { return StartOn(address_, web_address_); }
  void Signal(int signal) const { kill(pid_, signal); }
  // Waits for its end for at most `seconds`. Returns the exit code, 128 + signal, or -1 if it still runs.
  int Await(double seconds);
  // Sends SIGTERM and calls Await.
  int Stop(double seconds);
  void Kill();

  bool running() { return pid_ > 0 && Await(0) < 0; }
  pid_t pid() const { return pid_; }
  const std::string& address() const { return address_; }          // gRPC, "127.0.0.1:PORT"
  const std::string& web_address() const { return web_address_; }  // web gateway
  int port() const { return PortOf(address_); }
  int web_port() const { return PortOf(web_address_); }
  // Returns its output so far.
  std::string output() const;
  // Returns a channel with its own connection and no limit on message sizes.
  std::shared_ptr<grpc::Channel> NewChannel() const;

  // Return the CPU time so far [s] of all threads, or of threads with a name.
  double Cpu() const;
  double Cpu(const std::string& thread) const;
  // Return the resident memory and its maximum [bytes].
  std::int64_t Memory() const { return 1024 * Status("VmRSS:"); }
  std::int64_t PeakMemory() const { return 1024 * Status("VmHWM:"); }
  std::int64_t Threads() const { return Status("Threads:"); }
  // Open file descriptors.
  std::int64_t Files() const;

 private:
  absl::Status StartOn(const std::string& address, const std::string& web_address);
  static int PortOf(const std::string& address);
  std::int64_t Status(const std::string& name) const;

  const std::string log_;
  const std::vector<std::string> flags_, environment_;
  pid_t pid_ = -1;
  int ended_ = -1;
  std::string address_, web_address_;
};

}  // namespace phrenic

#endif  // PHRENIC_TESTS_SUPPORT_SERVER_PROCESS_H_
