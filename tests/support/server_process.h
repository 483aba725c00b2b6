// phrenicd of the build as somebody else's process, on free ports of loopback and with no session: started, asked,
// frozen, killed; what it costs is read from outside.
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
  // What it says goes to the file `said`; `flags` stand behind the addresses and "--start none"; `environment` is set
  // for it alone: "NAME=value". Not started yet.
  explicit ServerProcess(std::string said, std::vector<std::string> flags = {},
                         std::vector<std::string> environment = {});
  ~ServerProcess() { Kill(); }
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  // Returns once it listens. UNAVAILABLE, with what it said, where it ends instead or takes a minute.
  absl::Status Start() { return StartOn("127.0.0.1:0", "127.0.0.1:0"); }
  // On the ports that it had before.
  absl::Status Restart() { return StartOn(address_, web_address_); }
  void Signal(int signal) const { kill(pid_, signal); }
  // Waits for its end, at most so many seconds; its exit code, 128 and the signal, or -1 where it still runs.
  int Await(double seconds);
  // Asks it to end, and waits as above.
  int Stop(double seconds);
  void Kill();

  bool running() { return pid_ > 0 && Await(0) < 0; }
  pid_t pid() const { return pid_; }
  const std::string& address() const { return address_; }          // "127.0.0.1:PORT", of gRPC
  const std::string& web_address() const { return web_address_; }  // of the web
  int port() const { return PortOf(address_); }
  int web_port() const { return PortOf(web_address_); }
  std::string said() const;
  // A connection of its own, with messages of any size.
  std::shared_ptr<grpc::Channel> NewChannel() const;

  // CPU time so far [s], of all threads or of those of that name.
  double Cpu() const;
  double Cpu(const std::string& thread) const;
  // What is resident, and the most that ever was [bytes].
  std::int64_t Memory() const { return 1024 * Status("VmRSS:"); }
  std::int64_t PeakMemory() const { return 1024 * Status("VmHWM:"); }
  std::int64_t Threads() const { return Status("Threads:"); }
  // Open file descriptors.
  std::int64_t Files() const;

 private:
  absl::Status StartOn(const std::string& address, const std::string& web_address);
  static int PortOf(const std::string& address);
  std::int64_t Status(const std::string& name) const;

  const std::string said_;
  const std::vector<std::string> flags_, environment_;
  pid_t pid_ = -1;
  int ended_ = -1;
  std::string address_, web_address_;
};

}  // namespace phrenic

#endif  // PHRENIC_TESTS_SUPPORT_SERVER_PROCESS_H_
