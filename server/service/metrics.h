// Numbers of the running server, for Prometheus.
#ifndef PHRENIC_SERVER_SERVICE_METRICS_H_
#define PHRENIC_SERVER_SERVICE_METRICS_H_

#include <prometheus/registry.h>

#include <cstdint>
#include <string>

#include "absl/status/status.h"
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
  // The text that Prometheus reads, with what the table's sessions do now.
  std::string Text(const session::Table& table);

 private:
  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& requests_;
  prometheus::Counter& admitted_;
  prometheus::Counter &frames_, &bytes_;
  prometheus::Gauge &sessions_, &playing_, &viewers_, &step_seconds_, &slowest_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_METRICS_H_
