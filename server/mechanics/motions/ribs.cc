#include "server/mechanics/motions/ribs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

constexpr double kHeadSize = 6e-3;  // radius around the most medial vertex [m]
constexpr double kNoAngle = 1e-6;   // below it the rate of a rotation vector is the angular velocity [rad]

// Returns the position of the rib's head at rest [m].
Eigen::Vector3d Head(const Points& vertices) {
  int medial = 0;
  for (int i = 1; i < vertices.cols(); ++i) {
    if (std::abs(vertices(0, i)) < std::abs(vertices(0, medial))) medial = i;
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int i = 0; i < vertices.cols(); ++i) {
    if ((vertices.col(i) - vertices.col(medial)).norm() > kHeadSize) continue;
    sum += vertices.col(i);
    ++count;
  }
  return sum / count;
}

constexpr int kMostRibs = 12;  // of a side

const v1::RibEndState* EndState(const v1::Ribs& scene, int number) {
  const auto found = std::find_if(scene.end_states().begin(), scene.end_states().end(),
                                  [number](const v1::RibEndState& end) { return end.number() == number; });
  return found == scene.end_states().end() ? nullptr : &*found;
}

absl::Status CheckRib(const BodyModel& body, const v1::Ribs& scene, std::string_view path) {
  const bool is_rib = body.anatomy.structure() == v1::STRUCTURE_RIB && body.anatomy.side() != v1::SIDE_UNSPECIFIED;
  if (body.pose < 0 || !is_rib) {
    return FieldError(path, absl::StrCat("body \"", body.name,
                                         "\" cannot move as a rib: it must have ROLE_DRIVEN and anatomy { structure: "
                                         "STRUCTURE_RIB number: ... side: ... }"));
  }
  if (EndState(scene, body.anatomy.number()) == nullptr) {
    return FieldError(path, absl::StrCat("there is no end state for rib ", body.anatomy.number(), " (body \"",
                                         body.name, "\"): add it to end_states"));
  }
  return absl::OkStatus();
}

absl::Status CheckSegments(const v1::Ribs& scene, std::string_view path) {
  const v1::CageSegments& segments = scene.free().segments();
  if (!scene.free().has_segments()) return absl::OkStatus();
  const std::string field = absl::StrCat(std::string(path), ".free.segments");
  if (segments.first_rib() < 1 || segments.last_rib() > kMostRibs) {
    return FieldError(field, absl::StrCat("ribs have numbers from 1 to ", kMostRibs));
  }
  if (segments.first_rib() > segments.last_rib()) {
    return FieldError(field, absl::StrCat("no rib has a number from ", segments.first_rib(), " to ",
                                          segments.last_rib(), ": first_rib is the smaller one"));
  }
  return absl::OkStatus();
}

// Returns the weights of a rib in the parts of the cage.
std::array<double, kCageParts> WeightsOf(const v1::Anatomy& rib, const v1::FreeCage& cage) {
  const bool right = rib.side() == v1::SIDE_RIGHT;
  std::array<double, kCageParts> weights = {};
  if (cage.has_sides()) weights[kCageSides] = right ? 1 : -1;
  const bool in_segment = rib.number() >= cage.segments().first_rib() && rib.number() <= cage.segments().last_rib();
  if (cage.has_segments() && in_segment) weights[right ? kRightSegment : kLeftSegment] = 1;
  return weights;
}

// Returns the unit axis of a rotation vector.
Eigen::Vector3d Axis(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  return angle > 0 ? Eigen::Vector3d(rotation / angle) : Eigen::Vector3d::UnitX();
}

