#include "server/mechanics/forces/chest_wall.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

constexpr std::array<Force::Output, 2> kHandleOutputs = {{{"pump_handle", "1"}, {"bucket_handle", "1"}}};

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> ChestWall::Make(const v1::ChestWall& scene, const std::string& given,
                                                       std::string_view path, ModelBuilder& builder) {
  auto wall = FindCageWall(scene.wall(), absl::StrCat(std::string(path), ".wall"), builder);
  if (!wall.ok()) return wall.status();
  const auto& [right, left] = (*wall)->volumes;
  const Eigen::Vector2d slope(right.c[0] + left.c[0], right.c[1] + left.c[1]);  // of the volume [m^3]
  std::unique_ptr<ChestWall> force(new ChestWall(given.empty() ? "chest_wall" : given));
  force->stiffening_below_rest_ = scene.stiffening_below_rest();
  force->shortening_loss_ = scene.shortening_loss();
  force->expiratory_share_ = scene.expiratory_share();
  const std::array<const Coordinate*, 2> coordinates = {&(*wall)->pump, &(*wall)->bucket};
  for (size_t i = 0; i < 2; ++i) {
    Handle& handle = force->handles_[i];
    handle.coordinate = *coordinates[i];
    handle.stiffness = slope[static_cast<Eigen::Index>(i)] * slope.sum() / scene.compliance();
    handle.share = i == 0 ? scene.pump_share() : scene.bucket_share();
    const double inertia =
        builder.model.mass[handle.coordinate.vertex] * handle.coordinate.scale * handle.coordinate.scale;
    handle.damping = scene.damping_rate() * inertia;
    if (!(handle.stiffness > 0)) {
      return FieldError(path, absl::StrCat("the volume inside the wall does not grow with the ", handle.coordinate.name,
                                           ": check the ribs' end states"));
    }
  }
  builder.ReportElement(
      "force", force->name(), 2, "coordinates",
      absl::StrFormat("K = %.3g and %.3g J", force->handles_[0].stiffness, force->handles_[1].stiffness));
  return force;
}

absl::Status ChestWall::BalanceAtRest(const ConstPoints& load, const ConstPoints&, ModelBuilder&, Eigen::VectorXd&) {
  for (Handle& handle : handles_) {
    handle.rest_load = -load(handle.coordinate.axis, handle.coordinate.vertex) * handle.coordinate.scale;
  }
  return absl::OkStatus();
}

double ChestWall::Activation(const EvalContext& at) const {
  const v1::Parameters& parameters = at.parameters;
  if (!parameters.apply_muscles()) return 0;
  const double k = (handles_[0].coordinate.Value(at.x) + handles_[1].coordinate.Value(at.x)) / 2;
  const double raise = parameters.intercostal_activation() * parameters.breath_force() * parameters.rib_motion() *
                       std::max(0.0, at.breath) * std::clamp(1 - shortening_loss_ * k, 0.0, 1.5);
  const double lower = expiratory_share_ * parameters.expiratory_activation() * at.expiration;
  return parameters.muscle_strength() * (raise - lower);
}

void ChestWall::AddForce(const EvalContext& at, MutablePoints f) const {
  const double activation = Activation(at), shares[] = {at.parameters.pump_handle(), at.parameters.bucket_handle()};
  for (size_t i = 0; i < handles_.size(); ++i) {
    const Handle& handle = handles_[i];
    const double k = handle.coordinate.Value(at.x);
    const double pull = handle.stiffness * handle.share * shares[i] * activation;
    const double damping = handle.damping * handle.coordinate.Rate(at.v);
    handle.coordinate.AddForce(handle.rest_load - Stiffness(handle, at, k) * k - damping + pull, f);
  }
}

void ChestWall::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  for (const Handle& handle : handles_) {
    const Coordinate& c = handle.coordinate;
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    block(c.axis, c.axis) = Stiffness(handle, at, c.Value(at.x)) / (c.scale * c.scale);
    sink.Add(c.vertex, c.vertex, block);
  }
}

double ChestWall::Energy(const EvalContext& at) const {
  double energy = 0;
  for (const Handle& handle : handles_) {
    const double k = handle.coordinate.Value(at.x);
    energy += Stiffness(handle, at, k) * k * k / 2 - handle.rest_load * k;
  }
  return energy;
}

std::span<const Force::Output> ChestWall::outputs() const { return kHandleOutputs; }

double ChestWall::Read(size_t output, const EvalContext& at) const { return handles_[output].coordinate.Value(at.x); }

}  // namespace phrenic
