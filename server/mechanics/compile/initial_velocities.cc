#include "server/mechanics/compile/initial_velocities.h"

#include <Eigen/Geometry>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

constexpr double kMaxSpeed = 1e4;  // [m/s]

Eigen::Vector3d CentreOfMass(const BodyModel& body, const Model& model) {
  const auto mass = model.mass.segment(body.first_vertex, body.mesh.vertices.cols());
  return body.mesh.vertices * mass / mass.sum();
}

absl::Status SetSingle(const v1::InitialVelocity& scene, int b, const std::string& path, ModelBuilder& builder) {
  const int first = builder.model.bodies[b].first_vertex;
  for (int i = 0; i < scene.vertices_size(); ++i) {
    const std::string field = absl::StrCat(path, ".vertices[", i, "]");
    const int vertex = scene.vertices(i).vertex();
    if (absl::Status status = builder.CheckVertex(b, vertex, field + ".vertex"); !status.ok()) return status;
    if (builder.model.inverse_mass[first + vertex] == 0) {
      return FieldError(field + ".vertex", absl::StrCat("vertex ", vertex, " is fixed or driven: it has no velocity"));
    }
    builder.model.initial_velocity.col(first + vertex) = ToEigen(scene.vertices(i).velocity());
  }
  return absl::OkStatus();
}

absl::Status CheckSpeeds(const BodyModel& body, const std::string& path, const Model& model) {
  for (Eigen::Index i = 0; i < body.mesh.vertices.cols(); ++i) {
    const double speed = model.initial_velocity.col(body.first_vertex + i).stableNorm();
    if (speed <= kMaxSpeed) continue;
    return FieldError(path,
                      absl::StrCat("vertex ", i, " moves at ", speed, " m/s; at most ", kMaxSpeed, " m/s is accepted"));
  }
  return absl::OkStatus();
}

absl::Status AddTo(int b, const std::string& path, ModelBuilder& builder) {
  Model& model = builder.model;
  const v1::InitialVelocity& scene = model.scene.bodies(b).initial_velocity();
  const BodyModel& body = model.bodies[b];
  if (body.first_vertex < 0) return FieldError(path, "only a deformable body has an initial velocity");
  const Eigen::Vector3d linear = ToEigen(scene.linear()), angular = ToEigen(scene.angular());
  const Eigen::Vector3d centre = CentreOfMass(body, model);
  for (Eigen::Index i = 0; i < body.mesh.vertices.cols(); ++i) {
    if (model.inverse_mass[body.first_vertex + i] == 0) continue;
    model.initial_velocity.col(body.first_vertex + i) = linear + angular.cross(body.mesh.vertices.col(i) - centre);
  }
  if (absl::Status status = SetSingle(scene, b, path, builder); !status.ok()) return status;
  return CheckSpeeds(body, path, model);
}

}  // namespace

absl::Status AddInitialVelocities(ModelBuilder& builder) {
  Model& model = builder.model;
  for (int b = 0; b < model.scene.bodies_size(); ++b) {
    if (!model.scene.bodies(b).has_initial_velocity()) continue;
    if (model.initial_velocity.cols() == 0) model.initial_velocity = Points::Zero(3, model.rest.cols());
    absl::Status status = AddTo(b, absl::StrCat("bodies[", b, "].initial_velocity"), builder);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

void ProjectInitialVelocities(Model& model) {
  if (model.initial_velocity.cols() == 0) return;
  State state = model.InitialState();
  Scratch scratch;
  model.plan->ProjectVelocities(model.parameters, scratch, state);
  model.initial_velocity = state.v;
}

}  // namespace phrenic
