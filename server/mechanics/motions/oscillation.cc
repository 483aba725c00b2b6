#include "server/mechanics/motions/oscillation.h"

#include <cmath>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Motion>> Oscillation::Make(const v1::Oscillation& scene, const std::string& given,
                                                          std::string_view path, ModelBuilder& builder) {
  const std::string field(path);
  const std::string name = given.empty() ? absl::StrCat("oscillation:", scene.body()) : given;
  auto b = builder.Body(scene.body(), absl::StrCat(field, ".body"));
  if (!b.ok()) return b.status();
  const BodyModel& body = builder.model.bodies[*b];
  if (body.first_vertex < 0) return FieldError(absl::StrCat(field, ".body"), "the body is not ROLE_DEFORMABLE");
  std::unique_ptr<Oscillation> motion(new Oscillation(name));
  motion->rest_.resize(3, scene.vertices_size());
  for (int i = 0; i < scene.vertices_size(); ++i) {
    const std::string where = absl::StrCat(field, ".vertices[", i, "]");
    if (absl::Status status = builder.CheckVertex(*b, scene.vertices(i), where); !status.ok()) return status;
    const int vertex = body.first_vertex + scene.vertices(i);
    motion->vertices_.push_back(vertex);
    motion->rest_.col(i) = builder.model.rest.col(vertex);
    builder.model.inverse_mass[vertex] = 0;
    builder.model.driven_vertices.push_back(vertex);
  }
  motion->amplitude_ = ToEigen(scene.amplitude());
  motion->frequency_ = 2 * std::numbers::pi / scene.period();
  motion->scaled_ = scene.scaled_by_breath_force();
  builder.ReportElement("motion", name, scene.vertices_size(), "vertices",
                        absl::StrFormat("amplitude %g m, period %g s", motion->amplitude_.norm(), scene.period()));
  return motion;
}

void Oscillation::Drive(const EvalContext& at, State& state) const {
  const double scale = scaled_ ? at.parameters.breath_force() : 1;
  const Eigen::Vector3d displacement = scale * std::sin(frequency_ * at.time) * amplitude_;
  const Eigen::Vector3d velocity = scale * frequency_ * std::cos(frequency_ * at.time) * amplitude_;
  for (size_t i = 0; i < vertices_.size(); ++i) {
    state.x.col(vertices_[i]) = rest_.col(static_cast<Eigen::Index>(i)) + displacement;
    state.v.col(vertices_[i]) = velocity;
  }
}

}  // namespace phrenic
