#include "server/compare/domes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace phrenic::compare {
namespace {

constexpr char kDiaphragm[] = "diaphragm";
constexpr double kMinDepth = 2e-3;  // of the saddle below the lower summit [m]
constexpr int kPlanes = 128;        // of constant x in which the outline is sampled

// The greatest z in each of kPlanes equidistant planes of constant x.
struct Outline {
  double first = 0, step = 0;  // x of the first plane and distance between planes [m]
  std::vector<double> heights = std::vector<double>(kPlanes, -std::numeric_limits<double>::infinity());

  // Raises the outline to the segment from a to b.
  void Add(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    if (a.x() > b.x()) return Add(b, a);
    const int begin = std::max(0, static_cast<int>(std::ceil((a.x() - first) / step)));
    for (int k = begin; k < kPlanes && first + k * step <= b.x(); ++k) {
      const double part = b.x() > a.x() ? (first + k * step - a.x()) / (b.x() - a.x()) : 0;
      heights[static_cast<std::size_t>(k)] =
          std::max(heights[static_cast<std::size_t>(k)], std::lerp(a.z(), b.z(), part));
    }
  }
};

// Adds the segment in which the plane y = `y` cuts a triangle.
void AddSection(const Mesh& mesh, const Eigen::Vector3i& corners, double y, Outline& outline) {
  std::vector<Eigen::Vector3d> cut;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d a = mesh.vertices.col(corners[k]), b = mesh.vertices.col(corners[(k + 1) % 3]);
    if ((a.y() < y) != (b.y() < y)) cut.emplace_back(a + (y - a.y()) / (b.y() - a.y()) * (b - a));
  }
  if (cut.size() == 2) outline.Add(cut[0], cut[1]);
}

Outline OutlineOf(const Mesh& mesh, const std::vector<int>& vertices) {
  Outline outline;
  std::vector<bool> inside(static_cast<std::size_t>(mesh.vertices.cols()), false);
  for (const int i : vertices) inside[static_cast<std::size_t>(i)] = true;
  const Points x = mesh.vertices(Eigen::all, vertices);
  if (x.cols() == 0) return outline;
  Eigen::Index highest = 0;
  x.row(2).maxCoeff(&highest);
  outline.first = x.row(0).minCoeff();
  outline.step = (x.row(0).maxCoeff() - outline.first) / (kPlanes - 1);
  if (outline.step <= 0) return outline;
  for (const auto corners : mesh.triangles.colwise()) {
    if (inside[corners[0]] && inside[corners[1]] && inside[corners[2]]) {
      AddSection(mesh, corners, x(1, highest), outline);
    }
  }
  return outline;
}

void AddDomes(Mesh& mesh, double saddle) {
  std::vector<int> left, right;
  for (const int i : mesh.regions.at(kDiaphragm)) (mesh.vertices(0, i) > saddle ? left : right).push_back(i);
  mesh.regions.emplace("left dome", std::move(left));
  mesh.regions.emplace("right dome", std::move(right));
}

}  // namespace

std::optional<double> FindSaddle(const Mesh& mesh, const std::vector<int>& vertices) {
  if (vertices.empty()) return std::nullopt;
  const auto [first, step, heights] = OutlineOf(mesh, vertices);
  // The saddle has the greatest depth below the lower of the highest summits on its two sides.
  std::vector<double> summit_after(heights.size());
  double summit = -std::numeric_limits<double>::infinity();
  for (std::size_t i = heights.size(); i-- > 0;) summit_after[i] = summit = std::max(summit, heights[i]);
  std::optional<double> saddle;
  double deepest = kMinDepth, summit_before = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    summit_before = std::max(summit_before, heights[i]);
    const double depth = std::min(summit_before, summit_after[i]) - heights[i];
    if (!std::isfinite(depth) || depth < deepest) continue;
    deepest = depth;
    saddle = first + static_cast<double>(i) * step;
  }
  return saddle;
}

void AddDomes(Mesh& a, Mesh& b) {
  const auto found = a.regions.find(kDiaphragm);
  if (found == a.regions.end() || b.regions.count(kDiaphragm) == 0) return;
  const auto saddle = FindSaddle(a, found->second);
  if (!saddle) return;
  for (Mesh* mesh : {&a, &b}) AddDomes(*mesh, *saddle);
}

}  // namespace phrenic::compare
