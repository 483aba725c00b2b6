#include "server/anatomy/meshing/edge_flips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>
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

// Triangle adjacency: the triangle across each edge; edge k of a triangle joins corners k and k + 1.
class Neighbours {
 public:
  explicit Neighbours(Triangles& triangles) : triangles_(triangles), across_(3, triangles.cols()) {
    struct HalfEdge {
      int low, high, triangle, edge;
    };
    std::vector<HalfEdge> edges;
    for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({triangles(k, t), triangles((k + 1) % 3, t)});
        edges.push_back({low, high, t, k});
      }
    }
    std::sort(edges.begin(), edges.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return std::pair(a.low, a.high) < std::pair(b.low, b.high); });
    across_.setConstant(-1);
    for (size_t i = 0; i + 1 < edges.size(); ++i) {
      if (edges[i].low != edges[i + 1].low || edges[i].high != edges[i + 1].high) continue;
      across_(edges[i].edge, edges[i].triangle) = edges[i + 1].triangle;
      across_(edges[i + 1].edge, edges[i + 1].triangle) = edges[i].triangle;
    }
  }

  int Across(int t, int k) const { return across_(k, t); }

  // Returns the edge of triangle t that it shares with triangle `other`, or -1.
  int EdgeTowards(int t, int other) const {
    for (int k = 0; k < 3; ++k) {
      if (across_(k, t) == other) return k;
    }
    return -1;
  }

  // Flips edge k of t: triangles (a, b, c) and (b, a, d) become (c, d, b) and (d, c, a).
  void Flip(int t, int k) {
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
  }

 private:
  Triangles& triangles_;
  Eigen::Matrix3Xi across_;
};

// An edge a-b between the triangles (a, b, c) and (b, a, d), to be flipped to c-d.
struct Diamond {
  int a, b, c, d;
};

// Flips every edge that is not Delaunay (cot c + cot d < 0) and for which `allowed(diamond)`, in passes until nothing
// changes. Calls `flipped(diamond)` after each flip.
template <typename Allowed, typename Flipped>
void Flip(const std::vector<Eigen::Vector3d>& points, Triangles& triangles, Allowed allowed, Flipped flipped) {
  constexpr int kPasses = 30;
  constexpr double kSlack = 1e-9;
  Neighbours neighbours(triangles);
  bool changed = true;
  for (int pass = 0; pass < kPasses && changed; ++pass) {
    changed = false;
    for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int u = neighbours.Across(t, k);
        if (u < 0) continue;
        const Diamond at{triangles(k, t), triangles((k + 1) % 3, t), triangles((k + 2) % 3, t),
                         triangles((neighbours.EdgeTowards(u, t) + 2) % 3, u)};
        const double facing =
            Cotangent(points[at.a], points[at.b], points[at.c]) + Cotangent(points[at.a], points[at.b], points[at.d]);
        if (facing > -kSlack || !allowed(at)) continue;
        neighbours.Flip(t, k);
        flipped(at);
        changed = true;
      }
    }
  }
}

int64_t Key(int a, int b) { return (static_cast<int64_t>(std::min(a, b)) << 32) + std::max(a, b); }

// True if both triangles after the flip face within 60 degrees of the diamond's mean normal.
bool Flat(const std::vector<Eigen::Vector3d>& points, const Diamond& at) {
  const auto normal = [&](int a, int b, int c) {
    return Eigen::Vector3d((points[b] - points[a]).cross(points[c] - points[a]));
  };
  const Eigen::Vector3d facing = (normal(at.a, at.b, at.c) + normal(at.b, at.a, at.d)).normalized();
  const Eigen::Vector3d first = normal(at.c, at.d, at.b), second = normal(at.d, at.c, at.a);
  return first.dot(facing) > 0.5 * first.norm() && second.dot(facing) > 0.5 * second.norm();
}

}  // namespace

void FlipToDelaunay(const std::vector<Eigen::Vector2d>& plane, const std::vector<Eigen::Vector3d>& points,
                    Triangles& triangles) {
  const auto convex = [&](const Diamond& at) {
    return Cross(plane[at.c], plane[at.d], plane[at.b]) > 0 && Cross(plane[at.d], plane[at.c], plane[at.a]) > 0;
  };
  Flip(points, triangles, convex, [](const Diamond&) {});
}

void FlipToDelaunay(const std::vector<Eigen::Vector3d>& points, Triangles& triangles) {
  std::unordered_set<int64_t> edges;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) edges.insert(Key(triangles(k, t), triangles((k + 1) % 3, t)));
  }
  const auto allowed = [&](const Diamond& at) { return Flat(points, at) && !edges.contains(Key(at.c, at.d)); };
  const auto flipped = [&](const Diamond& at) {
    edges.erase(Key(at.a, at.b));
    edges.insert(Key(at.c, at.d));
  };
  Flip(points, triangles, allowed, flipped);
}

}  // namespace phrenic::anatomy
