// A cluster as deploy/cluster starts it, with nginx and Redis, whose servers can be killed, drained and started again.
#ifndef PHRENIC_TESTS_CLUSTER_TRIAL_DEPLOYMENT_H_
#define PHRENIC_TESTS_CLUSTER_TRIAL_DEPLOYMENT_H_

#include <grpcpp/channel.h>
#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic::cluster {

inline constexpr int kSkipped = 77;  // ctest's SKIP_RETURN_CODE
// Whether a cluster can be started here; where not, says so.
bool HasTools();

// Not thread-safe, but for NewChannel. Stopped with the object.
class Deployment {
 public:
  // A program of it: "redis", "server-1" ...
  struct Program {
    std::string name;
    pid_t pid = -1;
    std::vector<std::string> words;  // it was started with these
    bool ours = false;               // a child of this process
  };

  ~Deployment();
  Deployment() = default;
  Deployment(const Deployment&) = delete;
  Deployment& operator=(const Deployment&) = delete;

  // With so many servers, on free ports, each with these flags as well. UNAVAILABLE with what it said.
  absl::Status Start(int servers, const std::vector<std::string>& flags = {});
  // A connection of its own to nginx, with TLS.
  std::shared_ptr<grpc::Channel> NewChannel() const;
  // The same to one server itself.
  std::shared_ptr<grpc::Channel> NewChannelTo(int server) const;

  // Sends the signal, and waits for the program's end where the signal ends it.
  void End(const std::string& name, int signal);
  void Signal(const std::string& name, int signal);
  // Starts it again as it was; returns at once.
  void StartAgain(const std::string& name);
  const std::string& folder() const { return folder_; }
  // CPU time so far of "nginx", "redis", "server-1" ... and the processes it started [s].
  double Cpu(const std::string& name) const;
  // A number of a server's /metrics; 0 where it has none of that name.
  double Metric(int server, const std::string& name) const;

 private:
  Program& Find(const std::string& name);
  std::string Said() const;

  std::string folder_, trust_;
  int port_ = 0, base_ = 0;
  pid_t script_ = -1;
  std::vector<Program> programs_;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_TESTS_CLUSTER_TRIAL_DEPLOYMENT_H_
