#include "server/mechanics/skinning/pose_matrices.h"

#include <Eigen/Geometry>
#include <vector>

namespace phrenic {
namespace {

struct AllMatrices {
  std::vector<PoseMatrices> of_poses;
};

}  // namespace

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

std::span<const PoseMatrices> PoseMatricesOf(const EvalContext& at) {
  if (at.pose_matrices != nullptr) return {at.pose_matrices, at.poses.size()};
  std::vector<PoseMatrices>& matrices = at.scratch.Get<AllMatrices>().of_poses;
  matrices.clear();
  for (const Pose& pose : at.poses) matrices.emplace_back(pose);
  return matrices;
}

}  // namespace phrenic