// Returns the angular velocity of a rotation vector w and its rate w' [rad/s]:
// w' + (1 - cos a)/a^2 w x w' + (a - sin a)/a^3 w x (w x w'), a = |w|.
Eigen::Vector3d AngularVelocity(const Eigen::Vector3d& w, const Eigen::Vector3d& rate) {
  const double angle = w.norm();
  if (angle < kNoAngle) return rate;
  const Eigen::Vector3d cross = w.cross(rate);
  return rate + (1 - std::cos(angle)) / (angle * angle) * cross +
         (angle - std::sin(angle)) / (angle * angle * angle) * w.cross(cross);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Motion>> Ribs::Make(const v1::Ribs& scene, const std::string& given,
                                                   std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "ribs", scene.bodies());
  const std::string field = absl::StrCat(std::string(path), ".bodies");
  auto bodies = builder.Bodies(scene.bodies(), field);
  if (!bodies.ok()) return bodies.status();
  if (absl::Status status = CheckSegments(scene, path); !status.ok()) return status;
  std::unique_ptr<Ribs> motion(new Ribs(name, scene.quiet_state()));
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    if (absl::Status status = CheckRib(body, scene, field); !status.ok()) return status;
    const v1::RibEndState& end = *EndState(scene, body.anatomy.number());
    const double mirror = body.anatomy.side() == v1::SIDE_RIGHT ? 1 : -1;
    const Eigen::Vector3d degrees(-end.pump_degrees(), mirror * end.bucket_degrees(), 0);
    const Eigen::Vector3d t = ToEigen(end.translation());
    motion->ribs_.push_back({body.pose, Head(body.mesh.vertices), degrees * (std::numbers::pi / 180),
                             Eigen::Vector3d(mirror * t.x(), t.y(), t.z()), WeightsOf(body.anatomy, scene.free())});
  }
  if (scene.has_free()) motion->AddCoordinates(scene.free(), builder);
  builder.ReportElement("motion", name, static_cast<std::int64_t>(motion->ribs_.size()), "bodies",
                        scene.has_free()
                            ? "moved by forces"
                            : absl::StrFormat("k = %g at the peak of a quiet breath", scene.quiet_state()));
  return motion;
}

void Ribs::AddCoordinates(const v1::FreeCage& scene, ModelBuilder& builder) {
  free_ = true;
  const auto shared = [&](const char* name, double inertia) {
    const auto found = builder.FindCoordinate(name, "");
    return found.ok() ? *found : builder.AddCoordinate(name, "1", inertia);
  };
  pump_ = shared(kPumpHandle, scene.pump_inertia());
  bucket_ = shared(kBucketHandle, scene.bucket_inertia());
  if (scene.has_sides()) parts_[kCageSides] = shared(kCagePartNames[kCageSides], scene.sides().inertia());
  if (!scene.has_segments()) return;
  for (const CagePart part : {kRightSegment, kLeftSegment}) {
    parts_[part] = shared(kCagePartNames[part], scene.segments().inertia());
  }
}

// Sets the pose of a rib that is turned about its head and moved, given its angular velocity [rad/s].
void Ribs::SetPose(const Rib& rib, const Eigen::AngleAxisd& turn, const Eigen::Vector3d& angular_velocity, double k,
                   double k_rate, State& state) {
  Pose& pose = state.poses[rib.pose];
  pose.rotation = turn;
  const Eigen::Vector3d rotated_head = pose.rotation * rib.head;
  pose.translation = rib.head - rotated_head + k * rib.translation;
  pose.angular_velocity = angular_velocity;
  pose.velocity = k_rate * rib.translation - pose.angular_velocity.cross(rotated_head);
}

void Ribs::DriveByBreath(const EvalContext& at, State& state) const {
  const double k0 = std::min(1.0, quiet_state_ * at.parameters.hyperinflation());
  const double scale = (1 - k0) * (quiet_state_ * at.parameters.rib_motion());
  const double k = k0 + scale * at.breath, k_rate = scale * at.breath_rate;
  const Eigen::Vector3d factors(at.parameters.pump_handle(), at.parameters.bucket_handle(), 1);
  for (const Rib& rib : ribs_) {
    const Eigen::Vector3d rotation = factors.cwiseProduct(rib.rotation);  // at k = 1 [rad]
    const double angle = rotation.norm();
    SetPose(rib, Eigen::AngleAxisd(k * angle, Axis(rotation)), k_rate * rotation, k, k_rate, state);
  }
}

void Ribs::DriveByCoordinates(const EvalContext& at, State& state) const {
  CagePosition shared = {pump_.Value(at.x), bucket_.Value(at.x)}, shared_rate = {pump_.Rate(at.v), bucket_.Rate(at.v)};
  for (size_t i = 0; i < kCageParts; ++i) {
    if (parts_[i]) shared.parts[i] = parts_[i]->Value(at.x), shared_rate.parts[i] = parts_[i]->Rate(at.v);
  }
  for (const Rib& rib : ribs_) {
    const CagePosition here = shared.Of(rib.weight), change = shared_rate.Of(rib.weight);
    const Eigen::Vector3d k(here.pump, here.bucket, 0), rate(change.pump, change.bucket, 0);
    const Eigen::Vector3d rotation = k.cwiseProduct(rib.rotation);
    const Eigen::Vector3d spin = AngularVelocity(rotation, rate.cwiseProduct(rib.rotation));
    SetPose(rib, Eigen::AngleAxisd(rotation.norm(), Axis(rotation)), spin, k.sum() / 2, rate.sum() / 2, state);
  }
}

void Ribs::Drive(const EvalContext& at, State& state) const {
  free_ ? DriveByCoordinates(at, state) : DriveByBreath(at, state);
}

}  // namespace phrenic
