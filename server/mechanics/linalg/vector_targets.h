// To be included before <hwy/foreach_target.h>: disables targets with vectors of a size unknown to the compiler, whose
// machines use NEON or the portable path, and SSSE3, since few machines have SSSE3 without SSE4. Builds with sanitizers
// leave out SSE4 too: a machine that builds them runs AVX2 or AVX-512, and each target costs ten seconds of
// compilation.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_VECTOR_TARGETS_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_VECTOR_TARGETS_H_

#ifdef PHRENIC_SANITIZED
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_SSE4)
#else
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#endif

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_VECTOR_TARGETS_H_
