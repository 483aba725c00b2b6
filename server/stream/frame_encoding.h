// What a viewer's frames hold and how: viewers with equal forms share their bytes.
#ifndef PHRENIC_SERVER_STREAM_FRAME_ENCODING_H_
#define PHRENIC_SERVER_STREAM_FRAME_ENCODING_H_

#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <vector>

#include "phrenic/v1/frames.pb.h"

namespace phrenic::stream {

// Error bounds are those of a ladder, 1, 2 and 5 times powers of ten, so that many viewers make few encodings.
inline constexpr int kDefaultRung = 6;   // 0.1 mm
inline constexpr int kCoarsestRung = 9;  // 1 mm: the furthest that anybody is taken who did not ask for it

// The bound of a rung [mm]: 0.001, 0.002, 0.005, 0.01 ...
inline double RungMillimetres(int rung) {
  constexpr std::array<double, 3> kSteps = {1, 2, 5};
  return kSteps[rung % 3] * std::pow(10.0, rung / 3 - 3);
}

// The coarsest rung that is not above `millimetres`, which are 0.001 or more.
inline int RungWithin(double millimetres) {
  int rung = 0;
  while (RungMillimetres(rung + 1) <= millimetres * (1 + 1e-9)) ++rung;
  return rung;
}

struct FrameEncoding {
  bool numbers_only = false;  // neither positions nor poses
  v1::Codec codec = v1::CODEC_RAW;
  int rung = kDefaultRung;
  bool chosen = false;           // of the bodies' vertices only those of `bodies`
  std::vector<int> bodies = {};  // streamed ones, ascending
  std::int64_t basis_epoch = 0;  // of the basis that the viewer has; of CODEC_BASIS alone

  // clang-tidy takes the zero that a defaulted comparison is held against for a null pointer.
  auto operator<=>(const FrameEncoding&) const = default;  // NOLINT(modernize-use-nullptr)
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_FRAME_ENCODING_H_
