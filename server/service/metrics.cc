#include "server/service/metrics.h"

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

// CPU time of one step [s]; 0 where none was measured.
double StepSeconds(const v1::Pace& pace) {
  return pace.steps_per_second() > 0
             ? pace.cpu_per_simulated_second() * pace.times_real_time() / pace.steps_per_second()
             : 0;
}

}  // namespace

Metrics::Metrics()
    : requests_(prometheus::BuildCounter()
                    .Name("phrenic_requests_total")
                    .Help("Calls by what came of them at the door: OK, or why they were refused")
                    .Register(registry_)),
      admitted_(requests_.Add({{"outcome", "OK"}})),
      frames_(NewCounter(registry_, "phrenic_frames_total", "Messages sent to viewers")),
      bytes_(NewCounter(registry_, "phrenic_frame_bytes_total", "Their bytes")),
      sessions_(NewGauge(registry_, "phrenic_sessions", "Sessions there are")),
      playing_(NewGauge(registry_, "phrenic_sessions_playing", "Sessions that play")),
      viewers_(NewGauge(registry_, "phrenic_viewers", "Viewers of all sessions")),
      step_seconds_(
          NewGauge(registry_, "phrenic_step_cpu_seconds", "CPU time of a step, the dearest playing session's")),
      slowest_(NewGauge(registry_, "phrenic_times_real_time",
                        "Simulated seconds a second, the slowest playing session's")) {}

void Metrics::CountRequest(const absl::Status& outcome) {
  if (outcome.ok()) return admitted_.Increment();
  requests_.Add({{"outcome", absl::StatusCodeToString(outcome.code())}}).Increment();
}

void Metrics::CountFrame(std::size_t bytes) {
  frames_.Increment();
  bytes_.Increment(static_cast<double>(bytes));
}

std::string Metrics::Text(const session::Table& table) {
  constexpr int kAll = 1000;
  int sessions = 0, playing = 0, viewers = 0;
  double step = 0, slowest = std::numeric_limits<double>::infinity();
  for (const auto& session : table.List(kAll, "").sessions) {
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
  return prometheus::TextSerializer().Serialize(registry_.Collect());
}

}  // namespace phrenic::service
