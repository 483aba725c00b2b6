// A cluster started by deploy/cluster, with nginx and Redis, whose programs can be signalled and restarted.
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
// True if this machine has the programs that a cluster needs; prints the missing one otherwise.
bool HasTools();

// Not thread-safe, except NewChannel. The destructor stops the cluster.
class Deployment {
 public:
  // A program of the cluster: "redis", "server-1" ...
  struct Program {
    std::string name;
    pid_t pid = -1;
    std::vector<std::string> words;  // command line
    bool ours = false;               // a child of this process
  };

  ~Deployment();
  Deployment() = default;
  Deployment(const Deployment&) = delete;
  Deployment& operator=(const Deployment&) = delete;

  // Starts `servers` servers on free ports with additional flags. UNAVAILABLE, with the output, if that fails.
  absl::Status Start(int servers, const std::vector<std::string>& flags = {});
  // Returns a channel to nginx with TLS and its own connection.
  std::shared_ptr<grpc::Channel> NewChannel() const;
  // Returns a channel to one server, without TLS.
  std::shared_ptr<grpc::Channel> NewChannelTo(int server) const;

  // Sends a signal that ends the program, and waits for its end.
  void End(const std::string& name, int signal);
  void Signal(const std::string& name, int signal);
  // Restarts a program with its command line; returns at once.
  void StartAgain(const std::string& name);
  const std::string& folder() const { return folder_; }
  // Returns the CPU time of "nginx", "redis", "server-1" ... and its child processes [s].
  double Cpu(const std::string& name) const;
  // Returns a value from a server's /metrics; 0 if it has no metric of that name.
  double Metric(int server, const std::string& name) const;

 private:
  Program& Find(const std::string& name);
  std::string Output() const;

  std::string folder_, trust_;
  int port_ = 0, base_ = 0;
  pid_t script_ = -1;
  std::vector<Program> programs_;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_TESTS_CLUSTER_TRIAL_DEPLOYMENT_H_
