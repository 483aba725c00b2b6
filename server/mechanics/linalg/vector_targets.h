// Before <hwy/foreach_target.h>: leaves out targets whose vectors have no size that the compiler knows; their machines
// take NEON and the portable path, as do the few that have SSSE3 and no SSE4.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_VECTOR_TARGETS_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_VECTOR_TARGETS_H_

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_VECTOR_TARGETS_H_
