#include "server/imaging/mask.h"

#include <algorithm>
#include <array>

namespace phrenic::imaging {
namespace {

// Replaces every voxel by the maximum (or minimum) of itself and its two neighbours along one axis.
template <typename Choose>
void Filter(Mask& mask, int axis, const Choose& choose) {
  const std::array<std::size_t, 3> strides = {1, static_cast<std::size_t>(mask.size.x()),
                                              static_cast<std::size_t>(mask.size.x()) * mask.size.y()};
  const std::size_t stride = strides[axis];
  const std::vector<std::uint8_t> before = mask.inside;
  for (std::size_t at = 0; at < before.size(); ++at) {
    const auto coordinate = static_cast<int>(at / stride % mask.size[axis]);
    if (coordinate > 0) mask.inside[at] = choose(mask.inside[at], before[at - stride]);
    if (coordinate + 1 < mask.size[axis]) mask.inside[at] = choose(mask.inside[at], before[at + stride]);
  }
}

// Flood fill from `seed` over voxels whose `inside` is `value`. Neighbours differ by at most `reach` in the 1-norm: 1
// gives 6-connectivity, 3 gives 26-connectivity.
std::vector<std::size_t> Flood(const Mask& mask, std::size_t seed, std::uint8_t value, int reach,
                               std::vector<bool>& seen) {
  std::vector<std::size_t> found = {seed};
  seen[seed] = true;
  const int nx = mask.size.x(), ny = mask.size.y(), nz = mask.size.z();
  for (std::size_t next = 0; next < found.size(); ++next) {
    const std::size_t at = found[next];
    const int i = static_cast<int>(at % nx), j = static_cast<int>(at / nx % ny), k = static_cast<int>(at / nx / ny);
    for (int step = 0; step < 27; ++step) {
      const int di = step % 3 - 1, dj = step / 3 % 3 - 1, dk = step / 9 - 1;
      const int x = i + di, y = j + dj, z = k + dk;
      if (std::abs(di) + std::abs(dj) + std::abs(dk) > reach) continue;
      if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) continue;
      const std::size_t to = mask.Index(x, y, z);
      if (seen[to] || mask.inside[to] != value) continue;
      seen[to] = true;
      found.push_back(to);
    }
  }
  return found;
}

Eigen::Vector3i VoxelOf(const Mask& mask, std::size_t index) {
  const std::size_t nx = mask.size.x(), ny = mask.size.y();
  return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny), static_cast<int>(index / nx / ny)};
}

// Returns a mask of only these voxels, in their bounding box plus `margin`.
Mask Cropped(const Mask& mask, const std::vector<std::size_t>& voxels, int margin) {
  Extent extent;
  for (const std::size_t at : voxels) {
    extent.low = extent.low.cwiseMin(VoxelOf(mask, at));
    extent.high = extent.high.cwiseMax(VoxelOf(mask, at));
  }
  Mask piece;
  const Eigen::Vector3i start = extent.low.array() - margin;
  piece.low = mask.low + start;
  piece.size = (extent.high - extent.low).array() + 1 + 2 * margin;
  piece.inside.assign(static_cast<std::size_t>(piece.size.x()) * piece.size.y() * piece.size.z(), 0);
  for (const std::size_t at : voxels) {
    const Eigen::Vector3i to = VoxelOf(mask, at) - start;
    piece.inside[piece.Index(to.x(), to.y(), to.z())] = 1;
  }
  return piece;
}

}  // namespace

std::map<Label, Extent> Extents(const LabelVolume& volume) {
  std::vector<Extent> all(std::size_t{1} << 16);
  std::size_t at = 0;
  for (int k = 0; k < volume.size.z(); ++k) {
    for (int j = 0; j < volume.size.y(); ++j) {
      for (int i = 0; i < volume.size.x(); ++i, ++at) {
        if (volume.labels[at] == 0) continue;
        Extent& extent = all[volume.labels[at]];
        extent.low = extent.low.cwiseMin(Eigen::Vector3i(i, j, k));
        extent.high = extent.high.cwiseMax(Eigen::Vector3i(i, j, k));
        ++extent.voxels;
      }
    }
  }
  std::map<Label, Extent> found;
  for (std::size_t label = 1; label < all.size(); ++label) {
    if (all[label].voxels > 0) found[static_cast<Label>(label)] = all[label];
  }
  return found;
}

std::size_t Mask::Count() const { return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 1)); }

Eigen::Vector3d Mask::Position(const LabelVolume& volume, std::size_t index) const {
  return volume.to_patient * (low + VoxelOf(*this, index)).cast<double>();
}

Mask ExtractMask(const LabelVolume& volume, Label label, const Extent& extent, int margin) {
  Mask mask;
  mask.low = extent.low.array() - margin;
  mask.size = (extent.high - extent.low).array() + 1 + 2 * margin;
  mask.inside.assign(static_cast<std::size_t>(mask.size.x()) * mask.size.y() * mask.size.z(), 0);
  for (int k = extent.low.z(); k <= extent.high.z(); ++k) {
    for (int j = extent.low.y(); j <= extent.high.y(); ++j) {
      for (int i = extent.low.x(); i <= extent.high.x(); ++i) {
        if (volume.labels[volume.Index({i, j, k})] != label) continue;
        mask.inside[mask.Index(i - mask.low.x(), j - mask.low.y(), k - mask.low.z())] = 1;
      }
    }
  }
  return mask;
}

void Close(Mask& mask, int reach) {
  for (int step = 0; step < 3 * reach; ++step) Filter(mask, step % 3, [](auto a, auto b) { return std::max(a, b); });
  for (int step = 0; step < 3 * reach; ++step) Filter(mask, step % 3, [](auto a, auto b) { return std::min(a, b); });
}

void FillCavities(Mask& mask) {
  std::vector<bool> outside(mask.inside.size(), false);
  Flood(mask, 0, 0, 1, outside);  // the margin is connected
  for (std::size_t at = 0; at < mask.inside.size(); ++at) mask.inside[at] = outside[at] ? 0 : 1;
}

std::vector<Mask> ConnectedComponents(const Mask& mask, int margin, Connectivity connectivity) {
  std::vector<std::vector<std::size_t>> found;
  std::vector<bool> seen(mask.inside.size(), false);
  for (std::size_t at = 0; at < mask.inside.size(); ++at) {
    if (mask.inside[at] == 1 && !seen[at]) found.push_back(Flood(mask, at, 1, static_cast<int>(connectivity), seen));
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  constexpr std::size_t kMaxPieces = 64;  // the rest are fragments
  found.resize(std::min(found.size(), kMaxPieces));
  std::vector<Mask> pieces;
  pieces.reserve(found.size());
  for (const std::vector<std::size_t>& voxels : found) pieces.push_back(Cropped(mask, voxels, margin));
  return pieces;
}

}  // namespace phrenic::imaging
