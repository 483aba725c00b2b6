// The voxels of a label, cut out of its volume: closed, cleaned, taken apart.
#ifndef PHRENIC_SERVER_IMAGING_MASK_H_
#define PHRENIC_SERVER_IMAGING_MASK_H_

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// The smallest box that holds a label's voxels.
struct Extent {
  Eigen::Vector3i low = Eigen::Vector3i::Constant(1 << 30);
  Eigen::Vector3i high = Eigen::Vector3i::Constant(-1);  // inclusive
  std::size_t voxels = 0;
};

// Of every label that the volume has, but 0.
std::map<Label, Extent> Extents(const LabelVolume& volume);

struct Mask {
  Eigen::Vector3i low = Eigen::Vector3i::Zero();  // where its first voxel lies in the volume; may be outside of it
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  std::vector<std::uint8_t> inside;  // 1 or 0, i fastest

  std::size_t Index(int i, int j, int k) const { return (static_cast<std::size_t>(k) * size.y() + j) * size.x() + i; }
  std::size_t Count() const;
  // The middle of a voxel [mm].
  Eigen::Vector3d Place(const LabelVolume& volume, std::size_t index) const;
};

// The label's voxels with `margin` empty ones around, also where the volume ends: what is cut by its border is closed.
Mask CutOut(const LabelVolume& volume, Label label, const Extent& extent, int margin);

// Closing: dilation by a cube of three, `reach` times, then as many erosions. Holes and cracks of up to twice as many
// voxels go; the mask needs as much room around.
void Close(Mask& mask, int reach);

// Cavities that the outside does not reach become inside.
void FillCavities(Mask& mask);

enum class Joint : std::uint8_t { kFaces = 1, kCorners = 3 };  // kCorners: by faces, edges or corners

// What hangs together, largest first; each in a box of its own with `margin` around.
std::vector<Mask> Pieces(const Mask& mask, int margin, Joint joint = Joint::kCorners);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_MASK_H_
