// Phantoms: synthetic label volumes with known ground truth, voxelised from a scaled or flattened generated thorax.
#ifndef PHRENIC_SERVER_IMAGING_PHANTOM_H_
#define PHRENIC_SERVER_IMAGING_PHANTOM_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/geometry.pb.h"
#include "phrenic/v1/patient.pb.h"
#include "server/anatomy/physique.h"
#include "server/anatomy/physique_inverse.h"
#include "server/imaging/label_volume.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

// The map from the generated thorax to a body.
struct PhantomBody {
  std::string name;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  double flattening = 0;                                           // lowering of the domes before scaling [mm]
  std::shared_ptr<const anatomy::PhysiqueMap> physique = nullptr;  // applied before scaling; null: none
  Eigen::Vector3d shift = Eigen::Vector3d(12, -140, 1050);         // of the origin, arbitrary as in scanners [mm]

  // Map points from the generated thorax' frame to the body's [m], and back. For `soft` structures, flattening lowers
  // points at the domes and the lungs' bases, not at the rim.
  Eigen::Vector3d FromGenerated(const Eigen::Vector3d& generated, bool soft) const;
  // A body with a physique has no flattening; `inverse` is that of its map, if many near points are asked for.
  Eigen::Vector3d ToGenerated(const Eigen::Vector3d& placed, bool soft,
                              anatomy::PhysiqueInverse* inverse = nullptr) const;
};

// Returns "adult", "small", "tall" or "flat". NOT_FOUND lists them.
absl::StatusOr<PhantomBody> FindPhantomBody(std::string_view name);

// Returns the body of a person, with the name "person". Requires: the numbers are within their ranges.
PhantomBody PhantomBodyOf(const v1::Physique& physique);

// Returns a structure of the generated thorax in the body's frame [m]. Errors as anatomy::Generate.
absl::StatusOr<Mesh> PhantomPart(const PhantomBody& body, const v1::Anatomy& part, double resolution_mm);

struct PhantomOptions {
  double voxel = 2;     // [mm]
  double noise = 0.02;  // share of voxels next to another label that take it
  int holes = 40;       // balls of 3 mm radius without a label
  std::uint32_t seed = 1;
};

// Returns a volume with the label numbers of `map` (a lung has the first lobe's label of its side) in the body's frame:
// bones and lungs from the generated surfaces; heart, liver, spleen and stomach from InOrgan. The diaphragm has no
// label, as in real segmentations. Deterministic for a given seed.
absl::StatusOr<LabelVolume> MakePhantom(const PhantomBody& body, const PhantomOptions& options,
                                        const v1::LabelMap& map);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PHANTOM_H_
