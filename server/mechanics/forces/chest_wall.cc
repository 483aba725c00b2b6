#include "server/mechanics/forces/chest_wall.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/breathing/expiratory_muscles.h"

namespace phrenic {
namespace {

constexpr std::array<Force::Output, 5> kHandleOutputs = {{{"pump_handle", "1"},
                                                          {"bucket_handle", "1"},
                                                          {"sides_apart", "1"},
                                                          {"right_segment", "1"},
                                                          {"left_segment", "1"}}};
constexpr double kHoldingRate = 20;   // of a part that is led back to where it is held [1/s]
constexpr double kLeastFlail = 0.05;  // a segment that is broken at all is no stiffer

double InertiaOf(const Coordinate& c, const Model& model) { return model.mass[c.vertex] * c.scale * c.scale; }

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> ChestWall::Make(const v1::ChestWall& scene, const std::string& given,
                                                       std::string_view path, ModelBuilder& builder) {
  auto wall = FindCageWall(scene.wall(), absl::StrCat(std::string(path), ".wall"), builder);
  if (!wall.ok()) return wall.status();
  const CageQuadratic &right = (*wall)->volumes.right.shared, &left = (*wall)->volumes.left.shared;
  const Eigen::Vector2d slope(right.c[0] + left.c[0], right.c[1] + left.c[1]);  // of the volume [m^3]
  std::unique_ptr<ChestWall> force(new ChestWall(given.empty() ? "chest_wall" : given));
  force->wall_ = *wall;
  force->stiffening_below_rest_ = scene.stiffening_below_rest();
  force->shortening_loss_ = scene.shortening_loss();
  force->expiratory_share_ = scene.expiratory_share();
  force->expiratory_pressure_ = scene.expiratory_pressure();
  force->expiratory_range_ = scene.expiratory_range();
  const std::array<const Coordinate*, 2> coordinates = {&(*wall)->pump, &(*wall)->bucket};
  for (size_t i = 0; i < 2; ++i) {
    Handle& handle = force->handles_[i];
    handle.coordinate = *coordinates[i];
    handle.stiffness = slope[static_cast<Eigen::Index>(i)] * slope.sum() / scene.compliance();
    handle.slope = slope[static_cast<Eigen::Index>(i)];
    handle.share = i == 0 ? scene.pump_share() : scene.bucket_share();
    handle.damping = scene.damping_rate() * InertiaOf(handle.coordinate, builder.model);
    if (!(handle.stiffness > 0)) {
      return FieldError(path, absl::StrCat("the volume inside the wall does not grow with the ", handle.coordinate.name,
                                           ": check the ribs' end states"));
    }
  }
  if (absl::Status status = force->AddParts(scene, path, builder); !status.ok()) return status;
  if (force->advances_scalars()) {
    force->expiration_ = builder.AddInternalScalars(force->name() + ":expiration", "1", 1);
  }
  builder.ReportElement(
      "force", force->name(), 2 + static_cast<std::int64_t>(force->parts_.size()), "coordinates",
      absl::StrFormat("K = %.3g and %.3g J", force->handles_[0].stiffness, force->handles_[1].stiffness));
  return force;
}

absl::Status ChestWall::AddParts(const v1::ChestWall& scene, std::string_view path, const ModelBuilder& builder) {
  for (const CagePart part : {kCageSides, kRightSegment, kLeftSegment}) {
    if (!wall_->parts[part]) continue;
    const Coordinate& coordinate = *wall_->parts[part];
    const double slope = wall_->volumes.right.ByPart({}, part) + wall_->volumes.left.ByPart({}, part);
    if (part != kCageSides && !(slope > 0)) {
      return FieldError(path, absl::StrCat("the volume inside the wall does not grow with the ", coordinate.name,
                                           ": name ribs of the scene in free.segments"));
    }
    const double stiffness = part == kCageSides
                                 ? scene.side_coupling() * (handles_[0].stiffness + handles_[1].stiffness)
                                 : slope * slope / scene.segment_compliance();
    const double inertia = InertiaOf(coordinate, builder.model);
    parts_.push_back(
        {part, coordinate, stiffness, scene.damping_rate() * inertia, kHoldingRate * kHoldingRate * inertia, 0});
  }
  return absl::OkStatus();
}

absl::Status ChestWall::BalanceAtRest(const ConstPoints& load, const ConstPoints&, ModelBuilder&, Eigen::VectorXd&) {
  for (Handle& handle : handles_) {
    handle.rest_load = -load(handle.coordinate.axis, handle.coordinate.vertex) * handle.coordinate.scale;
  }
  for (Part& part : parts_) {
    part.rest_load = -load(part.coordinate.axis, part.coordinate.vertex) * part.coordinate.scale;
  }
  return absl::OkStatus();
}

double ChestWall::Activation(const EvalContext& at, double share) const {
  const v1::Parameters& parameters = at.parameters;
  if (!parameters.apply_muscles()) return 0;
  const double k = (handles_[0].coordinate.Value(at.x) + handles_[1].coordinate.Value(at.x)) / 2;
  const double raise = parameters.intercostal_activation() * parameters.breath_force() * parameters.rib_motion() *
                       std::max(0.0, at.breath) * std::clamp(1 - shortening_loss_ * k, 0.0, 1.5);
  const double lower = expiratory_share_ * parameters.expiratory_activation() * at.expiration;
  return parameters.muscle_strength() * (share * raise - lower);
}

void ChestWall::SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const {
  if (advances_scalars()) rates[expiration_] = ExpiratoryRate(at, at.scalars.q[expiration_]);
}

void ChestWall::AdvanceScalars(const EvalContext& end, std::int64_t, double dt, ScalarState& scalars) const {
  if (advances_scalars()) scalars.q[expiration_] = AdvanceExpiratory(end, dt, scalars.q[expiration_]);
}

double ChestWall::Expiratory(const Handle& handle, const EvalContext& at, double k) const {
  if (!advances_scalars()) return 0;
  const double activation = at.parameters.muscle_strength() * at.scalars.q[expiration_];
  return -handle.slope * expiratory_pressure_ * activation * std::clamp(1 + k / expiratory_range_, 0.0, 1.0);
}

double ChestWall::ExpiratoryStiffness(const Handle& handle, const EvalContext& at, double k) const {
  if (!advances_scalars() || k > 0 || k < -expiratory_range_) return 0;
  const double activation = at.parameters.muscle_strength() * at.scalars.q[expiration_];
  return handle.slope * expiratory_pressure_ * activation / expiratory_range_;
}

const ChestWall::Part* ChestWall::Sides() const {
  return !parts_.empty() && parts_.front().part == kCageSides ? &parts_.front() : nullptr;
}

std::array<ChestWall::HalfHandle, 2> ChestWall::Halves(const Handle& handle, double tilt, const EvalContext& at) const {
  const v1::Parameters& p = at.parameters;
  const double k = handle.coordinate.Value(at.x), apart = tilt - p.cage_tilt();
  const double compliances[] = {p.right_cage_compliance(), p.left_cage_compliance()};
  const double muscles[] = {p.right_intercostals(), p.left_intercostals()};
  std::array<HalfHandle, 2> halves;
  for (size_t side = 0; side < 2; ++side) {
    HalfHandle& half = halves[side];
    half.sign = side == 0 ? 1 : -1;
    half.beyond = k + half.sign * apart;
    half.stiffness = Stiffness(handle, at, half.beyond) / (2 * compliances[side]);
    half.pull = handle.stiffness / 2 * handle.share * Activation(at, muscles[side]);
    half.press = Expiratory(handle, at, k + half.sign * tilt) / 2;
  }
  return halves;
}

double ChestWall::SegmentStiffness(const Part& part, const EvalContext& at) const {
  const double flail = part.part == kRightSegment ? at.parameters.flail_right() : at.parameters.flail_left();
  return part.stiffness / std::max(flail, kLeastFlail);
}

// The forces of recoil and muscles where each side has its own.
void ChestWall::AddForceOfSides(const EvalContext& at, MutablePoints f) const {
  const Part& sides = *Sides();
  const double tilt = sides.coordinate.Value(at.x),
               shares[] = {at.parameters.pump_handle(), at.parameters.bucket_handle()};
  double apart = sides.rest_load - sides.damping * sides.coordinate.Rate(at.v) -
                 sides.stiffness * (tilt - at.parameters.cage_tilt());
  for (size_t i = 0; i < handles_.size(); ++i) {
    const Handle& handle = handles_[i];
    double force = handle.rest_load - handle.damping * handle.coordinate.Rate(at.v);
    for (const HalfHandle& half : Halves(handle, tilt, at)) {
      const double of_half = shares[i] * half.pull + half.press - half.stiffness * half.beyond;
      force += of_half;
      apart += half.sign * of_half;
    }
    handle.coordinate.AddForce(force, f);
  }
  sides.coordinate.AddForce(apart, f);
}

// The forces on segments, and on what is held.
void ChestWall::AddForceOfParts(const EvalContext& at, MutablePoints f) const {
  for (const Part& part : parts_) {
    const double u = part.coordinate.Value(at.x), damping = part.damping * part.coordinate.Rate(at.v);
    if (!wall_->Moves(part.part, at)) {
      part.coordinate.AddForce(-part.holding * u - damping, f);
    } else if (part.part != kCageSides) {
      part.coordinate.AddForce(part.rest_load - SegmentStiffness(part, at) * u * (1 + u * u) - damping, f);
    }
  }
}

void ChestWall::AddForce(const EvalContext& at, MutablePoints f) const {
  AddForceOfParts(at, f);
  if (SidesMove(at)) {
    AddForceOfSides(at, f);
    return;
  }
  const double activation = Activation(at), shares[] = {at.parameters.pump_handle(), at.parameters.bucket_handle()};
  for (size_t i = 0; i < handles_.size(); ++i) {
    const Handle& handle = handles_[i];
    const double k = handle.coordinate.Value(at.x);
    const double pull = handle.stiffness * handle.share * shares[i] * activation;
    const double damping = handle.damping * handle.coordinate.Rate(at.v);
    const double press = Expiratory(handle, at, k);
    handle.coordinate.AddForce(handle.rest_load - Stiffness(handle, at, k) * k - damping + pull + press, f);
  }
}

void ChestWall::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  for (const Handle& handle : handles_) {
    const Coordinate& c = handle.coordinate;
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    const double k = c.Value(at.x);
    block(c.axis, c.axis) = (Stiffness(handle, at, k) + ExpiratoryStiffness(handle, at, k)) / (c.scale * c.scale);
    sink.Add(c.vertex, c.vertex, block);
  }
  for (const Part& part : parts_) {
    const Coordinate& c = part.coordinate;
    const double u = c.Value(at.x);
    double stiffness = part.holding;
    if (wall_->Moves(part.part, at)) {
      stiffness = part.part == kCageSides
                      ? part.stiffness + Stiffness(handles_[0], at, u) + Stiffness(handles_[1], at, u)
                      : SegmentStiffness(part, at) * (1 + 3 * u * u);
    }
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    block(c.axis, c.axis) = stiffness / (c.scale * c.scale);
    sink.Add(c.vertex, c.vertex, block);
  }
}

double ChestWall::EnergyOfSides(const EvalContext& at) const {
  const Part& sides = *Sides();
  const double tilt = sides.coordinate.Value(at.x), apart = tilt - at.parameters.cage_tilt();
  double energy = sides.stiffness * apart * apart / 2 - sides.rest_load * tilt;
  for (const Handle& handle : handles_) {
    for (const HalfHandle& half : Halves(handle, tilt, at)) energy += half.stiffness * half.beyond * half.beyond / 2;
    energy -= handle.rest_load * handle.coordinate.Value(at.x);
  }
  return energy;
}

double ChestWall::Energy(const EvalContext& at) const {
  double energy = SidesMove(at) ? EnergyOfSides(at) : 0;
  for (const Part& part : parts_) {
    const double u = part.coordinate.Value(at.x);
    if (!wall_->Moves(part.part, at)) {
      energy += part.holding * u * u / 2;
    } else if (part.part != kCageSides) {
      energy += SegmentStiffness(part, at) * u * u * (1 + u * u / 2) / 2 - part.rest_load * u;
    }
  }
  if (SidesMove(at)) return energy;
  for (const Handle& handle : handles_) {
    const double k = handle.coordinate.Value(at.x);
    energy += Stiffness(handle, at, k) * k * k / 2 - handle.rest_load * k;
  }
  return energy;
}

std::span<const Force::Output> ChestWall::outputs() const { return kHandleOutputs; }

double ChestWall::Read(size_t output, const EvalContext& at) const {
  if (output < handles_.size()) return handles_[output].coordinate.Value(at.x);
  const auto& part = wall_->parts[output - handles_.size()];
  return part ? part->Value(at.x) : 0;
}

}  // namespace phrenic
