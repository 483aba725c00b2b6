#include "server/mechanics/lungs/lung_surroundings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/mechanics/skinning/body_points.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic {
namespace {

constexpr double kContactReach = 0.02;  // between a lung and what touches it at rest [m]
constexpr double kThrough = 0.006;      // depth to which a lung may reach through it [m]
constexpr double kLeastCosine = 0.64;   // least cosine between the normals of both
constexpr double kInwards = 0.3;        // least part of the normal towards the midline where the mediastinum touches

struct Surface {
  explicit Surface(const Mesh& of) : mesh(of), tree(of.vertices, of.triangles) { tree.Fit(mesh.vertices, boxes); }

  // Returns the nearest point if the boundary point faces it.
  SurfacePoint Facing(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    SurfacePoint near = tree.Nearest(mesh.vertices, boxes, point, kContactReach);
    if (near.triangle < 0) return near;
    const Eigen::Matrix3d x = mesh.vertices(Eigen::all, tree.triangle(near.triangle));
    const Eigen::Vector3d across = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).stableNormalized();
    const bool aligned = std::abs(across.dot(normal)) > kLeastCosine;
    const bool ahead = near.offset.dot(normal) > 0 || near.squared < kThrough * kThrough;
    return aligned && ahead ? near : SurfacePoint();
  }

  bool IsWithinReach(const Eigen::Vector3d& point) const {
    return tree.Nearest(mesh.vertices, boxes, point, kContactReach).triangle >= 0;
  }

  const Mesh& mesh;
  TriangleTree tree;
  TriangleTree::Boxes boxes;
};

// True if a boundary point above the top of the wall is in the cupola of the pleura, which hangs from it.
bool IsInCupola(const Eigen::Vector3d& point, double top_of_wall) { return point.z() > top_of_wall; }

}  // namespace

LungSurroundings::LungSurroundings(const Model& model, int sheet, int wall, const LungTissue& tissue,
                                   bool is_margin_free)
    : model_(model), bodies_{sheet, wall}, areas_(tissue.areas()), points_(tissue.points()) {
  Bind(tissue, model.bodies[sheet].mesh, model.bodies[wall].mesh, is_margin_free);
}

void LungSurroundings::Bind(const LungTissue& tissue, const Mesh& sheet, const Mesh& wall, bool is_margin_free) {
  const std::array<Surface, 2> surfaces = {Surface(sheet), Surface(wall)};
  const double side = tissue.box().center().x() > 0 ? 1 : -1, top_of_wall = wall.vertices.row(2).maxCoeff();
  for (Eigen::Index p = 0; p < tissue.points().cols(); ++p) {
    const Eigen::Vector3d point = tissue.points().col(p), normal = tissue.normals().col(p);
    const bool rooted = tissue.rooted()[static_cast<size_t>(p)];
    std::array<SurfacePoint, 2> near = {surfaces[0].Facing(point, normal), surfaces[1].Facing(point, normal)};
    if (IsInCupola(point, top_of_wall)) near[1] = surfaces[1].tree.Nearest(wall.vertices, surfaces[1].boxes, point, 1);
    const size_t nearest = near[0].squared <= near[1].squared ? 0 : 1;
    const bool touches = !rooted && near[nearest].triangle >= 0,
               is_margin = is_margin_free && nearest == 0 && surfaces[1].IsWithinReach(point);
    if (touches && !is_margin) {
      contacts_[nearest].push_back({p, surfaces[nearest].tree.triangle(near[nearest].triangle), near[nearest].weights});
      neighbours_.push_back(static_cast<LungNeighbour>(nearest));
    } else if (!touches && (rooted || -side * normal.x() > kInwards)) {
      mediastinal_area_ += areas_[p] * std::abs(normal.x());
      beside_mediastinum_ -= areas_[p] * normal.x() * point.x();
      neighbours_.push_back(LungNeighbour::kMediastinum);
    } else {
      neighbours_.push_back(LungNeighbour::kNone);
    }
  }
}

double LungSurroundings::MediastinalShift(const State& state) const {
  for (const Coordinate& coordinate : model_.coordinates) {
    if (coordinate.name == "mediastinal shift") return coordinate.Value(state.x) / mediastinal_area_;
  }
  return 0;
}

Points LungSurroundings::Displacement(const State& state, const MediastinalMotion& mediastinum) const {
  std::array<Points, 2> placed;
  for (size_t of = 0; of < placed.size(); ++of) {
    placed[of].resize(3, model_.bodies[bodies_[of]].mesh.vertices.cols());
    PlaceBody(model_, state, bodies_[of], placed[of]);
  }
  return Displacement(state, placed[0], placed[1], mediastinum);
}

Points LungSurroundings::Displacement(const State& state, const Points& sheet, const Points& wall,
                                      const MediastinalMotion& mediastinum) const {
  Points displacement = Points::Constant(3, areas_.size(), std::numeric_limits<double>::quiet_NaN());
  const std::array<const Points*, 2> placed = {&sheet, &wall};
  for (size_t of = 0; of < contacts_.size(); ++of) {
    const Points &rest = model_.bodies[bodies_[of]].mesh.vertices, &moved = *placed[of];
    for (const Contact& contact : contacts_[of]) {
      Eigen::Vector3d shift = Eigen::Vector3d::Zero();
      for (int c = 0; c < 3; ++c) {
        const int corner = contact.corners[c];
        shift += contact.weights[c] * (moved.col(corner) - rest.col(corner));
      }
      displacement.col(contact.point) = shift;
    }
  }
  const double sideways = MediastinalShift(state);
  for (Eigen::Index p = 0; p < areas_.size(); ++p) {
    if (neighbours_[p] != LungNeighbour::kMediastinum) continue;
    displacement.col(p) = MoveMediastinum(p, sideways, mediastinum);
  }
  return displacement;
}

Eigen::Vector3d LungSurroundings::MoveMediastinum(Eigen::Index point, double sideways,
                                                  const MediastinalMotion& motion) const {
  const double below_top = (motion.top - points_(2, point)) / (motion.top - motion.bottom);
  return {sideways - motion.narrowing * points_(0, point), 0, -motion.descent * std::clamp(below_top, 0.0, 1.0)};
}

double LungSurroundings::Share(LungNeighbour neighbour) const {
  double area = 0;
  for (Eigen::Index p = 0; p < areas_.size(); ++p) area += neighbours_[p] == neighbour ? areas_[p] : 0;
  return area / areas_.sum();
}

}  // namespace phrenic
