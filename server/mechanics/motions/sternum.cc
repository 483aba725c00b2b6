#include "server/mechanics/motions/sternum.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"

namespace phrenic {
namespace {

constexpr double kEndSize = 8e-3;  // radius around the most anterior vertex [m]

// Returns the mean of the vertices near the most anterior one [m].
Eigen::Vector3d AnteriorEnd(const Points& vertices) {
  Eigen::Index front = 0;
  vertices.row(1).minCoeff(&front);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    if ((vertices.col(i) - vertices.col(front)).norm() > kEndSize) continue;
    sum += vertices.col(i);
    ++count;
  }
  return sum / count;
}

// Returns the rotation by `angle` [rad] about the x axis that maps `from` to `to`, without the x component.
Pose SagittalPose(double angle, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX());
  pose.translation = to - pose.rotation * from;
  pose.translation.x() = 0;
  return pose;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Motion>> Sternum::Make(const v1::Sternum& scene, const std::string& given,
                                                      std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "sternum", scene.bodies());
  const std::string field(path);
  auto bodies = builder.Bodies(scene.bodies(), absl::StrCat(field, ".bodies"));
  if (!bodies.ok()) return bodies.status();
  auto ribs = builder.Bodies(scene.ribs(), absl::StrCat(field, ".ribs"));
  if (!ribs.ok()) return ribs.status();
  std::unique_ptr<Sternum> motion(new Sternum(name));
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    if (body.pose < 0)
      return FieldError(absl::StrCat(field, ".bodies"), "body \"" + body.name + "\" is not ROLE_DRIVEN");
    motion->poses_.push_back(body.pose);
  }
  for (const int b : *ribs) {
    const BodyModel& rib = builder.model.bodies[b];
    if (rib.pose < 0 || rib.anatomy.structure() != v1::STRUCTURE_RIB) continue;
    if (rib.anatomy.number() > scene.last_rib()) continue;
    motion->ends_.push_back({rib.pose, AnteriorEnd(rib.mesh.vertices)});
  }
  if (motion->ends_.size() < 2) {
    return FieldError(absl::StrCat(field, ".ribs"), "must name at least two driven ribs up to last_rib");
  }
  builder.ReportElement("motion", name, static_cast<std::int64_t>(motion->poses_.size()), "bodies",
                        absl::StrCat("fitted to the ends of ", motion->ends_.size(), " ribs, no lateral motion"));
  return motion;
}

void Sternum::Drive(const EvalContext&, State& state) const {
  const double count = static_cast<double>(ends_.size());
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = from, drift = from;
  for (const RibEnd& end : ends_) {
    from += end.rest / count;
    to += state.poses[end.pose].At(end.rest) / count;
    drift += state.poses[end.pose].VelocityAt(end.rest) / count;
  }
  double sine = 0, cosine = 0, moment = 0, inertia = 0;
  for (const RibEnd& end : ends_) {
    const Eigen::Vector3d p = end.rest - from, q = state.poses[end.pose].At(end.rest) - to;
    const Eigen::Vector3d rate = state.poses[end.pose].VelocityAt(end.rest) - drift;
    sine += p.y() * q.z() - p.z() * q.y();
    cosine += p.y() * q.y() + p.z() * q.z();
    moment += q.y() * rate.z() - q.z() * rate.y();
    inertia += q.y() * q.y() + q.z() * q.z();
  }
  Pose pose = SagittalPose(std::atan2(sine, cosine), from, to);
  pose.angular_velocity = Eigen::Vector3d(inertia > 0 ? moment / inertia : 0, 0, 0);
  pose.velocity = drift - pose.angular_velocity.cross(pose.rotation * from);
  pose.velocity.x() = 0;
  for (const int index : poses_) state.poses[index] = pose;
}

}  // namespace phrenic
