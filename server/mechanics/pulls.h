// Forces by which people pull single vertices while a session runs: f += F on the vertex [N]. They are part of the
// State: a copy of it goes on under the same pulls.
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

inline constexpr int kMostPulls = 64;     // at a time
inline constexpr double kMostPull = 1e6;  // along each axis [N]

// What the list names, in simulated vertices. INVALID_ARGUMENT "pulls[1].vertex: ..." where there is no such body or
// vertex, where it cannot move, or where the force is out of range.
absl::StatusOr<std::vector<VertexPull>> FindPulls(const Model& model, const PullList& list, std::string_view path);

// Each change replaces the pull on its vertex, or lets go of it where its force is zero; `alone` lets go of all others.
// RESOURCE_EXHAUSTED, and no change, where there would be more than kMostPulls.
absl::Status ChangePulls(const std::vector<VertexPull>& changes, bool alone, std::vector<VertexPull>& pulls);

// As people name them.
PullList DescribePulls(const Model& model, const std::vector<VertexPull>& pulls);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_PULLS_H_
