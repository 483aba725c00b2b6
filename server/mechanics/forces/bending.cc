#include "server/mechanics/forces/bending.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Force>> Bending::Make(const v1::Bending& scene, const std::string& given,
                                                     std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "bending", scene.bodies());
  const auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  const double rigidity = scene.youngs_modulus() * std::pow(scene.thickness(), 3) /
                          (12 * (1 - scene.poissons_ratio() * scene.poissons_ratio()));
  std::unique_ptr<Bending> force(new Bending(name));
  for (const int b : *bodies) {
    const auto selection = builder.Select(b, scene.region(), scene.exclude_region(), path);
    if (!selection.ok()) return selection.status();
    force->AddBody(builder.model.bodies[b], *selection, rigidity);
  }
  if (force->hinges_.empty()) {
    builder.ReportLeftOut(name, "no interior edge, between two triangles, lies in the region");
    return nullptr;
  }
  builder.ReportElement("force", name, static_cast<std::int64_t>(force->hinges_.size()), "edges",
                        absl::StrFormat("flexural rigidity %g N m", rigidity));
  return force;
}

void Bending::AddBody(const BodyModel& body, const Selection& selection, double rigidity) {
  std::map<std::pair<int, int>, int> opposite;  // opposite vertex of each directed edge of a triangle
  const Triangles& triangles = body.mesh.triangles;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      opposite[{triangles(k, t), triangles((k + 1) % 3, t)}] = triangles((k + 2) % 3, t);
    }
  }
  const Points& x = body.mesh.vertices;
  for (const auto& [edge, left] : opposite) {
    const auto [a, b] = edge;
    const auto right = opposite.find({b, a});
    if (a > b || right == opposite.end()) continue;
    const Eigen::Vector4i corners(a, b, left, right->second);
    if (!selection.Takes(corners)) continue;
    const Eigen::Vector3d along = x.col(b) - x.col(a);
    const double area =
        (along.cross(x.col(left) - x.col(a)).norm() + along.cross(x.col(corners[3]) - x.col(a)).norm()) / 2;
    if (area == 0) continue;
    Hinge hinge{corners, rigidity * along.squaredNorm() / area, 0};
    hinge.rest_angle = BendOf(hinge, x).angle;
    hinge.vertices.array() += body.first_vertex;
    hinges_.push_back(hinge);
  }
}

Bending::Bend Bending::BendOf(const Hinge& hinge, const ConstPoints& x) {
  const Eigen::Vector3d origin = x.col(hinge.vertices[0]);
  const Eigen::Vector3d edge = x.col(hinge.vertices[1]) - origin;
  const Eigen::Vector3d left = x.col(hinge.vertices[2]) - origin, right = x.col(hinge.vertices[3]) - origin;
  const Eigen::Vector3d n = edge.cross(left), m = right.cross(edge);
  const double length = edge.norm();
  Bend bend;
  if (n.squaredNorm() == 0 || m.squaredNorm() == 0) return bend;
  const double angle = std::atan2(edge.dot(n.cross(m)) / length, n.dot(m)) - hinge.rest_angle;
  bend.angle = std::remainder(angle, 2 * std::numbers::pi);
  const Eigen::Vector3d by_left = -length / n.squaredNorm() * n, by_right = -length / m.squaredNorm() * m;
  const double foot_left = left.dot(edge) / edge.squaredNorm(), foot_right = right.dot(edge) / edge.squaredNorm();
  bend.gradient << (foot_left - 1) * by_left + (foot_right - 1) * by_right,
      -foot_left * by_left - foot_right * by_right, by_left, by_right;
  return bend;
}

void Bending::AddForce(const EvalContext& at, MutablePoints f) const {
  const double elasticity = at.parameters.elasticity();
  for (const Hinge& hinge : hinges_) {
    const Bend bend = BendOf(hinge, at.x);
    for (int a = 0; a < 4; ++a) {
      f.col(hinge.vertices[a]) -= elasticity * hinge.stiffness * bend.angle * bend.gradient.col(a);
    }
  }
}

void Bending::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  for (const Hinge& hinge : hinges_) {
    const Bend bend = BendOf(hinge, at.x);
    const double stiffness = at.parameters.elasticity() * hinge.stiffness;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        sink.Add(hinge.vertices[a], hinge.vertices[b],
                 stiffness * bend.gradient.col(a) * bend.gradient.col(b).transpose());
      }
    }
  }
}

double Bending::Energy(const EvalContext& at) const {
  double energy = 0;
  for (const Hinge& hinge : hinges_) {
    const double angle = BendOf(hinge, at.x).angle;
    energy += hinge.stiffness * angle * angle / 2;
  }
  return at.parameters.elasticity() * energy;
}

}  // namespace phrenic
