// The springs' force as one would write it down: an array of springs, each pulling at both its ends. What the server's
// own is held against, in time (tests/bench) and in value (tests/mechanics).
#ifndef PHRENIC_TESTS_BENCH_PLAIN_SPRINGS_H_
#define PHRENIC_TESTS_BENCH_PLAIN_SPRINGS_H_

#include <cmath>
#include <vector>

#include "server/mechanics/forces/spring_rows.h"

namespace phrenic {

// f += scale times the pulls of all springs [N], 3 x n.
inline void AddPlainSprings(const std::vector<Spring>& springs, double scale, const Points& x, Points& f) {
  const double* const position = x.data();
  double* const force = f.data();
  for (const Spring& spring : springs) {
    const double* const a = position + 3 * static_cast<std::ptrdiff_t>(spring.a);
    const double* const b = position + 3 * static_cast<std::ptrdiff_t>(spring.b);
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double pull = length > 0 ? scale * spring.stiffness * (1 - spring.rest_length / length) : 0;
    double* const fa = force + 3 * static_cast<std::ptrdiff_t>(spring.a);
    double* const fb = force + 3 * static_cast<std::ptrdiff_t>(spring.b);
    fa[0] += pull * dx, fa[1] += pull * dy, fa[2] += pull * dz;
    fb[0] -= pull * dx, fb[1] -= pull * dy, fb[2] -= pull * dz;
  }
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_BENCH_PLAIN_SPRINGS_H_
