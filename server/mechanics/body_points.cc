#include "server/mechanics/body_points.h"

#include <Eigen/Geometry>
#include <vector>

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

// What a pose adds to a point of its rest: displacement [m] and velocity [m/s].
struct Affine {
  Eigen::Matrix3d linear, rate;
  Eigen::Vector3d offset, velocity;

  Affine() = default;
  explicit Affine(const Pose& pose) : offset(pose.translation), velocity(pose.velocity) {
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    linear = rotation - Eigen::Matrix3d::Identity();
    rate = Cross(pose.angular_velocity) * rotation;
  }
};

// Once a call, not once a vertex.
const std::vector<Affine>& ByPose(const Instant& at) {
  thread_local std::vector<Affine> affines;
  affines.resize(at.poses.size());
  for (size_t i = 0; i < affines.size(); ++i) affines[i] = Affine(at.poses[i]);
  return affines;
}

Eigen::Vector3d At(const double* points, Eigen::Index i) { return Eigen::Map<const Eigen::Vector3d>(points + 3 * i); }
void Add(double weight, const Eigen::Vector3d& what, double* points, Eigen::Index i) {
  for (int k = 0; k < 3; ++k) points[3 * i + k] += weight * what[k];
}

}  // namespace

BodyPoints::BodyPoints(const Model& model, int body) : rest_(&model.bodies[body].mesh.vertices) {
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
  if (first_vertex_ >= 0) return at.x.middleCols(first_vertex_, rest_->cols());
  return Place<false>(at).x;
}

BodyPoints::Moving BodyPoints::Locate(const Instant& at) const {
  if (first_vertex_ < 0) return Place<true>(at);
  return {at.x.middleCols(first_vertex_, rest_->cols()), at.v.middleCols(first_vertex_, rest_->cols())};
}

template <bool kVelocities>
BodyPoints::Moving BodyPoints::Place(const Instant& at) const {
  thread_local std::vector<double> positions, velocities;
  Eigen::Map<Points> x = Fit(positions, *rest_), v = Fit(velocities, *rest_);
  x = *rest_;
  if (kVelocities) v.setZero();
  const auto carry = [&](const Affine& pose, Eigen::Index i, double weight) {
    const Eigen::Vector3d rest = At(rest_->data(), i), moved = pose.linear * rest + pose.offset;
    Add(weight, moved, x.data(), i);
    if (!kVelocities) return;
    const Eigen::Vector3d velocity = pose.rate * rest + pose.velocity;
    Add(weight, velocity, v.data(), i);
  };
  if (pose_ >= 0) {
    const Affine pose(at.poses[pose_]);
    for (Eigen::Index i = 0; i < rest_->cols(); ++i) carry(pose, i, 1);
    return {x, v};
  }
  const std::vector<Affine>& by_pose = ByPose(at);
  for (size_t s = 0; s < shares_.size(); ++s) {
    const auto& [vertex, pose, carrier, weight] = shares_[s];
    if (pose >= 0) {
      carry(by_pose[pose], vertex, weight);
      continue;
    }
    const Eigen::Vector3d moved = At(at.x.data(), carrier) - At(carriers_.data(), static_cast<Eigen::Index>(s));
    Add(weight, moved, x.data(), vertex);
    if (kVelocities) Add(weight, At(at.v.data(), carrier), v.data(), vertex);
  }
  return {x, v};
}

}  // namespace phrenic
