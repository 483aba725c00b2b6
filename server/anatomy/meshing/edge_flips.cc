#include "server/anatomy/meshing/edge_flips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace phrenic::anatomy {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Returns the cotangent of the angle at c in the triangle a b c.
double Cotangent(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d u = a - c, v = b - c;
  return u.dot(v) / std::max(1e-12, u.cross(v).norm());
}

// One side of an edge whose other vertex is known.
struct HalfEdge {
  int high, triangle, edge;
};

// Returns the half-edges by their lower vertex, and the first one of each vertex.
std::pair<std::vector<HalfEdge>, std::vector<int>> ByLowerVertex(const Triangles& triangles) {
  std::vector<int> first(triangles.size() == 0 ? 1 : static_cast<size_t>(triangles.maxCoeff()) + 2, 0);
  const auto low = [&](int t, int k) { return std::min(triangles(k, t), triangles((k + 1) % 3, t)); };
  const int count = static_cast<int>(triangles.cols());
  for (int t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) ++first[low(t, k) + 1];
  }
  for (size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<HalfEdge> edges(static_cast<size_t>(first.back()));
  std::vector<int> next = first;
  for (int t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) {
      edges[next[low(t, k)]++] = {std::max(triangles(k, t), triangles((k + 1) % 3, t)), t, k};
    }
  }
  return {std::move(edges), std::move(first)};
}

}  // namespace

EdgeFlips::EdgeFlips(Triangles& triangles)
    : triangles_(triangles),
      across_(Eigen::Matrix3Xi::Constant(3, triangles.cols(), -1)),
      is_delaunay_(3, triangles.cols()) {
  auto [edges, first] = ByLowerVertex(triangles);
  for (size_t vertex = 0; vertex + 1 < first.size(); ++vertex) {
    std::sort(edges.begin() + first[vertex], edges.begin() + first[vertex + 1],
              [](const HalfEdge& a, const HalfEdge& b) { return a.high < b.high; });
    for (int i = first[vertex]; i + 1 < first[vertex + 1]; ++i) {
      if (edges[i].high != edges[i + 1].high) continue;
      across_(edges[i].edge, edges[i].triangle) = edges[i + 1].triangle;
      across_(edges[i + 1].edge, edges[i + 1].triangle) = edges[i].triangle;
    }
  }
}

int EdgeFlips::EdgeTowards(int t, int other) const {
  for (int k = 0; k < 3; ++k) {
    if (across_(k, t) == other) return k;
  }
  return -1;
}

void EdgeFlips::ForgetChecks(int t) {
  is_delaunay_.col(t).setConstant(false);
  for (int k = 0; k < 3; ++k) {
    const int other = across_(k, t);
    if (other >= 0) is_delaunay_(EdgeTowards(other, t), other) = false;
  }
}

void EdgeFlips::Flip(int t, int k) {
  const int u = across_(k, t), j = EdgeTowards(u, t);
  const int a = triangles_(k, t), b = triangles_((k + 1) % 3, t);
  const int c = triangles_((k + 2) % 3, t), d = triangles_((j + 2) % 3, u);
  const int beyond_bc = across_((k + 1) % 3, t), beyond_ca = across_((k + 2) % 3, t);
  const int beyond_ad = across_((j + 1) % 3, u), beyond_db = across_((j + 2) % 3, u);
  triangles_.col(t) << c, d, b;
  across_.col(t) << u, beyond_db, beyond_bc;
  triangles_.col(u) << d, c, a;
  across_.col(u) << t, beyond_ca, beyond_ad;
  if (beyond_db >= 0) across_(EdgeTowards(beyond_db, u), beyond_db) = t;
  if (beyond_ca >= 0) across_(EdgeTowards(beyond_ca, t), beyond_ca) = u;
  ForgetChecks(t);
  ForgetChecks(u);
}

// Flips every edge that is not Delaunay (cot c + cot d < 0) and for which `allowed(diamond)`, in passes until nothing
// changes. Calls `flipped(diamond)` after each flip. Both sides of an edge have the same sum of cotangents, bit for
// bit: it is computed once.
template <typename Allowed, typename Flipped>
void EdgeFlips::FlipAll(const std::vector<Eigen::Vector3d>& points, const Allowed& allowed, const Flipped& flipped) {
  constexpr int kPasses = 30;
  constexpr double kSlack = 1e-9;
  is_delaunay_.setConstant(false);
  bool changed = true;
  for (int pass = 0; pass < kPasses && changed; ++pass) {
    changed = false;
    for (int t = 0; t < static_cast<int>(triangles_.cols()); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int u = across_(k, t);
        if (u < 0 || is_delaunay_(k, t)) continue;
        const int j = EdgeTowards(u, t);
        const Diamond at{triangles_(k, t), triangles_((k + 1) % 3, t), triangles_((k + 2) % 3, t),
                         triangles_((j + 2) % 3, u)};
        const double facing =
            Cotangent(points[at.a], points[at.b], points[at.c]) + Cotangent(points[at.a], points[at.b], points[at.d]);
        is_delaunay_(k, t) = is_delaunay_(j, u) = facing > -kSlack;
        if (facing > -kSlack || !allowed(at)) continue;
        Flip(t, k);
        flipped(at);
        changed = true;
      }
    }
  }
}

std::int64_t EdgeFlips::Key(int a, int b) { return (static_cast<std::int64_t>(std::min(a, b)) << 32) + std::max(a, b); }

// True if both triangles after the flip face within 60 degrees of the diamond's mean normal.
bool EdgeFlips::Flat(const std::vector<Eigen::Vector3d>& points, const Diamond& at) {
  const auto normal = [&](int a, int b, int c) {
    return Eigen::Vector3d((points[b] - points[a]).cross(points[c] - points[a]));
  };
  const Eigen::Vector3d facing = (normal(at.a, at.b, at.c) + normal(at.b, at.a, at.d)).normalized();
  const Eigen::Vector3d first = normal(at.c, at.d, at.b), second = normal(at.d, at.c, at.a);
  return first.dot(facing) > 0.5 * first.norm() && second.dot(facing) > 0.5 * second.norm();
}

void EdgeFlips::ToDelaunay(const std::vector<Eigen::Vector2d>& plane, const std::vector<Eigen::Vector3d>& points) {
  const auto convex = [&](const Diamond& at) {
    return Cross(plane[at.c], plane[at.d], plane[at.b]) > 0 && Cross(plane[at.d], plane[at.c], plane[at.a]) > 0;
  };
  FlipAll(points, convex, [](const Diamond&) {});
}

void EdgeFlips::ToDelaunay(const std::vector<Eigen::Vector3d>& points) {
  if (edges_.empty()) {
    edges_.reserve(static_cast<size_t>(triangles_.cols()) * 3 / 2);
    for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
      for (int k = 0; k < 3; ++k) edges_.insert(Key(triangles_(k, t), triangles_((k + 1) % 3, t)));
    }
  }
  const auto allowed = [&](const Diamond& at) { return Flat(points, at) && !edges_.contains(Key(at.c, at.d)); };
  const auto flipped = [&](const Diamond& at) {
    edges_.erase(Key(at.a, at.b));
    edges_.insert(Key(at.c, at.d));
  };
  FlipAll(points, allowed, flipped);
}

}  // namespace phrenic::anatomy
