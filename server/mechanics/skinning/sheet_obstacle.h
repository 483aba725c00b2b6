// A deformable surface that skinned vertices do not pass through (Skin.obstacle).
//
// A vertex p has the signed distance s = +-|p - f| from the nearest point f of the surface, positive in front of it,
// where its normals point. A vertex that rests in front, at s0, is put back where s < s_min = min(1 mm, s0):
//   p -> p + (s_min - s) m,   m = (p - f)/s,
// and its velocity loses what would take it through:
//   v -> v + m (m . (v_f - v)),   v_f that of f.
// It slides freely along the surface. This is geometry of what is seen: no force acts, and no step computes it.
// Positions are continuous as long as f is. Velocities leave out that m turns.
//
// Few vertices are searched for: those that are lower over the plane of the triangle that was nearest at rest than
// s_min and half of what they have slid along it. Vertices that rest further than 60 mm from the surface are left
// alone, and so are those beyond its border or more than 45 degrees off its normal.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_OBSTACLE_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_OBSTACLE_H_

#include <memory>
#include <string_view>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/surface_walk.h"

namespace phrenic {

// The surface, shared by all bodies that it stops. Immutable.
struct Obstacle {
  Obstacle(const ModelBuilder& builder, const Triangles& triangles);
  const int first_vertex;   // the lowest of its simulated vertices
  const int vertices;       // from there on
  const TriangleTree tree;  // of vertices counted from first_vertex on
  const SurfaceWalk walk;
};

class SheetObstacle final : public SkinCorrection {
 public:
  // Finds the vertices of a body, at `rest` (3 x n) [m], that rest in front of the obstacle. The builder's
  // model is at rest. With an incomplete list if the builder has stopped.
  SheetObstacle(std::shared_ptr<const Obstacle> obstacle, const ModelBuilder& builder, const Points& rest);

  void Place(const EvalContext& at, MutablePoints x) const override;
  void Move(const EvalContext& at, MutablePoints x, MutablePoints v) const override;

 private:
  struct Vertex {
    int index = 0;         // of the body
    int triangle = 0;      // nearest at rest, in the tree's order
    Eigen::Vector3d foot;  // barycentric, the point of it nearest at rest
    double least = 0;      // s_min [m]
  };
  bool IsNear(const ConstPoints& sheet, const Vertex& vertex, const Eigen::Vector3d& point) const;
  // Calls correct(index, point of the sheet, m, s_min - s) for each vertex that must be put back.
  template <typename Correct>
  void ForEachBehind(const ConstPoints& sheet, const MutablePoints& x, const Correct& correct) const;

  const std::shared_ptr<const Obstacle> obstacle_;
  std::vector<Vertex> vertices_;
};

// Adds the obstacle of the scene's skin, if it has one, to the skins of its bodies, which AddSkins has made.
// INVALID_ARGUMENT if it does not exist or is not deformable; `path` is the scene's message.
absl::Status AddObstacle(const v1::Skin& scene, std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_OBSTACLE_H_
