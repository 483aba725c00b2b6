// Binary masks of labels: extraction from the volume, morphological closing, hole filling, connected components.
#ifndef PHRENIC_SERVER_IMAGING_MASK_H_
#define PHRENIC_SERVER_IMAGING_MASK_H_

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// A label's bounding box, in voxel indices.
struct Extent {
  Eigen::Vector3i low = Eigen::Vector3i::Constant(1 << 30);
  Eigen::Vector3i high = Eigen::Vector3i::Constant(-1);  // inclusive
  std::size_t voxels = 0;
};

// Returns the extent of every label in the volume except 0.
std::map<Label, Extent> Extents(const LabelVolume& volume);

struct Mask {
  Eigen::Vector3i low = Eigen::Vector3i::Zero();  // volume index of its first voxel; may be outside the volume
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  std::vector<std::uint8_t> inside;  // 1 or 0, i varies fastest

  std::size_t Index(int i, int j, int k) const { return (static_cast<std::size_t>(k) * size.y() + j) * size.x() + i; }
  std::size_t Count() const;
  // Returns the patient position of a voxel's centre [mm].
  Eigen::Vector3d Position(const LabelVolume& volume, std::size_t index) const;
};

// Returns the label's voxels with a margin of empty ones, also at the volume's border, so that surfaces are closed
// there.
Mask ExtractMask(const LabelVolume& volume, Label label, const Extent& extent, int margin);

// Morphological closing: `reach` dilations by a 3 x 3 x 3 cube, then as many erosions. Closes holes and gaps up to 2
// `reach` voxels wide. Requires: a margin of at least `reach`.
void Close(Mask& mask, int reach);

// Fills cavities that are not connected to the outside. Requires: a margin of at least 1.
void FillCavities(Mask& mask);

enum class Connectivity : std::uint8_t { kFaces = 1, kCorners = 3 };  // 6- and 26-connectivity

// Returns the connected components, largest first, at most 64; each in its own bounding box plus `margin`.
std::vector<Mask> ConnectedComponents(const Mask& mask, int margin, Connectivity connectivity = Connectivity::kCorners);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_MASK_H_
