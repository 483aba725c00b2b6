// Makes and encodes frames for viewers, as the publisher's thread does.
#ifndef PHRENIC_TESTS_BENCH_FRAMES_H_
#define PHRENIC_TESTS_BENCH_FRAMES_H_

#include <benchmark/benchmark.h>

#include <memory>

#include "server/stream/encoder.h"
#include "server/stream/layout.h"

namespace phrenic::bench {

// Not thread-safe.
class Frames {
 public:
  explicit Frames(const std::shared_ptr<const Model>& model) : layout_(*model), encoder_(model, layout_) {}

  // Makes a frame of the state and encodes it, within 0.1 mm unless `codec` is exact.
  void Make(const State& state, const v1::Parameters& parameters, v1::Codec codec) {
    snapshot_.sequence += 1;  // another frame, which the encoder has not made
    snapshot_.state = state;
    snapshot_.parameters = parameters;
    benchmark::DoNotOptimize(encoder_.Encode(snapshot_, {.codec = codec}));
  }

 private:
  const stream::Layout layout_;
  stream::Encoder encoder_;
  stream::Snapshot snapshot_;
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_FRAMES_H_
