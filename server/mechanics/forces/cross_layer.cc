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

// Adds the nearest vertices of the opposite layer for each selected vertex.
void PairLayers(const ModelBuilder& builder, int b, const Selection& selection, const v1::CrossLayer& scene,
                Pairs& pairs) {
  const BodyModel& body = builder.model.bodies[b];
  const Points normals = VertexNormals(body.mesh.vertices, body.mesh.triangles);
  const NearestSearch& search = builder.Search(b);
  for (int i = 0; i < body.mesh.vertices.cols() && !builder.stop.Stopped(); ++i) {
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

// Adds the nearest vertices of another body for each selected vertex.
void PairBodies(const ModelBuilder& builder, int b, int to, const Selection& selection, const v1::CrossLayer& scene,
                Pairs& pairs) {
  const BodyModel &body = builder.model.bodies[b], &other = builder.model.bodies[to];
  const NearestSearch& search = builder.Search(to);
  for (int i = 0; i < body.mesh.vertices.cols() && !builder.stop.Stopped(); ++i) {
    if (!selection.Takes(std::array{i})) continue;
    int wanted = scene.neighbours();
    for (const Neighbour& near : search.Within(body.mesh.vertices.col(i), scene.distance())) {
      if (near.distance == 0) continue;
      pairs.insert(std::minmax(body.first_vertex + i, other.first_vertex + near.vertex));
      if (--wanted == 0) break;
    }
  }
}

std::unique_ptr<Force> Join(const Pairs& pairs, const std::string& name, double stiffness, ModelBuilder& builder) {
  std::vector<Spring> springs;
  springs.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    springs.push_back({a, b, stiffness, (builder.model.rest.col(a) - builder.model.rest.col(b)).norm()});
  }
  const auto count = static_cast<std::int64_t>(springs.size());
  builder.model.report.set_springs(builder.model.report.springs() + count);
  builder.ReportElement("force", name, count, "springs", absl::StrFormat("k = %g N/m", stiffness));
  return std::make_unique<Springs>(name, std::move(springs));
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> MakeCrossLayer(const v1::CrossLayer& scene, const std::string& given,
                                                      std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "cross-layer", scene.bodies());
  const auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  const auto others = builder.DeformableBodies(scene.other_bodies(), absl::StrCat(std::string(path), ".other_bodies"));
  if (!others.ok()) return others.status();
  Pairs pairs;
  for (const int b : *bodies) {
    const auto selection = builder.Select(b, scene.region(), scene.exclude_region(), path);
    if (!selection.ok()) return selection.status();
    if (others->empty()) PairLayers(builder, b, *selection, scene, pairs);
    for (const int other : *others) {
      if (other != b) PairBodies(builder, b, other, *selection, scene, pairs);
    }
  }
  if (!pairs.empty()) return Join(pairs, name, scene.stiffness(), builder);
  builder.ReportLeftOut(name, absl::StrFormat("no vertex has an opposite one within %g m", scene.distance()));
  return nullptr;
}

}  // namespace phrenic
