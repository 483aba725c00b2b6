// A session at one time, as viewers see it.
#ifndef PHRENIC_SERVER_STREAM_FRAME_H_
#define PHRENIC_SERVER_STREAM_FRAME_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "phrenic/v1/frames.pb.h"
#include "server/mechanics/model.h"
#include "server/stream/layout.h"

namespace phrenic::stream {

// A copy of the stepping thread's state. Immutable once shared.
struct Snapshot {
  std::int64_t sequence = 0;  // from 1, for each frame that a session offers
  State state;                // positions in metres
  v1::Parameters parameters;  // at the same tick
  absl::Time made;            // on the server's clock; clients see it as unix_nanos
};

// Computes the positions of every streamed body and every pose of the snapshot. INTERNAL if a number is not finite as
// float32; such a frame is not sent. Positions and poses are little-endian float32 [m], body after body in the order of
// the model (proto/README.md); a pose is a quaternion x, y, z, w and a translation. Adds probes, scalar coordinates and
// measures. Thread-safe, for threads with scratch memory of their own; the publisher's thread calls it.
absl::StatusOr<v1::Frame> MakeFrame(const Model& model, const Layout& layout, const Snapshot& snapshot,
                                    const Scratch& scratch = {});

// Appends the positions of every streamed body and every pose, in the same form. The errors of MakeFrame. Thread-safe
// in the same way.
absl::Status AppendBodies(const Model& model, const Layout& layout, const State& state, std::string& positions,
                          std::string& poses, const Scratch& scratch = {});

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_FRAME_H_
