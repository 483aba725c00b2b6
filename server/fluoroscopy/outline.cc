#include "server/fluoroscopy/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace phrenic::fluoroscopy {
namespace {

constexpr double kMargin = 0.018, kSpacing = 0.02, kReach = 0.1, kBelow = 0.1, kAbove = 0.06;  // [m]
constexpr int kSmoothing = 3, kAround = 64;
constexpr double kPower = 2.5;

// Left, right, front and back of a ring [m].
using Extents = Eigen::Array4d;

std::vector<std::optional<Extents>> ExtentsAt(const std::vector<Points>& bones, double first, int count) {
  std::vector<std::optional<Extents>> all(count);
  for (const Points& points : bones) {
    for (const auto& p : points.colwise()) {
      const int from = std::max(0, static_cast<int>(std::ceil((p.z() - kReach - first) / kSpacing)));
      const int to = std::min(count - 1, static_cast<int>(std::floor((p.z() + kReach - first) / kSpacing)));
      for (int k = from; k <= to; ++k) {
        if (!all[k]) all[k] = Extents(p.x(), p.x(), p.y(), p.y());
        Extents& e = *all[k];
        e = {std::min(e[0], p.x()), std::max(e[1], p.x()), std::min(e[2], p.y()), std::max(e[3], p.y())};
      }
    }
  }
  return all;
}

// Gives rings without bones the extents of the nearest ring below that has some, the lowest those of the first above.
std::vector<Extents> Filled(const std::vector<std::optional<Extents>>& rings) {
  const auto known = [](const auto& ring) { return ring.has_value(); };
  const auto first = std::find_if(rings.begin(), rings.end(), known);
  if (first == rings.end()) return {};
  std::vector<Extents> filled;
  filled.reserve(rings.size());
  Extents last = **first;
  for (const auto& ring : rings) filled.push_back(last = ring.value_or(last));
  return filled;
}

std::vector<Extents> Smoothed(const std::vector<Extents>& rings) {
  const int count = static_cast<int>(rings.size());
  std::vector<Extents> smoothed;
  for (int k = 0; k < count; ++k) {
    const int from = std::max(0, k - kSmoothing), to = std::min(count - 1, k + kSmoothing);
    Extents sum = Extents::Zero();
    for (int j = from; j <= to; ++j) sum += rings[j];
    smoothed.push_back(sum / (to - from + 1));
  }
  return smoothed;
}

double Rounded(double part) { return std::copysign(std::pow(std::abs(part), 2 / kPower), part); }

void PlaceRing(const Extents& e, double z, int k, Points& vertices) {
  const double a = (e[1] - e[0]) / 2 + kMargin, b = (e[3] - e[2]) / 2 + kMargin;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    vertices.col(k * kAround + i) = Eigen::Vector3d((e[0] + e[1]) / 2 + a * Rounded(std::cos(angle)),
                                                    (e[2] + e[3]) / 2 + b * Rounded(std::sin(angle)), z);
  }
}

Triangles RingTriangles(int count) {
  std::vector<Eigen::Vector3i> all;
  const int bottom = count * kAround, top = bottom + 1, last = (count - 1) * kAround;
  for (int i = 0; i < kAround; ++i) {
    const int next = (i + 1) % kAround;
    for (int k = 0; k + 1 < count; ++k) {
      const int a = k * kAround + i, b = k * kAround + next, c = a + kAround, d = b + kAround;
      all.emplace_back(a, b, d);
      all.emplace_back(a, d, c);
    }
    all.emplace_back(bottom, next, i);
    all.emplace_back(top, last + i, last + next);
  }
  Triangles triangles(3, all.size());
  for (size_t t = 0; t < all.size(); ++t) triangles.col(static_cast<Eigen::Index>(t)) = all[t];
  return triangles;
}

}  // namespace

Mesh TrunkOutline(const std::vector<Points>& bones, double low, double high) {
  Mesh mesh;
  const double first = low - kBelow;
  const int count = std::max(2, static_cast<int>(std::ceil((high + kAbove - first) / kSpacing)) + 1);
  const std::vector<Extents> rings = Smoothed(Filled(ExtentsAt(bones, first, count)));
  if (rings.empty()) return mesh;
  mesh.vertices.resize(3, count * kAround + 2);
  for (int k = 0; k < count; ++k) PlaceRing(rings[k], first + k * kSpacing, k, mesh.vertices);
  for (const auto& [vertex, k] : {std::pair(count * kAround, 0), std::pair(count * kAround + 1, count - 1)}) {
    mesh.vertices.col(vertex) = mesh.vertices.middleCols(k * kAround, kAround).rowwise().mean();
  }
  mesh.triangles = RingTriangles(count);
  return mesh;
}

}  // namespace phrenic::fluoroscopy
