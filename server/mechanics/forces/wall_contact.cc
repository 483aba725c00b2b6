#include "server/mechanics/forces/wall_contact.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/normals.h"

namespace phrenic {
namespace {

constexpr std::array<Force::Output, 2> kContactOutputs = {{{"apposed_area", "m^2"}, {"force", "N"}}};
constexpr double kTouching = 1e-3;       // largest distance of an apposed vertex from the wall [m]
constexpr double kRestsWithin = 1.5e-3;  // of one that may rest on it [m]
constexpr double kSteepestRest = 1.2;    // length of grad g: where the wall is steeper no vertex rests on it

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
      if (builder.model.inverse_mass[vertex] > 0) force->sliders_.push_back({.vertex = vertex, .area = areas[i]});
    }
  }
  force->PlaceAtRest(builder.model);
  builder.ReportElement("force", force->name(), static_cast<std::int64_t>(force->sliders_.size()), "vertices",
                        absl::StrFormat("slide on %s, %g Pa/m", scene.wall(), scene.stiffness()));
  return force;
}

// What is outside of the wall at rest touches it there.
void WallContact::PlaceAtRest(const Model& model) {
  WallTable table;
  wall_->wall.Evaluate({}, {}, table);
  for (Slider& slider : sliders_) {
    const WallGap gap = wall_->wall.Gap(table, model.rest.col(slider.vertex));
    slider.rest_gap = gap.gap;
    slider.rest_gradient = gap.gradient.norm();
    slider.touching = std::max(0.0, gap.gap);
  }
  Pack();
}

void WallContact::Pack() {
  constexpr size_t kLanes = 8;
  packets_.assign((sliders_.size() + kLanes - 1) / kLanes, {});
  for (size_t i = 0; i < packets_.size() * kLanes; ++i) {
    SliderPacket& packet = packets_[i / kLanes];
    const size_t lane = i % kLanes;
    const Slider& slider = sliders_[i < sliders_.size() ? i : i - lane];
    packet.offset[lane] = 3 * slider.vertex;
    packet.stiffness[lane] = stiffness_ * slider.area;
    packet.touching[lane] = slider.touching;
    if (i < sliders_.size()) ++packet.count;
  }
}

void WallContact::RestOnSurface(const Eigen::VectorXd& pushes) {
  for (Slider& slider : sliders_) {
    const double push = pushes[slider.vertex];
    if (push <= 0) continue;
    const double depth = push / (stiffness_ * slider.area * slider.rest_gradient);
    slider.touching = slider.rest_gap - depth;
    margin_ = std::max(margin_, -slider.touching);
  }
  Pack();
}

template <typename Visit>
void WallContact::ForEachNear(const EvalContext& at, const Visit& visit) const {
  const WallTable& table = wall_->TableAt(at);
  for (const Slider& slider : sliders_) {
    const Eigen::Vector3d point = at.x.col(slider.vertex);
    if (!wall_->wall.IsFarInside(table, point, margin_)) visit(slider, wall_->wall.Gap(table, point));
  }
}

void WallContact::AddForce(const EvalContext& at, MutablePoints f) const {
  const WallReaction push =
      PushFromWall(packets_, wall_->wall.frame(), wall_->TableAt(at), margin_, largest_depth_, at.x.data(), f.data());
  wall_->pump.AddForce(push.pump, f);
  wall_->bucket.AddForce(push.bucket, f);
  wall_->AddPartForces(push.parts, at, f);
}

// Without the coupling to the cage, which is far softer.
void WallContact::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  ForEachNear(at, [&](const Slider& slider, const WallGap& gap) {
    if (!Yields(slider, gap)) return;
    sink.Add(slider.vertex, slider.vertex, stiffness_ * slider.area * gap.gradient * gap.gradient.transpose());
  });
}

void WallContact::AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const WallTable& table = wall_->TableAt(at);
  for (const Slider& slider : sliders_) {
    const WallGap gap = wall_->wall.Gap(table, at.x.col(slider.vertex));
    if (Yields(slider, gap)) continue;
    sink.Add(slider.vertex, slider.vertex, stiffness_ * slider.area * gap.gradient * gap.gradient.transpose());
  }
}

void WallContact::AddContactNormals(const EvalContext& at, MutablePoints normals) const {
  ForEachNear(at, [&](const Slider& slider, const WallGap& gap) {
    const double steepness = gap.gradient.norm();
    if (gap.gap > -kRestsWithin && steepness < kSteepestRest) normals.col(slider.vertex) += gap.gradient / steepness;
  });
}

double WallContact::Energy(const EvalContext& at) const {
  double energy = 0;
  ForEachNear(at, [&](const Slider& slider, const WallGap& gap) {
    const double beyond = gap.gap - slider.touching;
    if (beyond <= 0) return;
    const double depth = std::min(beyond, largest_depth_);
    energy += stiffness_ * slider.area * depth * (beyond - depth / 2);
  });
  return energy;
}

std::span<const Force::Output> WallContact::outputs() const { return kContactOutputs; }

double WallContact::Read(size_t output, const EvalContext& at) const {
  double sum = 0;
  if (output == 0) {
    const WallTable& table = wall_->TableAt(at);
    for (const Slider& slider : sliders_) {
      const Eigen::Vector3d point = at.x.col(slider.vertex);
      if (wall_->wall.IsFarInside(table, point, margin_)) continue;
      if (wall_->wall.GapAlone(table, point) > std::min(slider.touching, 0.0) - kTouching) sum += slider.area;
    }
    return sum;
  }
  ForEachNear(at, [&](const Slider& slider, const WallGap& gap) {
    const double push = stiffness_ * slider.area * std::clamp(gap.gap - slider.touching, 0.0, largest_depth_);
    sum += push * gap.gradient.norm();
  });
  return sum;
}

}  // namespace phrenic
