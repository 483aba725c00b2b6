#include "server/session/pace_meter.h"

#include "server/schema/thread_cpu.h"

namespace phrenic::session {
namespace {

constexpr absl::Duration kWindow = absl::Seconds(1);

}  // namespace

void PaceMeter::Start(absl::Time now, std::int64_t tick, double time) {
  start_ = now;
  start_tick_ = tick;
  start_time_ = time;
  start_cpu_ = ThreadCpuSeconds();
}

bool PaceMeter::Update(absl::Time now, std::int64_t tick, double time, bool last) {
  const double wall = absl::ToDoubleSeconds(now - start_);
  const double simulated = time - start_time_;
  if (wall <= 0 || simulated <= 0 || (now - start_ < kWindow && !last)) return false;
  pace_.set_steps_per_second(static_cast<double>(tick - start_tick_) / wall);
  pace_.set_times_real_time(simulated / wall);
  pace_.set_cpu_per_simulated_second((ThreadCpuSeconds() - start_cpu_) / simulated);
  Start(now, tick, time);
  return true;
}

}  // namespace phrenic::session
