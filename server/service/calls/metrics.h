// Numbers of the running server, for Prometheus.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_METRICS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_METRICS_H_

#include <prometheus/registry.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "server/cluster/cluster.h"
#include "server/session/table.h"

namespace phrenic::service {

// Any thread may call. No number has the name of a session, a scene or a person.
class Metrics {
 public:
  Metrics();

  // A call that was let in, or refused with this.
  void CountRequest(const absl::Status& outcome);
  // A message that was sent to a viewer [bytes].
  void CountFrame(std::size_t bytes);
  // Numbers of a cluster's server: what it counts, and the calls that went to others. Before anybody asks for the text.
  void Follow(std::function<std::pair<cluster::ClusterCounts, std::int64_t>()> counts);
  // The text that Prometheus reads, with what the table's sessions do now.
  std::string Text(const session::Table& table);

 private:
  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& requests_;
  prometheus::Counter& admitted_;
  prometheus::Counter &frames_, &bytes_;
  void CollectCluster();

  std::function<std::pair<cluster::ClusterCounts, std::int64_t>()> cluster_;  // null: a server by itself
  std::map<std::string, prometheus::Gauge*> of_cluster_;
  prometheus::Gauge &sessions_, &playing_, &viewers_, &step_seconds_, &slowest_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_METRICS_H_
