#include "server/imaging/label_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/anatomy/meshing/implicit_surface.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

constexpr double kBlur = 0.7;       // standard deviation of the Gaussian, relative to the longest voxel edge
constexpr double kReach = 2.5;      // truncation of the Gaussian [standard deviations]
constexpr std::size_t kFewest = 8;  // voxels of the smallest mask

// Returns the standard deviation along an axis [voxels].
double Sigma(const LabelVolume& volume, int axis) {
  const Eigen::Vector3d spacing = volume.Spacing();
  return kBlur * spacing.maxCoeff() / spacing[axis];
}

// Returns a truncated Gaussian with unit sum.
std::vector<float> Kernel(double sigma) {
  const int reach = static_cast<int>(std::ceil(kReach * sigma));
  std::vector<float> kernel;
  float sum = 0;
  for (int d = -reach; d <= reach; ++d) {
    kernel.push_back(static_cast<float>(std::exp(-d * d / (2 * sigma * sigma))));
    sum += kernel.back();
  }
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

// A mask blurred by a Gaussian: 1 deep inside, 0 far outside.
class SoftMask {
 public:
  SoftMask(const LabelVolume& volume, const Mask& mask)
      : low_(mask.low.cast<double>()),
        size_(mask.size),
        to_voxel_(volume.to_patient.inverse()),
        values_(mask.inside.begin(), mask.inside.end()) {
    for (int axis = 0; axis < 3; ++axis) Blur(axis, Kernel(Sigma(volume, axis)));
  }

  // Returns the level above which `count` voxels lie.
  double LevelOf(std::size_t count) const {
    constexpr double kLowest = 0.15, kHighest = 0.6;  // other levels do not occur for a solid body
    std::vector<float> sorted = values_;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count), sorted.end(),
                     std::greater<>());
    return std::clamp<double>(sorted[count], kLowest, kHighest);
  }

  // Returns the value at a patient position [mm] by trilinear interpolation; 0 outside the mask's box.
  double At(const Eigen::Vector3d& position) const {
    const Eigen::Array3d at = (to_voxel_ * position - low_).array();
    const Eigen::Array3d floor = at.floor();
    if ((floor < 0).any() || (floor >= size_.array().cast<double>() - 1).any()) return 0;
    const Eigen::Array3d t = at - floor;
    const Eigen::Array3i i = floor.cast<int>();
    const std::size_t row = size_.x(), slice = row * size_.y();
    const float* v = &values_[i.z() * slice + i.y() * row + i.x()];
    const auto along = [&](std::size_t from) { return v[from] + t.x() * (v[from + 1] - v[from]); };
    const double front = along(0) + t.y() * (along(row) - along(0));
    const double back = along(slice) + t.y() * (along(slice + row) - along(slice));
    return front + t.z() * (back - front);
  }

 private:
  // Convolves along one axis.
  void Blur(int axis, const std::vector<float>& kernel) {
    const std::array<std::ptrdiff_t, 3> strides = {1, size_.x(), static_cast<std::ptrdiff_t>(size_.x()) * size_.y()};
    const std::ptrdiff_t stride = strides[axis], reach = static_cast<std::ptrdiff_t>(kernel.size() / 2);
    std::vector<float> line(size_[axis] + 2 * reach, 0);
    for (std::size_t at = 0; at < values_.size(); ++at) {
      if (at / stride % size_[axis] != 0) continue;
      for (int i = 0; i < size_[axis]; ++i) line[reach + i] = values_[at + i * stride];
      for (int i = 0; i < size_[axis]; ++i) {
        float sum = 0;
        for (std::size_t k = 0; k < kernel.size(); ++k) sum += kernel[k] * line[i + k];
        values_[at + i * stride] = sum;
      }
    }
  }

  Eigen::Vector3d low_;
  Eigen::Vector3i size_;
  Eigen::Affine3d to_voxel_;
  std::vector<float> values_;
};

constexpr double kLargestPart = 1500;  // [mm]
constexpr double kMostCells = 3e7;     // of the grid on which a surface is found

anatomy::Box BoxOf(const LabelVolume& volume, const Mask& mask) {
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i at(corner & 1, corner >> 1 & 1, corner >> 2);
    box.extend(volume.to_patient * (mask.low + at.cwiseProduct(mask.size)).cast<double>());
  }
  return {box.min(), box.max()};
}

}  // namespace

int SurfaceMargin(const LabelVolume& volume) {
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, Sigma(volume, axis));
  return static_cast<int>(std::ceil(kReach * longest)) + 2;
}

absl::StatusOr<Mesh> SurfaceOf(const LabelVolume& volume, const Mask& mask, double edge_length) {
  const std::size_t count = mask.Count();
  if (count < kFewest) {
    return absl::FailedPreconditionError(
        absl::StrCat("a label of ", count, " voxels is too small for a surface; at least ", kFewest, " are needed"));
  }
  const anatomy::Box box = BoxOf(volume, mask);
  const Eigen::Vector3d size = box.high - box.low;
  if (size.maxCoeff() > kLargestPart || (size / edge_length).prod() > kMostCells) {
    return absl::FailedPreconditionError(
        absl::StrCat("a label of ", std::lround(size.x()), " x ", std::lround(size.y()), " x ", std::lround(size.z()),
                     " mm is too large for a part of a thorax; check the volume's spacing"));
  }
  const SoftMask soft(volume, mask);
  const double level = soft.LevelOf(count), scale = 2 * kBlur * volume.Spacing().maxCoeff();
  const anatomy::Field field = [&](const Eigen::Vector3d& x) { return scale * (level - soft.At(x)); };
  Mesh mesh = anatomy::ImplicitSurface(field, box, edge_length, edge_length);
  if (mesh.triangles.cols() == 0) {
    return absl::FailedPreconditionError("its voxels enclose no volume at this edge length; lower it");
  }
  mesh.vertices *= kMillimetre;
  return mesh;
}

}  // namespace phrenic::imaging
