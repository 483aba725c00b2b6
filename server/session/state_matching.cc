#include "server/session/state_matching.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/step/bounds.h"
#include "server/mesh/nearest.h"
#include "server/mesh/topology.h"
#include "server/store/saved_state.h"

namespace phrenic::session {
namespace {

constexpr double kSameRest = 1e-5;         // of the model's size
constexpr double kReach = 0.5;             // of a body's mean edge, between matched rest positions
constexpr double kLargestResidual = 1e-3;  // of the model's size

absl::Status Unmatched(const std::string& what) { return absl::FailedPreconditionError(what); }

// Returns the number of vertices in bytes of `size` per coordinate.
Eigen::Index VerticesIn(const std::string& bytes, std::size_t size) {
  return static_cast<Eigen::Index>(bytes.size() / (3 * size));
}

Points RestOf(const v1::SavedBody& saved) {
  Eigen::Matrix3Xf rest(3, VerticesIn(saved.rest(), sizeof(float)));
  std::memcpy(rest.data(), saved.rest().data(), sizeof(float) * static_cast<std::size_t>(rest.size()));
  return rest.cast<double>();
}

const v1::SavedBody* FindBody(const v1::SavedScene& scene, const std::string& name) {
  const auto found =
      std::ranges::find_if(scene.bodies(), [&name](const v1::SavedBody& body) { return body.name() == name; });
  return found == scene.bodies().end() ? nullptr : &*found;
}

Eigen::Index CountOf(const BodyModel& body) { return body.mesh.vertices.cols(); }

// Returns the edges of a body, those of a solid's tetrahedra among them.
Edges EdgesOf(const Mesh& mesh) {
  const Edges surface = SpringEdges(mesh);
  constexpr int kPairs[][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  Edges edges(2, surface.cols() + 6 * mesh.tetrahedra.cols());
  edges.leftCols(surface.cols()) = surface;
  Eigen::Index at = surface.cols();
  for (Eigen::Index t = 0; t < mesh.tetrahedra.cols(); ++t) {
    for (const auto& [a, b] : kPairs) edges.col(at++) << mesh.tetrahedra(a, t), mesh.tetrahedra(b, t);
  }
  return edges;
}

double MeanEdge(const Mesh& mesh) {
  const Edges edges = EdgesOf(mesh);
  if (edges.cols() == 0) return 0;
  double sum = 0;
  for (const auto& edge : edges.colwise()) sum += (mesh.vertices.col(edge[0]) - mesh.vertices.col(edge[1])).norm();
  return sum / static_cast<double>(edges.cols());
}

// Matches a body's vertices, which rest at `rest`, with those of `saved`, of a state of `vertices` vertices.
absl::Status MatchBody(const Model& model, const BodyModel& body, const v1::SavedBody& saved, Eigen::Index vertices,
                       VertexMatch& match) {
  const Points rest = model.rest.middleCols(body.first_vertex, CountOf(body)), before = RestOf(saved);
  const std::string name = absl::StrCat("body \"", body.name, "\"");
  if (before.cols() == 0 || saved.first_vertex() < 0 || saved.first_vertex() + before.cols() > vertices ||
      !before.allFinite()) {
    return Unmatched(absl::StrCat(name, " has no vertices in the saved state"));
  }
  const double tolerance = kSameRest * model.size;
  const bool same = before.cols() == rest.cols() && (rest - before).colwise().norm().maxCoeff() <= tolerance;
  if (same) {
    std::iota(match.saved.begin() + body.first_vertex, match.saved.begin() + body.first_vertex + rest.cols(),
              saved.first_vertex());
    match.same = match.same && saved.first_vertex() == body.first_vertex;
    return absl::OkStatus();
  }
  match.same = false;
  ++match.bodies_by_distance;
  const double reach = std::max(tolerance, kReach * MeanEdge(body.mesh));
  const NearestSearch search(before);
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const Neighbour nearest = search.Nearest(rest.col(i), reach);
    if (nearest.vertex < 0) {
      return Unmatched(absl::StrCat(name, ": no vertex of the saved state rests within ", reach, " m of vertex ", i));
    }
    const Eigen::Index at = body.first_vertex + i;
    match.saved[static_cast<std::size_t>(at)] = saved.first_vertex() + nearest.vertex;
    match.shift.col(at) = rest.col(i) - before.col(nearest.vertex);
    match.largest_distance = std::max(match.largest_distance, nearest.distance);
  }
  return absl::OkStatus();
}

// Of a store without names: the numbers must be as many, and are taken in order.
absl::Status MatchInOrder(Eigen::Index vertices, VertexMatch& match) {
  if (vertices != static_cast<Eigen::Index>(match.saved.size())) {
    return Unmatched(
        absl::StrCat("the saved state has ", vertices, " vertices, and the scene now ", match.saved.size()));
  }
  std::iota(match.saved.begin(), match.saved.end(), 0);
  return absl::OkStatus();
}

absl::Status MatchPoses(const Model& model, const v1::SavedScene& scene, const std::vector<Pose>& saved,
                        std::vector<Pose>& poses) {
  if (scene.bodies().empty()) {
    if (saved.size() != poses.size()) return Unmatched("the scene has another number of driven bodies now");
    poses = saved;
    return absl::OkStatus();
  }
  for (const BodyModel& body : model.bodies) {
    if (body.pose < 0) continue;
    const v1::SavedBody* found = FindBody(scene, body.name);
    if (found == nullptr || found->pose() < 0 || found->pose() >= static_cast<int>(saved.size())) {
      return Unmatched(absl::StrCat("body \"", body.name, "\" was not driven before"));
    }
    poses[static_cast<std::size_t>(body.pose)] = saved[static_cast<std::size_t>(found->pose())];
  }
  return absl::OkStatus();
}

// A coordinate that the other build did not have keeps its initial value.
absl::Status MatchScalars(const Model& model, const v1::SavedScene& scene, const v1::SavedState& saved,
                          ScalarState& scalars) {
  const int count = saved.scalars_size();
  if (saved.scalar_rates_size() != count) return Unmatched("scalars: there are not as many rates as values");
  const bool named = !scene.bodies().empty();
  if (named ? scene.scalars_size() != count : (count > 0 && count != scalars.q.size())) {
    return Unmatched(
        absl::StrCat("the saved state has ", count, " scalar coordinates, and the scene now ", scalars.q.size()));
  }
  for (int i = 0; i < count; ++i) {
    const auto found = std::ranges::find_if(
        model.scalars, [&](const ScalarCoordinate& each) { return named && each.name == scene.scalars(i); });
    if (named && found == model.scalars.end()) {
      return Unmatched(absl::StrCat("the scene has no scalar coordinate \"", scene.scalars(i), "\" now"));
    }
    const Eigen::Index at = named ? found - model.scalars.begin() : i;
    scalars.q[at] = saved.scalars(i);
    scalars.v[at] = saved.scalar_rates(i);
  }
  return absl::OkStatus();
}

// Returns the model's vertex that continues a saved one; -1 if no vertex matches.
int Continues(const VertexMatch& match, int saved) {
  const auto found = std::ranges::find(match.saved, saved);
  return found == match.saved.end() ? -1 : static_cast<int>(found - match.saved.begin());
}

// Returns the lengths of a body's edges in a state, divided by those at rest, sorted.
std::vector<double> Stretches(const Model& model, const BodyModel& body, const State& state) {
  std::vector<double> stretches;
  const Edges edges = EdgesOf(body.mesh);
  stretches.reserve(static_cast<std::size_t>(edges.cols()));
  for (const auto& edge : edges.colwise()) {
    const int a = body.first_vertex + edge[0], b = body.first_vertex + edge[1];
    const double rest = (model.rest.col(a) - model.rest.col(b)).norm();
    if (rest > 0) stretches.push_back((state.x.col(a) - state.x.col(b)).norm() / rest);
  }
  std::ranges::sort(stretches);
  return stretches;
}

bool IsDriven(const Model& model, int vertex) {
  return std::ranges::find(model.driven_vertices, vertex) != model.driven_vertices.end();
}

absl::Status CheckFixed(const Model& model, const State& state) {
  for (const int vertex : model.fixed_vertices) {
    const double distance = (state.x.col(vertex) - model.rest.col(vertex)).norm();
    if (distance <= kLargestResidual * model.size || IsDriven(model, vertex)) continue;
    return Unmatched(absl::StrCat("body \"", model.BodyOf(vertex).name, "\": a fixed vertex would be ", distance,
                                  " m from its place: its vertices have another order now"));
  }
  return absl::OkStatus();
}

// Vertices in a wrong order have edges across the whole body.
absl::Status CheckStretches(const Model& model, const State& state) {
  constexpr double kMedian = 2, kMost = 4;
  for (const BodyModel& body : model.bodies) {
    if (body.first_vertex < 0) continue;
    const std::vector<double> stretches = Stretches(model, body, state);
    if (stretches.empty()) continue;
    const double median = stretches[stretches.size() / 2], most = stretches[stretches.size() * 19 / 20];
    if (median <= kMedian && median >= 1 / kMedian && most <= kMost) continue;
    return Unmatched(absl::StrCat("body \"", body.name, "\": half of its edges would be stretched to ", median,
                                  " of their length and more, a twentieth to ", most,
                                  ": its vertices have another order now"));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<VertexMatch> MatchVertices(const Model& model, const v1::SavedScene& scene,
                                          const v1::SavedState& saved) {
  const Eigen::Index count = model.rest.cols(), vertices = VerticesIn(saved.positions(), sizeof(double));
  VertexMatch match;
  match.saved.assign(static_cast<std::size_t>(count), -1);
  match.shift = Points::Zero(3, count);
  if (scene.bodies().empty()) {
    if (absl::Status status = MatchInOrder(vertices, match); !status.ok()) return status;
    return match;
  }
  for (const BodyModel& body : model.bodies) {
    if (body.first_vertex < 0) continue;
    const v1::SavedBody* found = FindBody(scene, body.name);
    if (found == nullptr) return Unmatched(absl::StrCat("body \"", body.name, "\" was not simulated before"));
    if (absl::Status status = MatchBody(model, body, *found, vertices, match); !status.ok()) return status;
  }
  if (std::ranges::find(match.saved, -1) != match.saved.end()) return Unmatched("a vertex belongs to no body");
  match.same = match.same && vertices == count;
  return match;
}

absl::StatusOr<State> MatchState(const Model& model, const v1::SavedScene& scene, const v1::SavedState& saved,
                                 const VertexMatch& match) {
  const auto read = store::ReadState(saved);
  if (!read.ok()) return Unmatched(std::string(read.status().message()));
  State state = model.InitialState();
  state.time = read->time;
  state.tick = read->tick;
  state.phase = read->phase;
  for (std::size_t i = 0; i < match.saved.size(); ++i) {
    if (match.saved[i] >= read->x.cols()) return Unmatched("the saved state has too few vertices");
    const auto at = static_cast<Eigen::Index>(i);
    state.x.col(at) = read->x.col(match.saved[i]) + match.shift.col(at);
    state.v.col(at) = read->v.col(match.saved[i]);
  }
  if (absl::Status status = MatchPoses(model, scene, read->poses, state.poses); !status.ok()) return status;
  if (absl::Status status = MatchScalars(model, scene, saved, state.scalars); !status.ok()) return status;
  for (VertexPull pull : read->pulls) {
    pull.vertex = Continues(match, pull.vertex);
    if (pull.vertex >= 0) state.pulls.push_back(pull);
  }
  return state;
}

absl::Status CheckState(const Model& model, const State& state, double residual) {
  const bool finite = state.x.allFinite() && state.v.allFinite() && state.scalars.q.allFinite() &&
                      state.scalars.v.allFinite() && std::isfinite(state.time) && std::isfinite(state.phase);
  if (!finite) return Unmatched("the saved state has numbers that are not finite");
  if (!PositionsWithinBounds(model, state.x)) {
    return Unmatched("the saved state is outside the scene's bounds");
  }
  if (absl::Status status = CheckStretches(model, state); !status.ok()) return status;
  if (absl::Status status = CheckFixed(model, state); !status.ok()) return status;
  const ConstraintResidual violated = LargestResidual(model, state);
  if (!(violated.metres > std::max(kLargestResidual * model.size, 2 * residual))) return absl::OkStatus();
  return Unmatched(absl::StrCat("the saved state violates constraint ", std::string(violated.constraint), " by ",
                                violated.metres, " m"));
}

void MatchPulls(const Model& model, const v1::SavedScene& scene, const VertexMatch& match, v1::Session& status) {
  if (match.same) return;
  google::protobuf::RepeatedPtrField<v1::Pull> pulls;
  for (v1::Pull& pull : *status.mutable_pulls()) {
    const v1::SavedBody* saved = FindBody(scene, pull.body());
    if (saved == nullptr || saved->first_vertex() < 0) continue;
    const int vertex = Continues(match, saved->first_vertex() + pull.vertex());
    if (vertex < 0 || model.BodyOf(vertex).name != pull.body()) continue;
    pull.set_vertex(vertex - model.BodyOf(vertex).first_vertex);
    *pulls.Add() = std::move(pull);
  }
  status.mutable_pulls()->Swap(&pulls);
}

}  // namespace phrenic::session
