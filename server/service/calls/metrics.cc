#include "server/service/calls/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <limits>

namespace phrenic::service {
namespace {

prometheus::Counter& NewCounter(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry).Add({});
}

prometheus::Gauge& NewGauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
}

// Returns the CPU time of one step [s]; 0 if it has not been measured.
double StepSeconds(const v1::Pace& pace) {
  return pace.steps_per_second() > 0
             ? pace.cpu_per_simulated_second() * pace.times_real_time() / pace.steps_per_second()
             : 0;
}

}  // namespace

Metrics::Metrics()
    : requests_(prometheus::BuildCounter()
                    .Name("phrenic_requests_total")
                    .Help("Calls by outcome at the access guard: OK, or the status code of the refusal")
                    .Register(registry_)),
      admitted_(requests_.Add({{"outcome", "OK"}})),
      frames_(NewCounter(registry_, "phrenic_frames_total", "Frame messages sent to viewers")),
      bytes_(NewCounter(registry_, "phrenic_frame_bytes_total", "Bytes of frame messages sent to viewers")),
      sessions_(NewGauge(registry_, "phrenic_sessions", "Sessions on this server")),
      playing_(NewGauge(registry_, "phrenic_sessions_playing", "Sessions that are playing")),
      viewers_(NewGauge(registry_, "phrenic_viewers", "Viewers of all sessions")),
      step_seconds_(
          NewGauge(registry_, "phrenic_step_cpu_seconds", "CPU time of one step [s], maximum over playing sessions")),
      slowest_(NewGauge(registry_, "phrenic_times_real_time",
                        "Simulated seconds per second, minimum over playing sessions")) {}

void Metrics::CountRequest(const absl::Status& outcome) {
  if (outcome.ok()) return admitted_.Increment();
  requests_.Add({{"outcome", absl::StatusCodeToString(outcome.code())}}).Increment();
}

void Metrics::CountFrame(std::size_t bytes) {
  frames_.Increment();
  bytes_.Increment(static_cast<double>(bytes));
}

void Metrics::AddCluster(ClusterSource source) {
  cluster_ = std::move(source);
  for (const auto& [name, help] :
       {std::pair("phrenic_cluster_sessions", "Sessions whose lease this server holds"),
        {"phrenic_cluster_servers", "Servers of the cluster that accept sessions"},
        {"phrenic_cluster_reached", "1 if Redis answered the last request, 0 if not"},
        {"phrenic_cluster_taken", "Sessions that this server took over from others since it started"},
        {"phrenic_cluster_lost", "Sessions whose lease this server lost to another server since it started"},
        {"phrenic_cluster_forwarded", "Calls forwarded to other servers since this one started"}}) {
    cluster_gauges_[name] = &NewGauge(registry_, name, help);
  }
}

void Metrics::CollectCluster() {
  if (!cluster_) return;
  const auto [counts, forwarded] = cluster_();
  for (const auto& [name, value] : {std::pair("sessions", static_cast<double>(counts.owned)),
                                    {"servers", static_cast<double>(counts.servers)},
                                    {"reached", counts.redis_reachable ? 1.0 : 0.0},
                                    {"taken", static_cast<double>(counts.taken_over)},
                                    {"lost", static_cast<double>(counts.lost)},
                                    {"forwarded", static_cast<double>(forwarded)}}) {
    cluster_gauges_.at(std::string("phrenic_cluster_") + name)->Set(value);
  }
}

std::string Metrics::Text(const session::Table& table) {
  constexpr int kMaxListed = 1000;
  int sessions = 0, playing = 0, viewers = 0;
  double step = 0, slowest = std::numeric_limits<double>::infinity();
  for (const auto& session : table.List(kMaxListed, "").sessions) {
    const v1::Session status = session->status();
    ++sessions;
    viewers += status.viewers();
    if (status.state() != v1::SESSION_STATE_PLAYING) continue;
    ++playing;
    step = std::max(step, StepSeconds(status.pace()));
    slowest = std::min(slowest, status.pace().times_real_time());
  }
  sessions_.Set(sessions);
  playing_.Set(playing);
  viewers_.Set(viewers);
  step_seconds_.Set(step);
  slowest_.Set(playing > 0 ? slowest : 0);
  CollectCluster();
  return prometheus::TextSerializer().Serialize(registry_.Collect());
}

}  // namespace phrenic::service
