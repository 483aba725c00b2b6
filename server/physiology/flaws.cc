#include "server/physiology/flaws.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/mesh/nearest.h"
#include "server/mesh/normals.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"

namespace phrenic::physiology {
namespace {

constexpr double kRibDepth = 0.0005, kLungDepth = 0.001;  // [m]
constexpr double kReach = 0.02;                           // of the search behind a surface [m]
constexpr double kCell = 0.004;                           // [m]
constexpr double kThickest = 0.008;                       // of the sheet at rest [m]

}  // namespace

FlawFinder::FlawFinder(const Model& model, const Parts& parts, const Columns& columns)
    : model_(model), parts_(parts), columns_(columns) {
  const auto tree = [&model](int body) {
    return TriangleTree(model.bodies[body].mesh.vertices, model.bodies[body].mesh.triangles);
  };
  closed_ = BoundaryVertices(model.bodies[parts.sheet].mesh.triangles).empty();
  sheet_ = tree(parts.sheet);
  if (parts.muscle >= 0) muscle_ = tree(parts.muscle);
  for (const int b : parts.lungs) lungs_.push_back(tree(b));
  if (closed_) PairLayers();
}

void FlawFinder::PairLayers() {
  const Mesh& sheet = model_.bodies[parts_.sheet].mesh;
  const Points normals = VertexNormals(sheet.vertices, sheet.triangles);
  const NearestSearch search(sheet.vertices);
  for (int i = 0; i < static_cast<int>(sheet.vertices.cols()); ++i) {
    for (const Neighbour& other : search.Within(sheet.vertices.col(i), kThickest)) {
      const Eigen::Vector3d across = sheet.vertices.col(i) - sheet.vertices.col(other.vertex);
      if (normals.col(i).dot(normals.col(other.vertex)) > -0.7) continue;
      if (across.dot(normals.col(i)) > 0.7 * other.distance) pairs_.emplace_back(i, other.vertex);
      break;
    }
  }
}

int FlawFinder::CrossedLayers(const Points& sheet) const {
  const Points normals = VertexNormals(sheet, model_.bodies[parts_.sheet].mesh.triangles);
  int crossed = 0;
  for (const auto& [i, j] : pairs_) crossed += (sheet.col(i) - sheet.col(j)).dot(normals.col(i)) < 0 ? 1 : 0;
  return crossed;
}

FlawFinder::Surface FlawFinder::Fitted(const TriangleTree& tree, Points x) {
  Surface surface{std::move(x), &tree, {}};
  tree.Fit(surface.x, surface.boxes);
  return surface;
}

bool FlawFinder::Surface::Hides(const Eigen::Vector3d& point, double depth) const {
  const SurfacePoint nearest = tree->Nearest(x, boxes, point, kReach);
  if (nearest.triangle < 0 || nearest.on_boundary || nearest.facing <= 0) return false;
  return nearest.squared > depth * depth;
}

std::vector<FlawFinder::Surface> FlawFinder::Sheet(const State& state) const {
  std::vector<Surface> surfaces;
  if (closed_) surfaces.push_back(Fitted(sheet_, Placed(model_, state, parts_.sheet)));
  if (parts_.muscle >= 0 && (!closed_ || parts_.muscle != parts_.sheet)) {
    surfaces.push_back(Fitted(muscle_, Placed(model_, state, parts_.muscle)));
  }
  return surfaces;
}

int FlawFinder::Through(const std::vector<Surface>& sheet, const ConstPoints& points, double depth) const {
  int count = 0;
  for (const auto point : points.colwise()) {
    count += std::any_of(sheet.begin(), sheet.end(), [&](const Surface& each) { return each.Hides(point, depth); });
  }
  return count;
}

Points FlawFinder::Ribs(const State& state) const {
  Eigen::Index count = 0;
  for (const int b : parts_.ribs) count += model_.bodies[b].mesh.vertices.cols();
  Points all(3, count);
  Eigen::Index at = 0;
  for (const int b : parts_.ribs) {
    const Points rib = Placed(model_, state, b);
    all.middleCols(at, rib.cols()) = rib;
    at += rib.cols();
  }
  return all;
}

// Vertices of the lungs through the sheet, and of ribs inside the lungs.
int FlawFinder::PiercingLungs(const State& state, const std::vector<Surface>& sheet, const Points& ribs) const {
  int count = 0;
  for (size_t l = 0; l < lungs_.size(); ++l) {
    std::vector<Surface> lung;
    lung.push_back(Fitted(lungs_[l], Placed(model_, state, parts_.lungs[l])));
    count += Through(sheet, lung.front().x, kLungDepth) + Through(lung, ribs, kLungDepth);
  }
  return count;
}

FlawValues FlawFinder::At(const State& state) const {
  FlawValues flaws;
  flaws.fill(kNone);
  const Points x = Placed(model_, state, parts_.sheet), ribs = Ribs(state);
  const std::vector<Surface> sheet = Sheet(state);
  flaws[kSelfCrossings] = SelfCrossings(x, model_.bodies[parts_.sheet].mesh.triangles, kCell);
  if (!pairs_.empty()) flaws[kCrossedLayers] = CrossedLayers(x);
  if (!parts_.ribs.empty()) flaws[kPiercingRibs] = Through(sheet, ribs, kRibDepth);
  if (!parts_.lungs.empty()) flaws[kPiercingLungs] = PiercingLungs(state, sheet, ribs);
  flaws[kHollow] = std::max(columns_.Hollow(x, v1::SIDE_RIGHT), columns_.Hollow(x, v1::SIDE_LEFT));
  return flaws;
}

}  // namespace phrenic::physiology
