// Forces with which users pull single vertices while a session runs: f += F on the vertex [N]. They are part of the
// State: a copy continues under the same pulls.
#ifndef PHRENIC_SERVER_MECHANICS_PULLS_H_
#define PHRENIC_SERVER_MECHANICS_PULLS_H_

#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "google/protobuf/repeated_ptr_field.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/model.h"

namespace phrenic {

using PullList = google::protobuf::RepeatedPtrField<v1::Pull>;

inline constexpr int kMostPulls = 64;     // at the same time
inline constexpr double kMostPull = 1e6;  // along each axis [N]

// Returns the listed pulls on simulated vertices. A pull on a seen body that is bound to the triangles of a deformable
// one (SKIN_MODE_SHEET, SKIN_MODE_TRIANGLES) acts on the nearest corner of the vertex' triangle. INVALID_ARGUMENT
// "pulls[1].vertex: ..." if there is no such body or vertex, if it cannot move, or if the force is out of range.
absl::StatusOr<std::vector<VertexPull>> FindPulls(const Model& model, const PullList& list, std::string_view path);

// Replaces the pull on the vertex of each change, or removes it if the force is zero; removes all others if `alone`.
// RESOURCE_EXHAUSTED, and no change, if there would be more than kMostPulls.
absl::Status ChangePulls(const std::vector<VertexPull>& changes, bool alone, std::vector<VertexPull>& pulls);

// Returns the pulls by body and vertex.
PullList DescribePulls(const Model& model, const std::vector<VertexPull>& pulls);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_PULLS_H_
