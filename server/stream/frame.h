// A session at one time, as viewers see it.
#ifndef PHRENIC_SERVER_STREAM_FRAME_H_
#define PHRENIC_SERVER_STREAM_FRAME_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "phrenic/v1/frames.pb.h"
#include "server/mechanics/model.h"
#include "server/stream/layout.h"

namespace phrenic::stream {

// A copy of the stepping thread's state. Immutable once shared.
struct Snapshot {
  std::int64_t sequence = 0;
  State state;
  v1::Parameters parameters;
  absl::Time made;
};

// Computes the positions of every streamed body and every pose of the snapshot. INTERNAL if a number is not finite as
// float32; such a frame is not sent.
absl::StatusOr<v1::Frame> MakeFrame(const Model& model, const Layout& layout, const Snapshot& snapshot);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_FRAME_H_
