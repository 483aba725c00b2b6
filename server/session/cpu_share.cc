#include "server/session/cpu_share.h"

#include <algorithm>
#include <ctime>

namespace phrenic::session {

void CpuShare::Begin(absl::Time now, absl::Duration cpu) {
  rests_until_ = RestsUntil(now);
  began_ = now;
  cpu_ = cpu;
}

void CpuShare::End(absl::Duration cpu) {
  if (share_ < 1) rests_until_ = std::max(began_, rests_until_) + (cpu - cpu_) / share_;
}

absl::Duration ThreadCpu() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return absl::DurationFromTimespec(time);
}

}  // namespace phrenic::session
