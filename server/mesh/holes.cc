#include "server/mesh/holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "absl/strings/str_format.h"
#include "server/mesh/half_edges.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

constexpr size_t kMostVertices = 400;  // of a loop that is closed; time grows with the cube
constexpr double kUnclosable = std::numeric_limits<double>::infinity();

using EdgeSet = std::set<std::pair<int, int>>;

std::pair<int, int> Ends(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

double Diagonal(const Points& points) { return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm(); }

// The boundary edges at each boundary vertex, by the vertex at their other end.
using Borderers = std::map<int, std::vector<int>>;

// Follows boundary edges from `start` towards `next` until no unused one is left.
Hole Follow(int start, int next, const Borderers& borderers, EdgeSet& unused) {
  Hole hole;
  hole.vertices.push_back(start);
  unused.erase(Ends(start, next));
  for (int at = next; at != start;) {
    hole.vertices.push_back(at);
    const std::vector<int>& ways = borderers.at(at);
    const auto way = std::find_if(ways.begin(), ways.end(), [&](int to) { return unused.contains(Ends(at, to)); });
    if (way == ways.end()) break;
    unused.erase(Ends(at, *way));
    at = *way;
  }
  for (const int vertex : hole.vertices) hole.simple = hole.simple && borderers.at(vertex).size() == 2;
  return hole;
}

// Returns by vertex the extent of its component [m].
std::vector<double> ComponentExtents(const Mesh& mesh) {
  std::vector<double> extent(static_cast<size_t>(mesh.vertices.cols()), 0);
  for (const std::vector<int>& component : Components(mesh)) {
    Eigen::AlignedBox3d box;
    for (const int t : component) {
      for (const int vertex : mesh.triangles.col(t)) box.extend(Eigen::Vector3d(mesh.vertices.col(vertex)));
    }
    for (const int t : component) {
      for (const int vertex : mesh.triangles.col(t)) extent[vertex] = box.diagonal().norm();
    }
  }
  return extent;
}

// The triangulation of least area of a closed polygon: cost(i, j) is that of its part from corner i to corner j.
class Patch {
 public:
  Patch(const Mesh& mesh, const std::vector<int>& loop, const EdgeSet& edges)
      : mesh_(mesh), loop_(loop), edges_(edges), size_(static_cast<int>(loop.size())) {
    cost_ = Eigen::MatrixXd::Zero(size_, size_);
    apex_ = Eigen::MatrixXi::Constant(size_, size_, -1);
    for (int width = 2; width < size_; ++width) {
      for (int i = 0; i + width < size_; ++i) Choose(i, i + width);
    }
  }
  bool possible() const { return cost_(0, size_ - 1) < kUnclosable; }
  // Adds the triangles, wound along the loop.
  void Add(std::vector<Eigen::Vector3i>& triangles) const { Add(0, size_ - 1, triangles); }

 private:
  void Choose(int i, int j) {
    const bool side = i == 0 && j == size_ - 1;
    cost_(i, j) = kUnclosable;
    if (!side && edges_.contains(Ends(loop_[i], loop_[j]))) return;
    for (int k = i + 1; k < j; ++k) {
      const double cost = cost_(i, k) + cost_(k, j) + Area(i, k, j);
      if (cost < cost_(i, j)) cost_(i, j) = cost, apex_(i, j) = k;
    }
  }
  double Area(int i, int k, int j) const {
    const Eigen::Vector3d a = mesh_.vertices.col(loop_[i]), b = mesh_.vertices.col(loop_[k]);
    const Eigen::Vector3d c = mesh_.vertices.col(loop_[j]);
    return (b - a).cross(c - a).norm() / 2;
  }
  void Add(int i, int j, std::vector<Eigen::Vector3i>& triangles) const {
    if (j - i < 2) return;
    const int k = apex_(i, j);
    triangles.emplace_back(loop_[i], loop_[k], loop_[j]);
    Add(i, k, triangles);
    Add(k, j, triangles);
  }

  const Mesh& mesh_;
  const std::vector<int>& loop_;
  const EdgeSet& edges_;
  int size_;
  Eigen::MatrixXd cost_;
  Eigen::MatrixXi apex_;
};

void Append(const std::vector<Eigen::Vector3i>& added, Triangles& triangles) {
  const Eigen::Index before = triangles.cols();
  triangles.conservativeResize(3, before + static_cast<Eigen::Index>(added.size()));
  for (size_t t = 0; t < added.size(); ++t) triangles.col(before + static_cast<Eigen::Index>(t)) = added[t];
}

}  // namespace

std::vector<Hole> FindHoles(const Mesh& mesh) {
  Borderers borderers;
  std::map<int, int> against;  // the end of a boundary edge against the winding of its triangle, by its start
  EdgeSet unused;
  ForEachEdge(SortedHalfEdges(mesh.triangles), [&](auto first, auto last) {
    if (last - first != 1) return;
    borderers[first->low].push_back(first->high);
    borderers[first->high].push_back(first->low);
    const auto [from, to] = first->forward ? std::pair(first->high, first->low) : std::pair(first->low, first->high);
    against[from] = to;
    unused.insert(Ends(from, to));
  });
  std::vector<Hole> holes;
  if (unused.empty()) return holes;
  const std::vector<double> extents = ComponentExtents(mesh);
  while (!unused.empty()) {
    const auto [low, high] = *unused.begin();
    const auto ahead = against.find(low);
    const bool wound = ahead != against.end() && unused.contains(Ends(low, ahead->second));
    holes.push_back(Follow(low, wound ? ahead->second : high, borderers, unused));
    Hole& hole = holes.back();
    const Points loop = mesh.vertices(Eigen::all, hole.vertices);
    hole.extent = Diagonal(loop);
    hole.centre = loop.rowwise().mean();
    hole.rim = hole.extent > extents[low] / 2;
  }
  return holes;
}

int CloseHoles(double extent, Mesh& mesh) {
  const std::vector<Hole> holes = FindHoles(mesh);
  EdgeSet edges;
  if (!holes.empty()) {
    const Edges all = TriangleEdges(mesh.triangles);
    for (Eigen::Index e = 0; e < all.cols(); ++e) edges.emplace(all(0, e), all(1, e));
  }
  int closed = 0;
  for (const Hole& hole : holes) {
    if (!hole.simple || hole.rim || hole.extent > extent || hole.vertices.size() > kMostVertices) continue;
    const Patch patch(mesh, hole.vertices, edges);
    if (!patch.possible()) continue;
    std::vector<Eigen::Vector3i> added;
    patch.Add(added);
    Append(added, mesh.triangles);
    for (const Eigen::Vector3i& t : added) edges.insert({Ends(t[0], t[1]), Ends(t[1], t[2]), Ends(t[2], t[0])});
    ++closed;
  }
  return closed;
}

std::string Describe(const Hole& hole, double millimetres_a_unit) {
  const Eigen::Vector3d at = millimetres_a_unit * hole.centre;
  return absl::StrFormat("%s of %d edges, %.1f mm across, at %.0f, %.0f, %.0f mm", hole.rim ? "a rim" : "a hole",
                         hole.vertices.size(), millimetres_a_unit * hole.extent, at[0], at[1], at[2]);
}

}  // namespace phrenic
