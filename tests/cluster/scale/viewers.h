// Viewers of a cluster's sessions, each with its own connection.
#ifndef PHRENIC_TESTS_CLUSTER_SCALE_VIEWERS_H_
#define PHRENIC_TESTS_CLUSTER_SCALE_VIEWERS_H_

#include <grpcpp/channel.h>

#include <memory>
#include <string>

#include "tests/bench/streaming/seen.h"

namespace phrenic::cluster {

// Watches a session at 30 frames per second until it is destroyed. `seen` outlives it.
class Viewer {
 public:
  virtual ~Viewer() = default;
};

std::unique_ptr<Viewer> Watch(std::shared_ptr<grpc::Channel> channel, const std::string& session, bench::Seen& seen);

}  // namespace phrenic::cluster

#endif  // PHRENIC_TESTS_CLUSTER_SCALE_VIEWERS_H_
