// Which numbers of a saved state belong to which of a model, and the model's state made of them.
#ifndef PHRENIC_SERVER_SESSION_STATE_MATCHING_H_
#define PHRENIC_SERVER_SESSION_STATE_MATCHING_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/saved.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::session {

// Of each simulated vertex of a model, the vertex of a saved state that it continues. n is the number of simulated
// vertices. Saved rest positions are 3 little-endian floats a vertex [m], those of states 3 doubles (saved.proto).
struct VertexMatch {
  std::vector<int> saved;       // by simulated vertex of the model
  Points shift;                 // its rest position less that of the saved vertex, 3 x n [m]
  bool same = true;             // every vertex has its index, and no rest position is known to have changed
  int bodies_by_distance = 0;   // bodies matched by nearest rest positions
  double largest_distance = 0;  // between matched rest positions [m]
};

// FAILED_PRECONDITION names the body or the number that does not match. Bodies match by name. A scene without bodies
// (store format 2) matches in order, if the numbers of vertices agree. Thread-safe, as all functions here.
absl::StatusOr<VertexMatch> MatchVertices(const Model& model, const v1::SavedScene& scene, const v1::SavedState& saved);

// Returns the model's state that continues a saved one; integrators begin without their memory of earlier steps.
// FAILED_PRECONDITION as above. Velocities are taken unchanged, positions with the shift of the rest positions [m]. A
// scalar coordinate that was not saved keeps its initial value; pulls on vertices that are gone are dropped.
absl::StatusOr<State> MatchState(const Model& model, const v1::SavedScene& scene, const v1::SavedState& saved,
                                 const VertexMatch& match);

// Returns FAILED_PRECONDITION unless the state is finite and within the model's bounds, edges have plausible lengths,
// fixed vertices are in their places, and no constraint is violated by more than a thousandth of the model's size, or
// twice `residual` [m]. `residual` is that of the saved status. Edge lengths are plausible if the median of stretched
// over rest length is within 1/2 to 2, and 95 % of them are at most 4.
absl::Status CheckState(const Model& model, const State& state, double residual);

// Gives the pulls of a saved status the indices of the model's vertices. Removes those of vertices that are gone. Does
// nothing if match.same.
void MatchPulls(const Model& model, const v1::SavedScene& scene, const VertexMatch& match, v1::Session& status);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_STATE_MATCHING_H_
