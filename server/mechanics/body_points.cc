#include "server/mechanics/body_points.h"

namespace phrenic {
namespace {

// Memory that keeps its capacity from body to body.
Eigen::Map<Points> Fit(std::vector<double>& memory, const Points& like) {
  memory.resize(static_cast<size_t>(like.size()));
  return {memory.data(), 3, like.cols()};
}

}  // namespace

BodyPoints::BodyPoints(const Model& model, int body) : rest_(model.bodies[body].mesh.vertices) {
  const BodyModel& of = model.bodies[body];
  first_vertex_ = of.first_vertex;
  pose_ = of.pose;
  if (of.ride < 0) return;
  shares_ = model.rides[of.ride].shares;
  carriers_ = Points::Zero(3, static_cast<Eigen::Index>(shares_.size()));
  for (size_t s = 0; s < shares_.size(); ++s) {
    const int carrier = shares_[s].simulated_vertex;
    if (carrier >= 0) carriers_.col(static_cast<Eigen::Index>(s)) = model.rest.col(carrier);
  }
}

BodyPoints::Moving BodyPoints::Locate(const Instant& at) const {
  if (first_vertex_ >= 0) {
    return {at.x.middleCols(first_vertex_, rest_.cols()), at.v.middleCols(first_vertex_, rest_.cols())};
  }
  thread_local std::vector<double> positions, velocities;
  Buffer x = Fit(positions, rest_), v = Fit(velocities, rest_);
  x = rest_;
  v.setZero();
  if (pose_ >= 0) {
    Carry(at.poses[pose_], x, v);
  } else {
    Ride(at, x, v);
  }
  return {x, v};
}

void BodyPoints::Carry(const Pose& pose, Buffer& x, Buffer& v) const {
  for (Eigen::Index i = 0; i < rest_.cols(); ++i) {
    x.col(i) = pose.At(rest_.col(i));
    v.col(i) = pose.VelocityAt(rest_.col(i));
  }
}

void BodyPoints::Ride(const Instant& at, Buffer& x, Buffer& v) const {
  for (size_t s = 0; s < shares_.size(); ++s) {
    const RideShare& share = shares_[s];
    const Eigen::Vector3d rest = rest_.col(share.vertex);
    if (share.pose >= 0) {
      x.col(share.vertex) += share.weight * (at.poses[share.pose].At(rest) - rest);
      v.col(share.vertex) += share.weight * at.poses[share.pose].VelocityAt(rest);
    } else {
      const int carrier = share.simulated_vertex;
      x.col(share.vertex) += share.weight * (at.x.col(carrier) - carriers_.col(static_cast<Eigen::Index>(s)));
      v.col(share.vertex) += share.weight * at.v.col(carrier);
    }
  }
}

}  // namespace phrenic
