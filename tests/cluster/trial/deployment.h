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

  // With so many servers, on free ports. UNAVAILABLE with what it said.
  absl::Status Start(int servers);
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
