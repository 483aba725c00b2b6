#include "server/mechanics/skinning/pose_matrices.h"

#include <Eigen/Geometry>

namespace phrenic {

PoseMatrices::PoseMatrices(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const Eigen::Vector3d& w = pose.angular_velocity;
  Eigen::Map<Eigen::Matrix<double, 8, 4>, Eigen::Aligned64> columns(column[0]);
  columns.setZero();
  columns.topLeftCorner<3, 3>() = rotation - Eigen::Matrix3d::Identity();
  columns.block<3, 1>(0, 3) = pose.translation;
  for (int k = 0; k < 3; ++k) columns.block<3, 1>(4, k) = w.cross(rotation.col(k));
  columns.block<3, 1>(4, 3) = pose.velocity;
}

std::span<const PoseMatrices> MakePoseMatrices(const std::vector<Pose>& poses, std::vector<PoseMatrices>& memory) {
  memory.clear();
  for (const Pose& pose : poses) memory.emplace_back(pose);
  return memory;
}

std::span<const PoseMatrices> PoseMatricesOf(const EvalContext& at) {
  if (at.columns != nullptr) return {at.columns, at.poses.size()};
  thread_local std::vector<PoseMatrices> memory;
  return MakePoseMatrices(at.poses, memory);
}

}  // namespace phrenic
