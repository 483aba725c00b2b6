#include "server/session/cpu_share.h"

#include <algorithm>

namespace phrenic::session {

void CpuShare::Begin(absl::Time now, absl::Duration cpu) {
  rests_until_ = RestsUntil(now);
  began_ = now;
  cpu_ = cpu;
}

void CpuShare::End(absl::Duration cpu) {
  if (share_ < 1) rests_until_ = std::max(began_, rests_until_) + (cpu - cpu_) / share_;
}

}  // namespace phrenic::session
