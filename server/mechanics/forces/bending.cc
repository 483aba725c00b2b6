#include "server/mechanics/forces/bending.h"

#include <Eigen/Geometry>
#include <cmath>
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
  const double nu = scene.poissons_ratio();
  const double rigidity = scene.youngs_modulus() * std::pow(scene.thickness(), 3) / (12 * (1 - nu * nu));
  std::unique_ptr<Bending> force(new Bending(name, rigidity));
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    const auto selection = builder.Select(b, scene.region(), scene.exclude_region(), path);
    if (!selection.ok()) return selection.status();
    std::vector<bool> held(body.mesh.vertices.cols()), taken(body.mesh.triangles.cols());
    for (size_t i = 0; i < held.size(); ++i) {
      held[i] = builder.model.inverse_mass[body.first_vertex + static_cast<Eigen::Index>(i)] == 0;
    }
    for (size_t t = 0; t < taken.size(); ++t) {
      taken[t] = selection->Takes(Eigen::Vector3i(body.mesh.triangles.col(static_cast<Eigen::Index>(t))));
    }
    force->AddBody(body, MakePlate(body.mesh.vertices, body.mesh.triangles, held, taken, nu));
  }
  if (force->triangles_.empty()) {
    builder.ReportLeftOut(name, "no triangle that moves, beside another one, has all its vertices in the region");
    return nullptr;
  }
  builder.ReportElement("force", name, static_cast<std::int64_t>(force->triangles_.size()), "triangles",
                        absl::StrFormat("flexural rigidity %g N m, nu = %g", rigidity, nu));
  return force;
}

void Bending::AddBody(const BodyModel& body, Plate plate) {
  const int first_hinge = static_cast<int>(hinges_.size());
  for (const Eigen::Vector4i& vertices : plate.hinges) {
    Hinge hinge{vertices, 0};
    hinge.rest_angle = BendOf(hinge, body.mesh.vertices).angle;
    hinge.vertices.array() += body.first_vertex;
    hinges_.push_back(hinge);
  }
  for (PlateTriangle& triangle : plate.triangles) {
    for (int& hinge : triangle.hinges) hinge += first_hinge;
    for (int& vertex : triangle.vertices) vertex += body.first_vertex;
    triangles_.push_back(triangle);
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

std::vector<Bending::Bend>& Bending::BendsAt(const EvalContext& at) const {
  std::vector<Bend>& bends = at.scratch.Get<Bends>().of;
  bends.resize(hinges_.size());
  for (size_t h = 0; h < hinges_.size(); ++h) bends[h] = BendOf(hinges_[h], at.x);
  return bends;
}

// Returns the root of the triangle's energy, sum_i bend_i t_i, in which curvature has three components.
Eigen::Vector3d Bending::CurvatureOf(const PlateTriangle& triangle, const std::vector<Bend>& bends) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < triangle.count; ++i) sum += bends[triangle.hinges[i]].angle * triangle.bend.col(i);
  return sum;
}

void Bending::AddForce(const EvalContext& at, MutablePoints f) const {
  std::vector<Bend>& bends = BendsAt(at);
  for (const PlateTriangle& triangle : triangles_) {
    const Eigen::Vector3d curvature = CurvatureOf(triangle, bends);
    for (int i = 0; i < triangle.count; ++i) {
      bends[triangle.hinges[i]].moment += triangle.bend.col(i).dot(curvature);
    }
  }
  const double rigidity = at.parameters.elasticity() * rigidity_;
  for (size_t h = 0; h < hinges_.size(); ++h) {
    for (int a = 0; a < 4; ++a) {
      f.col(hinges_[h].vertices[a]) -= rigidity * bends[h].moment * bends[h].gradient.col(a);
    }
  }
}

void Bending::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const std::vector<Bend>& bends = BendsAt(at);
  const double root = std::sqrt(at.parameters.elasticity() * rigidity_);
  std::array<Eigen::Matrix3d, kPlateVertices> by_vertex;  // of the energy's root [J^(1/2)/m]
  for (const PlateTriangle& triangle : triangles_) {
    std::fill_n(by_vertex.begin(), triangle.vertex_count, Eigen::Matrix3d::Zero());
    for (int i = 0; i < triangle.count; ++i) {
      const Bend& bend = bends[triangle.hinges[i]];
      for (int a = 0; a < 4; ++a) {
        by_vertex[triangle.ends[i][a]] += root * triangle.bend.col(i) * bend.gradient.col(a).transpose();
      }
    }
    for (int a = 0; a < triangle.vertex_count; ++a) {
      for (int b = 0; b < triangle.vertex_count; ++b) {
        sink.Add(triangle.vertices[a], triangle.vertices[b], by_vertex[a].transpose() * by_vertex[b]);
      }
    }
  }
}

double Bending::Energy(const EvalContext& at) const {
  const std::vector<Bend>& bends = BendsAt(at);
  double energy = 0;
  for (const PlateTriangle& triangle : triangles_) energy += CurvatureOf(triangle, bends).squaredNorm();
  return at.parameters.elasticity() * rigidity_ / 2 * energy;
}

}  // namespace phrenic
