// The shapes in which bodies were seen to move, as they travel and as both ends have them.
#ifndef PHRENIC_SERVER_STREAM_BASIS_H_
#define PHRENIC_SERVER_STREAM_BASIS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/stream/codec.h"

namespace phrenic::stream {

// Immutable once shared.
struct Basis {
  std::int64_t epoch = 0;
  std::vector<std::string> encoded;  // CODEC_PREDICTED of rest + shape
  std::vector<Floats> shapes;        // as they come out of that, so that both ends have the same bits [m]
};

inline constexpr int kMostShapes = 8;

// Proper orthogonal decomposition of displacements, by the method of snapshots (Sirovich 1987): at most kMostShapes,
// the largest first, each as large as it was in any of them; none whose root mean square is below a micrometre.
std::vector<Floats> FindShapes(const std::vector<Floats>& displacements);

// Each shape through `predicted`, the codec of CODEC_PREDICTED for all streamed vertices. OUT_OF_RANGE where that
// cannot hold one.
absl::StatusOr<Basis> MakeBasis(const Codec& predicted, const Floats& rest, const std::vector<Floats>& shapes,
                                std::int64_t epoch);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_BASIS_H_
