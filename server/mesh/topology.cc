#include "server/mesh/topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "server/mesh/fans.h"
#include "server/mesh/half_edges.h"

namespace phrenic {
namespace {

constexpr double kSmallestArea = 1e-14;  // [m^2]

// Returns the representative of i in a union-find forest, halving the path.
int Root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

int CountUsed(const Mesh& mesh) {
  std::vector<bool> used(static_cast<size_t>(mesh.vertices.cols()), false);
  for (const int vertex : mesh.triangles.reshaped()) used[vertex] = true;
  return static_cast<int>(std::count(used.begin(), used.end(), true));
}

bool Degenerate(const Mesh& mesh, Eigen::Index t) {
  const Eigen::Vector3i corner = mesh.triangles.col(t);
  if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) return true;
  const Eigen::Vector3d a = mesh.vertices.col(corner[0]);
  const Eigen::Vector3d b = mesh.vertices.col(corner[1]), c = mesh.vertices.col(corner[2]);
  return (b - a).cross(c - a).norm() / 2 < kSmallestArea;
}

// The half-edges bucketed by their lower vertex, each bucket holding the higher vertices ascending. Smaller than
// SortedHalfEdges: 4 bytes per half-edge, without triangle and direction.
class EdgeTable {
 public:
  explicit EdgeTable(const Triangles& triangles) : high_(static_cast<size_t>(triangles.size())) {
    first_.assign(triangles.size() > 0 ? static_cast<size_t>(triangles.maxCoeff()) + 3 : 2, 0);
    ForEachHalfEdge(triangles, [this](int low, int) { ++first_[low + 2]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    ForEachHalfEdge(triangles, [this](int low, int high) { high_[first_[low + 1]++] = high; });
    for (size_t v = 0; v + 2 < first_.size(); ++v) std::sort(high_.begin() + first_[v], high_.begin() + first_[v + 1]);
  }
  // Calls `use(low, high, half_edges)` for each edge, ascending; the last is the number of triangles at the edge.
  template <typename Use>
  void ForEachEdge(const Use& use) const {
    for (size_t v = 0; v + 2 < first_.size(); ++v) {
      for (std::int64_t k = first_[v]; k < first_[v + 1];) {
        const std::int64_t begin = k;
        while (k < first_[v + 1] && high_[k] == high_[begin]) ++k;
        use(static_cast<int>(v), high_[begin], static_cast<int>(k - begin));
      }
    }
  }

 private:
  template <typename Use>
  static void ForEachHalfEdge(const Triangles& triangles, const Use& use) {
    const int* corner = triangles.data();
    for (Eigen::Index t = 0; t < triangles.cols(); ++t, corner += 3) {
      for (int k = 0; k < 3; ++k) {
        const int a = corner[k], b = corner[(k + 1) % 3];
        if (a != b) use(std::min(a, b), std::max(a, b));
      }
    }
  }

  std::vector<std::int64_t> first_;  // start of each vertex' bucket, and the end; one more entry during counting
  std::vector<int> high_;
};

}  // namespace

Edges TriangleEdges(const Triangles& triangles) {
  const EdgeTable table(triangles);
  std::int64_t count = 0;
  table.ForEachEdge([&](int, int, int) { ++count; });
  Edges edges(2, count);
  int* next = edges.data();
  table.ForEachEdge([&](int low, int high, int) { *next++ = low, *next++ = high; });
  return edges;
}

Edges ToEdges(const std::vector<std::pair<int, int>>& pairs) {
  Edges edges(2, static_cast<Eigen::Index>(pairs.size()));
  for (size_t i = 0; i < pairs.size(); ++i) edges.col(static_cast<Eigen::Index>(i)) << pairs[i].first, pairs[i].second;
  return edges;
}

Edges SpringEdges(const Mesh& mesh) { return mesh.edges.cols() > 0 ? mesh.edges : TriangleEdges(mesh.triangles); }

std::vector<int> BoundaryVertices(const Triangles& triangles) {
  std::vector<int> boundary;
  EdgeTable(triangles).ForEachEdge([&](int low, int high, int half_edges) {
    if (half_edges == 1) boundary.insert(boundary.end(), {low, high});
  });
  std::sort(boundary.begin(), boundary.end());
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
  return boundary;
}

std::vector<int> PinchedVertices(const Triangles& triangles) {
  const std::vector<int> parent = CornerFans(triangles, false);
  std::vector<int> fans(triangles.size() > 0 ? static_cast<size_t>(triangles.maxCoeff()) + 1 : 0, 0);
  for (int corner = 0; corner < static_cast<int>(parent.size()); ++corner) {
    if (parent[corner] == corner) ++fans[triangles(corner % 3, corner / 3)];
  }
  std::vector<int> pinched;
  for (int vertex = 0; vertex < static_cast<int>(fans.size()); ++vertex) {
    if (fans[vertex] > 1) pinched.push_back(vertex);
  }
  return pinched;
}

std::vector<std::vector<int>> Components(const Mesh& mesh) {
  std::vector<int> parent(static_cast<size_t>(mesh.vertices.cols()));
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto t : mesh.triangles.colwise()) {
    for (const int corner : t) parent[Root(parent, corner)] = Root(parent, t[0]);
  }
  std::vector<std::vector<int>> components;
  std::vector<int> number(parent.size(), -1);
  for (int t = 0; t < static_cast<int>(mesh.triangles.cols()); ++t) {
    int& component = number[Root(parent, mesh.triangles(0, t))];
    if (component < 0) {
      component = static_cast<int>(components.size());
      components.emplace_back();
    }
    components[component].push_back(t);
  }
  return components;
}

SurfaceTopology AnalyseTopology(const Mesh& mesh) {
  SurfaceTopology topology;
  topology.triangles = static_cast<int>(mesh.triangles.cols());
  topology.vertices = CountUsed(mesh);
  topology.components = static_cast<int>(Components(mesh).size());
  ForEachEdge(SortedHalfEdges(mesh.triangles), [&](auto first, auto last) {
    ++topology.edges;
    topology.boundary_edges += last - first == 1 ? 1 : 0;
    topology.non_manifold_edges += last - first > 2 ? 1 : 0;
    topology.misoriented_edges += last - first == 2 && first->forward == (first + 1)->forward ? 1 : 0;
  });
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) topology.degenerate_triangles += Degenerate(mesh, t) ? 1 : 0;
  return topology;
}

double SignedVolume(const ConstPoints& vertices, const Triangles& triangles) {
  double sixfold = 0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3d a = vertices.col(triangles(0, t));
    const Eigen::Vector3d b = vertices.col(triangles(1, t)), c = vertices.col(triangles(2, t));
    sixfold += a.dot(b.cross(c));
  }
  return sixfold / 6;
}

}  // namespace phrenic
