#include "server/imaging/surfaces/voxelised_parts.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/imaging/voxelise.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

constexpr double kVoxel = 1.5;       // [mm]
constexpr double kMostOfGrid = 2e7;  // voxels
constexpr double kMostOfParts = 2e8;
constexpr double kFree = 6;          // free voxels around what is voxelised
constexpr double kLargest = 3000;    // extent of all surfaces together [mm]
constexpr double kMarginOfMask = 3;  // voxels

// Returns the number of voxels of this size [mm] that the sizes [mm] need, with a margin along each axis.
double VoxelCount(const Eigen::Vector3d& sizes, double voxel, double margin) {
  return ((sizes / voxel).array().ceil() + margin).prod();
}

// Returns an empty grid around the box [mm]. Flat boxes too have at most kMostOfGrid voxels.
LabelVolume GridAround(const Eigen::AlignedBox3d& box) {
  double voxel = kVoxel;
  while (VoxelCount(box.sizes(), voxel, 2 * kFree) > kMostOfGrid) voxel *= 1.02;
  LabelVolume volume;
  volume.size = (box.sizes() / voxel).array().ceil().cast<int>() + static_cast<int>(2 * kFree);
  volume.to_patient.linear() = voxel * Eigen::Matrix3d::Identity();
  volume.to_patient.translation() = box.min() - Eigen::Vector3d::Constant(kFree * voxel);
  volume.labels.assign(static_cast<std::size_t>(volume.size.x()) * volume.size.y() * volume.size.z(), 0);
  return volume;
}

Eigen::AlignedBox3d BoxAround(const Points& vertices) {
  return {Eigen::Vector3d(vertices.rowwise().minCoeff() / kMillimetre),
          Eigen::Vector3d(vertices.rowwise().maxCoeff() / kMillimetre)};
}

}  // namespace

absl::StatusOr<VoxelisedParts> VoxeliseParts(const std::vector<PatientBody>& bodies, const GoOn& go_on) {
  Eigen::AlignedBox3d box;
  double voxels = 0;
  for (const PatientBody& body : bodies) {
    if (body.mesh.triangles.cols() == 0) {
      return absl::InvalidArgumentError(absl::StrCat("body \"", body.name, "\": has no triangles to enclose a part"));
    }
    const Eigen::AlignedBox3d own = BoxAround(body.mesh.vertices);
    if (!own.sizes().allFinite()) {
      return absl::InvalidArgumentError(absl::StrCat("body \"", body.name, "\": is not finite"));
    }
    box.extend(own);
  }
  if (bodies.empty()) return absl::InvalidArgumentError("there are no surfaces from which to derive others");
  if (box.sizes().maxCoeff() > kLargest) {
    return absl::InvalidArgumentError(absl::StrCat("the surfaces from which others are derived extend over ",
                                                   box.sizes().maxCoeff(), " mm, and a thorax is smaller than ",
                                                   kLargest, ": check their units and offsets"));
  }
  VoxelisedParts voxelised{GridAround(box), {}};
  const double voxel = voxelised.volume.Spacing().x();
  for (const PatientBody& body : bodies) {
    if (absl::Status status = go_on(); !status.ok()) return status;
    voxels += VoxelCount(BoxAround(body.mesh.vertices).sizes(), voxel, kMarginOfMask);
    if (voxels > kMostOfParts) return absl::ResourceExhaustedError("too many large surfaces to derive others from");
    Part& part = voxelised.parts.emplace_back();
    part.name = body.name;
    part.anatomy = body.anatomy;
    part.mask = VoxeliseMask(body.mesh, voxelised.volume, 1);
    part.label_voxels = part.mask.Count();
    if (part.label_voxels > 0) continue;
    return absl::InvalidArgumentError(absl::StrCat("body \"", body.name, "\": encloses no voxel of ", voxel,
                                                   " mm: is its unit right, is it closed?"));
  }
  return voxelised;
}

}  // namespace phrenic::imaging
