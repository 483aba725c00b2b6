#include "server/mechanics/forces/cross_layer.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/forces/springs.h"
#include "server/mesh/nearest.h"
#include "server/mesh/normals.h"

namespace phrenic {
namespace {

using Pairs = std::set<std::pair<int, int>>;  // of simulated vertices

// The nearest vertices of the opposite layer for each vertex that takes part.
void PairLayers(const Draft& draft, int b, const Selection& selection, const v1::CrossLayer& scene, Pairs& pairs) {
  const BodyModel& body = draft.model.bodies[b];
  const Points normals = VertexNormals(body.mesh.vertices, body.mesh.triangles);
  const NearestSearch& search = draft.Search(b);
  for (int i = 0; i < body.mesh.vertices.cols(); ++i) {
    int wanted = scene.neighbours();
    for (const Neighbour& other : search.Within(body.mesh.vertices.col(i), scene.distance())) {
      const int j = other.vertex;
      if (other.distance == 0 || normals.col(i).dot(normals.col(j)) >= 0) continue;
      if (!selection.Takes(std::array{i, j})) continue;
      pairs.insert(std::minmax(body.first_vertex + i, body.first_vertex + j));
      if (--wanted == 0) break;
    }
  }
}

// The nearest vertices of another body for each vertex that takes part.
void PairBodies(const Draft& draft, int b, int to, const Selection& selection, const v1::CrossLayer& scene,
                Pairs& pairs) {
  const BodyModel &body = draft.model.bodies[b], &other = draft.model.bodies[to];
  const NearestSearch& search = draft.Search(to);
  for (int i = 0; i < body.mesh.vertices.cols(); ++i) {
    if (!selection.Takes(std::array{i})) continue;
    int wanted = scene.neighbours();
    for (const Neighbour& near : search.Within(body.mesh.vertices.col(i), scene.distance())) {
      if (near.distance == 0) continue;
      pairs.insert(std::minmax(body.first_vertex + i, other.first_vertex + near.vertex));
      if (--wanted == 0) break;
    }
  }
}

std::unique_ptr<Force> Join(const Pairs& pairs, const std::string& name, double stiffness, Draft& draft) {
  std::vector<Spring> springs;
  springs.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    springs.push_back({a, b, stiffness, (draft.model.rest.col(a) - draft.model.rest.col(b)).norm()});
  }
  const auto count = static_cast<std::int64_t>(springs.size());
  draft.model.report.set_springs(draft.model.report.springs() + count);
  draft.ReportElement("force", name, count, "springs", absl::StrFormat("k = %g N/m", stiffness));
  return std::make_unique<Springs>(name, std::move(springs));
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> MakeCrossLayer(const v1::CrossLayer& scene, const std::string& given,
                                                      std::string_view path, Draft& draft) {
  const std::string name = ElementName(given, "cross-layer", scene.bodies());
  const auto bodies = draft.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  const auto others = draft.DeformableBodies(scene.other_bodies(), absl::StrCat(std::string(path), ".other_bodies"));
  if (!others.ok()) return others.status();
  Pairs pairs;
  for (const int b : *bodies) {
    const auto selection = draft.Select(b, scene.region(), scene.exclude_region(), path);
    if (!selection.ok()) return selection.status();
    if (others->empty()) PairLayers(draft, b, *selection, scene, pairs);
    for (const int other : *others) {
      if (other != b) PairBodies(draft, b, other, *selection, scene, pairs);
    }
  }
  if (!pairs.empty()) return Join(pairs, name, scene.stiffness(), draft);
  draft.ReportLeftOut(name, absl::StrFormat("no vertex has an opposite one within %g m", scene.distance()));
  return nullptr;
}

}  // namespace phrenic
