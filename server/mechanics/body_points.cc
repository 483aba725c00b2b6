#include "server/mechanics/body_points.h"

#include <Eigen/Geometry>

namespace phrenic {
namespace {

// Memory that keeps its capacity from body to body.
Eigen::Map<Points> Fit(std::vector<double>& memory, const Points& like) {
  memory.resize(static_cast<size_t>(like.size()));
  return {memory.data(), 3, like.cols()};
}

// a x . [1/s] as a matrix
Eigen::Matrix3d Cross(const Eigen::Vector3d& a) {
  return Eigen::Matrix3d{{0, -a.z(), a.y()}, {a.z(), 0, -a.x()}, {-a.y(), a.x(), 0}};
}

// What becomes of each pose; once a call, not once a vertex.
template <typename Of>
const std::vector<Affine>& ByPose(const Instant& at, const Of& of) {
  thread_local std::vector<Affine> affines;
  affines.resize(at.poses.size());
  for (size_t i = 0; i < affines.size(); ++i) affines[i] = of(at.poses[i]);
  return affines;
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

ConstPoints BodyPoints::Positions(const Instant& at) const {
  if (first_vertex_ >= 0) return at.x.middleCols(first_vertex_, rest_.cols());
  thread_local std::vector<double> positions;
  Buffer x = Fit(positions, rest_);
  x = rest_;
  const auto moved = [](const Pose& pose) {
    return Affine{pose.rotation.toRotationMatrix() - Eigen::Matrix3d::Identity(), pose.translation};
  };
  if (pose_ >= 0) {
    Carry(moved(at.poses[pose_]), x);
  } else {
    Ride(
        ByPose(at, moved), [&at, this](int carrier, Eigen::Index s) { return at.x.col(carrier) - carriers_.col(s); },
        x);
  }
  return x;
}

BodyPoints::Moving BodyPoints::Locate(const Instant& at) const {
  if (first_vertex_ >= 0) return {Positions(at), at.v.middleCols(first_vertex_, rest_.cols())};
  thread_local std::vector<double> velocities;
  Buffer v = Fit(velocities, rest_);
  v.setZero();
  const auto moving = [](const Pose& pose) {
    return Affine{Cross(pose.angular_velocity) * pose.rotation.toRotationMatrix(), pose.velocity};
  };
  if (pose_ >= 0) {
    Carry(moving(at.poses[pose_]), v);
  } else {
    Ride(
        ByPose(at, moving), [&at](int carrier, Eigen::Index) { return at.v.col(carrier); }, v);
  }
  return {Positions(at), v};
}

void BodyPoints::Carry(const Affine& affine, Buffer& y) const {
  for (Eigen::Index i = 0; i < y.cols(); ++i) y.col(i) += affine.linear * rest_.col(i) + affine.offset;
}

template <typename OfCarrier>
void BodyPoints::Ride(const std::vector<Affine>& by_pose, const OfCarrier& of_carrier, Buffer& y) const {
  for (size_t s = 0; s < shares_.size(); ++s) {
    const RideShare& share = shares_[s];
    if (share.pose >= 0) {
      const Affine& affine = by_pose[static_cast<size_t>(share.pose)];
      y.col(share.vertex) += share.weight * (affine.linear * rest_.col(share.vertex) + affine.offset);
    } else {
      y.col(share.vertex) += share.weight * of_carrier(share.simulated_vertex, static_cast<Eigen::Index>(s));
    }
  }
}

}  // namespace phrenic
