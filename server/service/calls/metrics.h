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
//
// One per server. AccessGuard counts calls, FrameService messages, and the gateway asks for the text at /metrics.
// Counts begin at zero when the server starts.
class Metrics {
 public:
  // A server's counts in its cluster, and the calls that it forwarded to other servers. Text calls it, on any thread.
  using ClusterSource = std::function<std::pair<cluster::ClusterCounts, std::int64_t>()>;

  Metrics();

  // Counts a call that AccessGuard admitted (OK) or refused. Does not count errors of the services.
  void CountRequest(const absl::Status& outcome);
  // Counts a message to a viewer [bytes].
  void CountFrame(std::size_t bytes);
  // Adds the cluster's metrics. Requires: Text has not been called yet. Call it once at most, before the server
  // listens: it takes no lock.
  void AddCluster(ClusterSource source);
  // Returns all metrics (text format 0.0.4), with gauges that are read from the sessions of `table` now. Looks at 1000
  // sessions at most. When several threads call it, a gauge may show the value that another of them has read.
  std::string Text(const session::Table& table);

 private:
  // Sets the cluster's gauges, if there are any.
  void CollectCluster();

  prometheus::Registry registry_;                      // owns all metrics; first, since the others refer to it
  prometheus::Family<prometheus::Counter>& requests_;  // by outcome: a status code
  prometheus::Counter& admitted_;                      // the outcome OK
  prometheus::Counter &frames_, &bytes_;               // sent to viewers
  // Of all sessions: numbers, CPU time of one step [s], and simulated seconds per second of the slowest that plays.
  prometheus::Gauge &sessions_, &playing_, &viewers_, &step_seconds_, &slowest_;
  ClusterSource cluster_;                                     // null: not in a cluster
  std::map<std::string, prometheus::Gauge*> cluster_gauges_;  // by name; constant after AddCluster
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_METRICS_H_
