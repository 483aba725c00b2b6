#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "server/mesh/fans.h"
#include "server/mesh/repair.h"

namespace phrenic {
namespace {

// Returns by vertex the fans there, each a list of corners, the largest fan first.
std::vector<std::vector<std::vector<int>>> FansByVertex(const Mesh& mesh) {
  const std::vector<int> fan = CornerFans(mesh.triangles, true);
  std::map<std::pair<int, int>, std::vector<int>> corners;  // by vertex and fan
  for (int corner = 0; corner < static_cast<int>(fan.size()); ++corner) {
    corners[{mesh.triangles(corner % 3, corner / 3), fan[corner]}].push_back(corner);
  }
  std::vector<std::vector<std::vector<int>>> fans(static_cast<size_t>(mesh.vertices.cols()));
  for (auto& [key, of_fan] : corners) fans[key.first].push_back(std::move(of_fan));
  for (auto& at : fans) {
    std::stable_sort(at.begin(), at.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  }
  return fans;
}

// Returns the direction from a vertex to the mean of the centroids of a fan's triangles, of a length of 1 or 0.
Eigen::Vector3d IntoFan(const Mesh& mesh, int vertex, const std::vector<int>& corners) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int corner : corners) {
    for (const int other : mesh.triangles.col(corner / 3)) sum += mesh.vertices.col(other) - mesh.vertices.col(vertex);
  }
  return sum.normalized();
}

}  // namespace

int SplitPinches(double apart, Mesh& mesh) {
  if (mesh.tetrahedra.cols() > 0 || mesh.edges.cols() > 0) return 0;
  const std::vector<std::vector<std::vector<int>>> fans = FansByVertex(mesh);
  std::vector<Eigen::Vector3d> added;
  std::vector<int> copy_of;
  const auto first_new = static_cast<int>(mesh.vertices.cols());
  for (int vertex = 0; vertex < first_new; ++vertex) {
    for (size_t f = 1; f < fans[vertex].size(); ++f) {
      const Eigen::Vector3d into = IntoFan(mesh, vertex, fans[vertex][f]);
      added.push_back(mesh.vertices.col(vertex) + static_cast<double>(f) * apart * into);
      copy_of.push_back(vertex);
    }
  }
  if (added.empty()) return 0;
  int next = first_new;
  for (int vertex = 0; vertex < first_new; ++vertex) {
    for (size_t f = 1; f < fans[vertex].size(); ++f, ++next) {
      for (const int corner : fans[vertex][f]) mesh.triangles(corner % 3, corner / 3) = next;
    }
  }
  mesh.vertices.conservativeResize(3, next);
  for (size_t i = 0; i < added.size(); ++i) mesh.vertices.col(first_new + static_cast<Eigen::Index>(i)) = added[i];
  for (auto& [name, region] : mesh.regions) {
    for (size_t i = 0; i < copy_of.size(); ++i) {
      const bool in = std::find(region.begin(), region.end(), copy_of[i]) != region.end();
      if (in) region.push_back(first_new + static_cast<int>(i));
    }
  }
  return next - first_new;
}

}  // namespace phrenic
