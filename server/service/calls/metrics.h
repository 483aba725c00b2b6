// The metrics of the running server in Prometheus' text format.
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

// Thread-safe. No metric or label contains the name of a session, a scene or a person.
class Metrics {
 public:
  // A server's counts in its cluster, and the calls that it forwarded to other servers.
  using ClusterSource = std::function<std::pair<cluster::ClusterCounts, std::int64_t>()>;

  Metrics();

  // Counts a call that AccessGuard admitted (OK) or refused.
  void CountRequest(const absl::Status& outcome);
  // Counts a message to a viewer [bytes].
  void CountFrame(std::size_t bytes);
  // Adds the cluster's metrics. Requires: Text has not been called yet.
  void AddCluster(ClusterSource source);
  // Returns all metrics (text format 0.0.4), with gauges that are read from the sessions of `table` now.
  std::string Text(const session::Table& table);

 private:
  void CollectCluster();

  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& requests_;
  prometheus::Counter& admitted_;
  prometheus::Counter &frames_, &bytes_;
  prometheus::Gauge &sessions_, &playing_, &viewers_, &step_seconds_, &slowest_;
  ClusterSource cluster_;  // null: not in a cluster
  std::map<std::string, prometheus::Gauge*> cluster_gauges_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_METRICS_H_
