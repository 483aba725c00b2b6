// The basis of CODEC_BASIS: displacement shapes that frames are linear combinations of.
#ifndef PHRENIC_SERVER_STREAM_BASIS_H_
#define PHRENIC_SERVER_STREAM_BASIS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/stream/codecs/codec.h"

namespace phrenic::stream {

// Immutable once shared. Viewers that request CODEC_BASIS fetch it once per epoch.
struct Basis {
  std::int64_t epoch = 0;            // from 1; grows with every new basis of a session
  std::vector<std::string> encoded;  // rest + shape, encoded with CODEC_PREDICTED; within 1e-5 m
  std::vector<Floats> shapes;        // decoded from `encoded`, so that server and viewer have the same bits [m]
};

// Most shapes of one basis.
inline constexpr int kMostShapes = 8;

// Returns the proper orthogonal decomposition of displacements [m] by the method of snapshots (Sirovich 1987): at most
// kMostShapes, in descending order, each scaled to its largest amplitude in any snapshot. Omits shapes whose root mean
// square is below 1e-6 m. Every displacement is 3 x n, with the same n. The cost grows with the square of their number.
// Thread-safe.
std::vector<Floats> FindShapes(const std::vector<Floats>& displacements);

// Encodes the shapes with `predicted`, the codec of CODEC_PREDICTED for all streamed vertices. OUT_OF_RANGE if a shape
// exceeds its range. `rest` and the shapes are 3 x n [m], for all streamed vertices. The shapes of the result differ
// from `shapes` by the error of their encoding, which does not add to the error of frames. Thread-safe.
absl::StatusOr<Basis> MakeBasis(const Codec& predicted, const Floats& rest, const std::vector<Floats>& shapes,
                                std::int64_t epoch);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_BASIS_H_
