// What a viewer's frames contain and how they are encoded. Viewers with equal encodings share the bytes.
#ifndef PHRENIC_SERVER_STREAM_FRAME_ENCODING_H_
#define PHRENIC_SERVER_STREAM_FRAME_ENCODING_H_

#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <vector>

#include "phrenic/v1/frames.pb.h"

namespace phrenic::stream {

// Error bounds are discrete levels, 1, 2 and 5 times powers of ten, so that many viewers need few encodings.
inline constexpr int kDefaultBoundLevel = 6;   // 0.1 mm
inline constexpr int kCoarsestBoundLevel = 9;  // 1 mm: the coarsest bound that flow control chooses

// Returns the bound of a level [mm]: 0.001, 0.002, 0.005, 0.01 ... Requires: bound_level >= 0.
inline double BoundMillimetres(int bound_level) {
  constexpr std::array<double, 3> kSteps = {1, 2, 5};
  return kSteps[bound_level % 3] * std::pow(10.0, bound_level / 3 - 3);
}

// Returns the coarsest level whose bound is not above `millimetres`. Requires: millimetres >= 0.001.
inline int BoundLevelWithin(double millimetres) {
  int bound_level = 0;
  while (BoundMillimetres(bound_level + 1) <= millimetres * (1 + 1e-9)) ++bound_level;
  return bound_level;
}

// Plain data, ordered so that it can be a key. Viewer::encoding makes it from the viewer's request and its flow
// control.
struct FrameEncoding {
  bool numbers_only = false;             // omits positions and poses
  v1::Codec codec = v1::CODEC_RAW;       // of the positions
  int bound_level = kDefaultBoundLevel;  // ignored by CODEC_RAW
  bool chosen = false;                   // true: only the vertices of `bodies`
  std::vector<int> bodies = {};          // streamed ones, ascending
  std::int64_t basis_epoch = 0;          // of the viewer's basis; only for CODEC_BASIS

  // clang-tidy mistakes the zero in a defaulted comparison for a null pointer.
  auto operator<=>(const FrameEncoding&) const = default;  // NOLINT(modernize-use-nullptr)
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_FRAME_ENCODING_H_
