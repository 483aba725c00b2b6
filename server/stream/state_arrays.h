// A session's state as arrays without loss, for programs that step it.
#ifndef PHRENIC_SERVER_STREAM_STATE_ARRAYS_H_
#define PHRENIC_SERVER_STREAM_STATE_ARRAYS_H_

#include <google/protobuf/repeated_field.h>

#include <cstddef>

#include "absl/status/statusor.h"
#include "phrenic/v1/state.pb.h"
#include "server/mechanics/model.h"
#include "server/stream/layout.h"

namespace phrenic::stream {

// Values of v1::StatePart, in any order.
using StateParts = google::protobuf::RepeatedField<int>;

// INVALID_ARGUMENT, naming the field `read`, if a part is STATE_PART_UNSPECIFIED. Validation refuses unknown numbers.
absl::Status CheckParts(const StateParts& parts);

// Returns the bytes of the arrays of MakeStateArrays, without names and without what is the same for every model.
std::size_t StateBytes(const Model& model, const Layout& layout, const StateParts& parts);

// Copies the parts of the state, each once however often it is named. Positions [m], velocities [m/s] and scalars are
// the state's own float64 numbers, bit for bit; bodies are placed as frames place them, float32. INTERNAL if a number
// of a body is not finite as float32. Requires: CheckParts(parts) is OK. Thread-safe.
absl::StatusOr<v1::StateArrays> MakeStateArrays(const Model& model, const Layout& layout, const State& state,
                                                const StateParts& parts);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_STATE_ARRAYS_H_
