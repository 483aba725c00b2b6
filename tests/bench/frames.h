// Makes and encodes frames for viewers, as the publisher's thread does.
#ifndef PHRENIC_TESTS_BENCH_FRAMES_H_
#define PHRENIC_TESTS_BENCH_FRAMES_H_

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "server/stream/encoder.h"
#include "server/stream/geometry.h"
#include "server/stream/layout.h"

namespace phrenic::bench {

// Not thread-safe.
class Frames {
 public:
  explicit Frames(const std::shared_ptr<const Model>& model) : layout_(*model), encoder_(model, layout_) {
    for (int body = 0; body < static_cast<int>(model->bodies.size()); ++body) {
      if (layout_.placement(body) != v1::PLACEMENT_STREAMED) continue;
      if (stream::MakeGeometry(*model, layout_, body).opacity() > 0) seen_.push_back(body);
    }
  }

  // Makes a frame of the state and encodes it, within 0.1 mm unless `codec` is exact; of the bodies that the scene does
  // not hide, which are those that a page asks for at first, if `seen`.
  void Make(const State& state, const v1::Parameters& parameters, v1::Codec codec, bool seen = false) {
    snapshot_.sequence += 1;  // another frame, which the encoder has not made
    snapshot_.state = state;
    snapshot_.parameters = parameters;
    stream::FrameEncoding encoding = {.codec = codec, .chosen = seen};
    if (seen) encoding.bodies = seen_;
    benchmark::DoNotOptimize(encoder_.Encode(snapshot_, encoding));
  }

 private:
  const stream::Layout layout_;
  stream::Encoder encoder_;
  std::vector<int> seen_;
  stream::Snapshot snapshot_;
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_FRAMES_H_
