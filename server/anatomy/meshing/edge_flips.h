// Intrinsic Delaunay triangulation of a surface by edge flips.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_EDGE_FLIPS_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_EDGE_FLIPS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Flips edges of a manifold triangulation and keeps which triangles adjoin, so that a caller who moves points between
// flips finds them once. Not thread-safe. The triangles must outlive it, and only it may change them.
class EdgeFlips {
 public:
  explicit EdgeFlips(Triangles& triangles);

  // Flips interior edges until each is Delaunay on the surface (its two opposite angles, measured in `points`, sum to
  // at most pi) or its flip would make a triangle clockwise in `plane`. At most 30 passes. Deterministic.
  void ToDelaunay(const std::vector<Eigen::Vector2d>& plane, const std::vector<Eigen::Vector3d>& points);
  // The same for a closed surface in space. A flip must keep both triangles within 60 degrees of their mean normal and
  // must not create an existing edge.
  void ToDelaunay(const std::vector<Eigen::Vector3d>& points);

 private:
  // An edge a-b between the triangles (a, b, c) and (b, a, d), to be flipped to c-d.
  struct Diamond {
    int a, b, c, d;
  };
  static bool Flat(const std::vector<Eigen::Vector3d>& points, const Diamond& at);
  static std::int64_t Key(int a, int b);

  // Returns the edge of triangle t that it shares with triangle `other`, or -1.
  int EdgeTowards(int t, int other) const;
  // Flips edge k of t: triangles (a, b, c) and (b, a, d) become (c, d, b) and (d, c, a).
  void Flip(int t, int k);
  void ForgetChecks(int t);
  template <typename Allowed, typename Flipped>
  void FlipAll(const std::vector<Eigen::Vector3d>& points, const Allowed& allowed, const Flipped& flipped);

  Triangles& triangles_;
  Eigen::Matrix3Xi across_;  // the triangle across each edge, or -1; edge k joins corners k and k + 1
  Eigen::Matrix<bool, 3, Eigen::Dynamic> is_delaunay_;  // edges found to be so, as points and triangles are now
  absl::flat_hash_set<std::int64_t> edges_;             // of a surface in space
};

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_EDGE_FLIPS_H_
