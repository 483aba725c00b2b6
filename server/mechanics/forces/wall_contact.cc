#include "server/mechanics/forces/wall_contact.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/normals.h"

namespace phrenic {
namespace {

constexpr std::array<Force::Output, 2> kContactOutputs = {{{"apposed_area", "m^2"}, {"force", "N"}}};
constexpr double kTouching = 1e-3;        // largest distance of an apposed vertex from the wall [m]
constexpr double kTouchingAtRest = 1.5e-3;  // of one that may rest on it [m]

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> WallContact::Make(const v1::WallContact& scene, const std::string& given,
                                                         std::string_view path, ModelBuilder& builder) {
  const std::string field(path);
  const auto bodies = builder.DeformableBodies(scene.bodies(), field + ".bodies");
  if (!bodies.ok()) return bodies.status();
  auto wall = FindCageWall(scene.wall(), field + ".wall", builder);
  if (!wall.ok()) return wall.status();
  std::unique_ptr<WallContact> force(
      new WallContact(ElementName(given, "wall_contact", scene.bodies()), scene, *std::move(wall)));
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    const Eigen::VectorXd areas = VertexAreas(body.mesh.vertices, body.mesh.triangles);
    for (int i = 0; i < areas.size(); ++i) {
      const int vertex = body.first_vertex + i;
      if (builder.model.inverse_mass[vertex] > 0) force->sliders_.push_back({vertex, areas[i]});
    }
  }
  builder.ReportElement("force", force->name(), static_cast<std::int64_t>(force->sliders_.size()), "vertices",
                        absl::StrFormat("slide on %s, %g Pa/m", scene.wall(), scene.stiffness()));
  return force;
}

const WallTable& WallContact::TableAt(const EvalContext& at) const {
  WallTable& table = at.scratch.Get<WallTable>();
  wall_->wall.Evaluate(wall_->Position(at), table);
  return table;
}

void WallContact::AddForce(const EvalContext& at, MutablePoints f) const {
  const WallTable& table = TableAt(at);
  double pump = 0, bucket = 0;
  for (const Slider& slider : sliders_) {
    const WallGap gap = wall_->wall.Gap(table, at.x.col(slider.vertex));
    if (gap.gap <= 0) continue;
    const double push = stiffness_ * slider.area * std::min(gap.gap, largest_depth_);
    f.col(slider.vertex) -= push * gap.gradient;
    pump -= push * gap.by_pump;
    bucket -= push * gap.by_bucket;
  }
  wall_->pump.AddForce(pump, f);
  wall_->bucket.AddForce(bucket, f);
}

// Without the coupling to the cage, which is far softer.
void WallContact::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const WallTable& table = TableAt(at);
  for (const Slider& slider : sliders_) {
    const WallGap gap = wall_->wall.Gap(table, at.x.col(slider.vertex));
    if (gap.gap <= 0 || gap.gap > largest_depth_) continue;
    sink.Add(slider.vertex, slider.vertex,
             stiffness_ * slider.area * gap.gradient * gap.gradient.transpose());
  }
}

void WallContact::AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const WallTable& table = TableAt(at);
  for (const Slider& slider : sliders_) {
    const WallGap gap = wall_->wall.Gap(table, at.x.col(slider.vertex));
    if (gap.gap > 0 && gap.gap <= largest_depth_) continue;
    sink.Add(slider.vertex, slider.vertex,
             stiffness_ * slider.area * gap.gradient * gap.gradient.transpose());
  }
}

void WallContact::AddContactNormals(const EvalContext& at, MutablePoints normals) const {
  const WallTable& table = TableAt(at);
  for (const Slider& slider : sliders_) {
    const WallGap gap = wall_->wall.Gap(table, at.x.col(slider.vertex));
    if (gap.gap > -kTouchingAtRest) normals.col(slider.vertex) += gap.gradient.normalized();
  }
}

double WallContact::Energy(const EvalContext& at) const {
  const WallTable& table = TableAt(at);
  double energy = 0;
  for (const Slider& slider : sliders_) {
    const double gap = wall_->wall.Gap(table, at.x.col(slider.vertex)).gap;
    if (gap <= 0) continue;
    const double depth = std::min(gap, largest_depth_);
    energy += stiffness_ * slider.area * depth * (gap - depth / 2);
  }
  return energy;
}

std::span<const Force::Output> WallContact::outputs() const { return kContactOutputs; }

double WallContact::Read(size_t output, const EvalContext& at) const {
  const WallTable& table = TableAt(at);
  double area = 0, force = 0;
  for (const Slider& slider : sliders_) {
    const WallGap gap = wall_->wall.Gap(table, at.x.col(slider.vertex));
    if (gap.gap > -kTouching) area += slider.area;
    const double push = stiffness_ * slider.area * std::clamp(gap.gap, 0.0, largest_depth_);
    force += push * gap.gradient.norm();
  }
  return output == 0 ? area : force;
}

}  // namespace phrenic
