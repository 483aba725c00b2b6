#include "server/anatomy/middle_sheet.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/diaphragm_sheet.h"
#include "server/mesh/locality.h"
#include "server/mesh/renumber.h"
#include "server/mesh/topology.h"

namespace phrenic::anatomy {
namespace {

// Limits of "insertion" and of the hiatus [mm].
constexpr double kCrusFixedBelow = 75;
constexpr double kAortaHalfWidth = 15, kAortaTop = 127, kAortaFront = -30;

bool BridgesAorta(const Eigen::Vector3d& x) {
  return std::abs(x.x()) < kAortaHalfWidth && x.z() > kCrusFixedBelow && x.z() < kAortaTop && x.y() > kAortaFront;
}

Mesh OpenMesh(const Sheet& sheet) {
  Mesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(sheet.points.size()));
  for (size_t i = 0; i < sheet.points.size(); ++i) mesh.vertices.col(static_cast<Eigen::Index>(i)) = sheet.points[i];
  mesh.triangles = sheet.triangles;
  return mesh;
}

// Requires: the openings and the hiatus are closed, so that the border is the rim.
void NameRegions(const Sheet& sheet, Mesh& mesh) {
  for (int i = 0; i < static_cast<int>(sheet.points.size()); ++i) {
    const Eigen::Vector2d& p = sheet.plane[i];
    mesh.regions[InTendon(p) ? "tendon" : "muscle"].push_back(i);
    const bool right = InRightCrus(p), left = InLeftCrus(p);
    if (right) mesh.regions["crus-right"].push_back(i);
    if (left) mesh.regions["crus-left"].push_back(i);
    if ((right || left) && sheet.points[i].z() < kCrusFixedBelow) mesh.regions["insertion"].push_back(i);
  }
  mesh.regions["rim"] = BoundaryVertices(mesh.triangles);
  for (const int i : mesh.regions["rim"]) mesh.regions["insertion"].push_back(i);
}

// Closes an opening with a fan around a new vertex at the loop's centroid.
void Close(const Sheet& sheet, const std::vector<int>& loop, const std::string& region, const std::string& tissue,
           Mesh& mesh) {
  const auto hub = static_cast<int>(mesh.vertices.cols());
  const Eigen::Vector3d centre = mesh.vertices(Eigen::all, loop).rowwise().mean();
  mesh.vertices.conservativeResize(3, hub + 1);
  mesh.vertices.col(hub) = centre;
  const std::unordered_set<int> on_loop(loop.begin(), loop.end());
  Eigen::Index t = mesh.triangles.cols();
  mesh.triangles.conservativeResize(3, t + static_cast<Eigen::Index>(loop.size()));
  for (const auto& [a, b] : BoundaryEdges(sheet)) {
    if (on_loop.contains(a)) mesh.triangles.col(t++) << b, a, hub;
  }
  mesh.regions[region] = loop;
  for (const std::string& name : {region, tissue, std::string("hubs")}) mesh.regions[name].push_back(hub);
}

// Returns the border of the hiatus from one crus over its top to the other, in the winding of the triangles.
std::vector<int> HiatusBorder(const Sheet& sheet) {
  std::unordered_map<int, int> next;
  for (const auto& [a, b] : BoundaryEdges(sheet)) next[a] = b;
  const auto bridges = [&](int i) { return BridgesAorta(sheet.points[i]); };
  int first = sheet.loops[kRimLoop].front();
  while (bridges(first) || !bridges(next.at(first))) first = next.at(first);
  std::vector<int> border = {first};
  do {
    border.push_back(next.at(border.back()));
  } while (bridges(border.back()));
  return border;
}

// Closes the hiatus with a strip of triangles from one crus to the other, which has no vertices of its own. The next
// triangle is the one with the shorter new edge.
void CloseHiatus(const Sheet& sheet, Mesh& mesh) {
  const std::vector<int> border = HiatusBorder(sheet);
  const auto length = [&](size_t i, size_t j) { return (sheet.points[border[i]] - sheet.points[border[j]]).norm(); };
  Eigen::Index t = mesh.triangles.cols();
  mesh.triangles.conservativeResize(3, t + static_cast<Eigen::Index>(border.size()) - 2);
  size_t i = 0, j = border.size() - 1;
  while (j - i > 1) {
    if (length(i + 1, j) < length(i, j - 1)) {
      mesh.triangles.col(t++) << border[i + 1], border[i], border[j];
      ++i;
    } else {
      mesh.triangles.col(t++) << border[j], border[j - 1], border[i];
      --j;
    }
  }
  mesh.regions["aortic-hiatus"] = border;
}

// Renumbers vertices so that neighbours are close in memory, and sorts triangles by their lowest vertex.
Mesh Renumbered(Mesh mesh) {
  const std::vector<int> order =
      CuthillMcKeeOrder(TriangleEdges(mesh.triangles), static_cast<int>(mesh.vertices.cols()));
  std::vector<int> number(order.size());
  for (size_t i = 0; i < order.size(); ++i) number[order[i]] = static_cast<int>(i);
  mesh.vertices = Points(mesh.vertices(Eigen::all, order));
  RenumberVertices(number, mesh);
  std::vector<int> sorted(static_cast<size_t>(mesh.triangles.cols()));
  std::iota(sorted.begin(), sorted.end(), 0);
  const auto lowest = [&](int t) { return mesh.triangles.col(t).minCoeff(); };
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return lowest(a) < lowest(b); });
  mesh.triangles = Triangles(mesh.triangles(Eigen::all, sorted));
  return mesh;
}

}  // namespace

Mesh MiddleSheet(double edge_length) {
  const Sheet sheet = DiaphragmSheet(edge_length);
  Mesh mesh = OpenMesh(sheet);
  Close(sheet, sheet.loops[kCavalLoop], "caval-opening", "tendon", mesh);
  Close(sheet, sheet.loops[kOesophagealLoop], "oesophageal-opening", "muscle", mesh);
  CloseHiatus(sheet, mesh);
  NameRegions(sheet, mesh);
  return Renumbered(std::move(mesh));
}

}  // namespace phrenic::anatomy
