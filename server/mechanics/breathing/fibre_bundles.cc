#include "server/mechanics/breathing/fibre_bundles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "server/mesh/half_edges.h"
#include "server/mesh/nearest.h"

namespace phrenic {
namespace {

constexpr int kSmoothings = 3;

// Returns the position of each border vertex along the border, loop after loop; -1 elsewhere.
std::vector<int> BorderPositions(const Mesh& mesh) {
  std::vector<int> next(mesh.vertices.cols(), -1), position(next.size(), -1);
  ForEachEdge(SortedHalfEdges(mesh.triangles), [&next](auto first, auto last) {
    if (last - first != 1) return;
    first->forward ? next[first->low] = first->high : next[first->high] = first->low;
  });
  int count = 0;
  for (int start = 0; start < static_cast<int>(next.size()); ++start) {
    for (int v = start; v >= 0 && next[v] >= 0 && position[v] < 0; v = next[v]) position[v] = count++;
  }
  return position;
}

// Returns the neighbour of each vertex towards which the height falls most steeply; the vertex itself if all are
// higher.
std::vector<int> SteepestDescent(const Mesh& mesh, const Eigen::VectorXd& height) {
  std::vector<int> down(mesh.vertices.cols());
  std::iota(down.begin(), down.end(), 0);
  std::vector<double> steepest(down.size(), 0);
  const auto look = [&](int from, int to) {
    const double length = (mesh.vertices.col(from) - mesh.vertices.col(to)).norm();
    const double slope = (height[from] - height[to]) / std::max(length, 1e-12);
    if (slope > steepest[from]) steepest[from] = slope, down[from] = to;
  };
  for (const auto& corner : mesh.triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      look(corner[k], corner[(k + 1) % 3]);
      look(corner[(k + 1) % 3], corner[k]);
    }
  }
  return down;
}

// Returns the position along the border of where the way down from each vertex ends, or of the border vertex nearest to
// that; all 0 without a border.
std::vector<int> OriginsOnBorder(const Mesh& mesh, const Eigen::VectorXd& height) {
  const std::vector<int> position = BorderPositions(mesh);
  const int n = static_cast<int>(position.size());
  std::vector<int> border, by_height(n), origin(n, 0);
  for (int i = 0; i < n; ++i) {
    if (position[i] >= 0) border.push_back(i);
  }
  if (border.empty()) return origin;
  Points points(3, static_cast<Eigen::Index>(border.size()));
  for (size_t k = 0; k < border.size(); ++k) points.col(static_cast<Eigen::Index>(k)) = mesh.vertices.col(border[k]);
  const NearestSearch nearest(points);
  std::iota(by_height.begin(), by_height.end(), 0);
  std::stable_sort(by_height.begin(), by_height.end(), [&](int a, int b) { return height[a] < height[b]; });
  const std::vector<int> down = SteepestDescent(mesh, height);
  for (const int i : by_height) {  // whatever is lower has its origin already
    if (down[i] != i) {
      origin[i] = origin[down[i]];
    } else {
      origin[i] = position[i] >= 0 ? position[i] : position[border[nearest.Nearest(mesh.vertices.col(i)).vertex]];
    }
  }
  return origin;
}

double AreaOf(const Mesh& mesh, const Eigen::Vector3i& corner) {
  const Eigen::Vector3d a = mesh.vertices.col(corner[0]);
  return Eigen::Vector3d(mesh.vertices.col(corner[1]) - a)
             .cross(Eigen::Vector3d(mesh.vertices.col(corner[2]) - a))
             .norm() /
         2;
}

// Returns where a loop of positions is cut: after the longest run of positions without area.
size_t CutOf(const std::vector<double>& area) {
  size_t best = 0, longest = 0, run = 0;
  for (size_t i = 0; i < 2 * area.size(); ++i) {
    run = area[i % area.size()] > 0 ? 0 : run + 1;
    if (run > longest && run <= area.size()) longest = run, best = (i + 1) % area.size();
  }
  return best;
}

// Divides positions of one side, with so much area each, into bundles. Returns the bundle of each.
std::vector<int> Divide(const std::vector<double>& area) {
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  std::vector<int> bundle(area.size(), 0);
  const size_t cut = CutOf(area);
  double before = 0;
  for (size_t k = 0; k < area.size() && total > 0; ++k) {
    const size_t i = (cut + k) % area.size();
    const double middle = (before + area[i] / 2) / total;
    bundle[i] = std::min(FibreBundles::kPerSide - 1, static_cast<int>(middle * FibreBundles::kPerSide));
    before += area[i];
  }
  return bundle;
}

}  // namespace

FibreBundles MakeFibreBundles(const Mesh& mesh, const Eigen::VectorXd& height, const std::vector<bool>& muscle) {
  const std::vector<int> origin = OriginsOnBorder(mesh, height);
  const size_t positions =
      origin.empty() ? 1 : static_cast<size_t>(*std::max_element(origin.begin(), origin.end())) + 1;
  struct Place {
    int side, position;
    double area;
  };
  std::vector<Place> places(mesh.triangles.cols());
  std::array<std::vector<double>, 2> area = {std::vector<double>(positions, 0), std::vector<double>(positions, 0)};
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    if (!muscle[t]) continue;
    const Eigen::Vector3i corner = mesh.triangles.col(t);
    const int lowest =
        *std::min_element(corner.begin(), corner.end(), [&](int a, int b) { return height[a] < height[b]; });
    const double x = mesh.vertices(0, corner[0]) + mesh.vertices(0, corner[1]) + mesh.vertices(0, corner[2]);
    places[t] = {x < 0 ? 0 : 1, origin[lowest], AreaOf(mesh, corner)};
    area[places[t].side][places[t].position] += places[t].area;
  }
  const std::array<std::vector<int>, 2> bundle = {Divide(area[0]), Divide(area[1])};
  FibreBundles bundles;
  bundles.of_triangle.assign(places.size(), -1);
  for (size_t t = 0; t < places.size(); ++t) {
    if (!muscle[t]) continue;
    const int of = FibreBundles::kPerSide * places[t].side + bundle[places[t].side][places[t].position];
    bundles.of_triangle[t] = of;
    bundles.area[of] += places[t].area;
  }
  return bundles;
}

void FibreBundles::Smooth(Values& values) const {
  for (int round = 0; round < kSmoothings; ++round) {
    const Values from = values;
    for (int b = 0; b < kCount; ++b) {
      const int first = b < kPerSide ? 0 : kPerSide;
      double weight = 2 * area[b], sum = weight * from[b];
      for (const int other : {b - 1, b + 1}) {
        if (other < first || other >= first + kPerSide) continue;
        weight += area[other], sum += area[other] * from[other];
      }
      if (weight > 0) values[b] = sum / weight;
    }
  }
}

}  // namespace phrenic
