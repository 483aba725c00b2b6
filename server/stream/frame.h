// A session at one time, as viewers see it.
#ifndef PHRENIC_SERVER_STREAM_FRAME_H_
#define PHRENIC_SERVER_STREAM_FRAME_H_

#include <cstdint>
#include <string>
#include <vector>

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

// Returns the poses, probes, scalar coordinates and measures of the snapshot: all of a frame but positions. INTERNAL if
// a number is not finite, or a simulated position as float32; such a frame is not sent. A pose is a quaternion
// x, y, z, w and a translation, little-endian float32 [m]. Thread-safe, for threads with scratch memory of their own;
// the publisher's thread calls it.
absl::StatusOr<v1::Frame> MakeNumbers(const Model& model, const Snapshot& snapshot, const Scratch& scratch = {});

// Sets the positions of streamed bodies as float32 [m] in `positions`, which holds 3 x layout.vertices() of all
// streamed bodies in the order of the model. INTERNAL if one is not finite. Thread-safe in the same way.
absl::Status PlaceBodies(const Model& model, const Layout& layout, const State& state, const std::vector<int>& bodies,
                         float* positions, const Scratch& scratch = {});

// Returns the numbers and the positions of every streamed body, little-endian float32 (proto/README.md). The errors of
// both. Thread-safe in the same way.
absl::StatusOr<v1::Frame> MakeFrame(const Model& model, const Layout& layout, const Snapshot& snapshot,
                                    const Scratch& scratch = {});

// Appends the positions of every streamed body and every pose, in the same form. The errors of PlaceBodies.
// Thread-safe in the same way.
absl::Status AppendBodies(const Model& model, const Layout& layout, const State& state, std::string& positions,
                          std::string& poses, const Scratch& scratch = {});

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_FRAME_H_
