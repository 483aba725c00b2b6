// A phrenicd of the bench's own: what it costs is read from outside, so that clients do not count.
#ifndef PHRENIC_TESTS_BENCH_STREAMING_SERVER_PROCESS_H_
#define PHRENIC_TESTS_BENCH_STREAMING_SERVER_PROCESS_H_

#include <sys/types.h>

#include <memory>
#include <string>

#include "absl/status/statusor.h"

namespace phrenic::bench {

// Not thread-safe.
class ServerProcess {
 public:
  // Of build/phrenicd, on ports that are free; has no session. UNAVAILABLE where it does not answer within 30 s.
  static absl::StatusOr<std::unique_ptr<ServerProcess>> Start();
  ~ServerProcess();

  std::string address() const;  // of gRPC
  int port() const { return port_; }
  int web_port() const { return web_port_; }
  // CPU time so far [s], of all threads or of those of that name.
  double Cpu() const;
  double Cpu(const std::string& thread) const;
  // Resident memory [MB].
  double Memory() const;

 private:
  ServerProcess(pid_t pid, int port, int web_port) : pid_(pid), port_(port), web_port_(web_port) {}
  const pid_t pid_;
  const int port_, web_port_;
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_STREAMING_SERVER_PROCESS_H_
