// Label volumes of bodies whose truth is known: the generated thorax, made small or tall or flat, voxel by voxel.
#ifndef PHRENIC_SERVER_IMAGING_PHANTOM_H_
#define PHRENIC_SERVER_IMAGING_PHANTOM_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/label_volume.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

// How a body differs from the generated thorax.
struct PhantomBody {
  std::string name;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  double flattening = 0;                                    // how much lower the domes stand, before scaling [mm]
  Eigen::Vector3d shift = Eigen::Vector3d(12, -140, 1050);  // of the origin, as scanners give it: off the middle [mm]

  // From the generated thorax' frame to the body's [m]. Flattening lowers what lies at the domes and the lungs' bases,
  // and nothing at the rim.
  Eigen::Vector3d Place(const Eigen::Vector3d& generated, bool soft) const;
  Eigen::Vector3d Generated(const Eigen::Vector3d& placed, bool soft) const;  // and back
};

// "adult", "small", "tall" or "flat"; NOT_FOUND names them.
absl::StatusOr<PhantomBody> FindPhantomBody(std::string_view name);

// A part of the generated thorax in the body's frame [m]; soft: diaphragm and lungs.
absl::StatusOr<Mesh> PhantomPart(const PhantomBody& body, const v1::Anatomy& part, double resolution_mm);

struct PhantomOptions {
  double voxel = 2;     // [mm]
  double noise = 0.02;  // the share of voxels next to another label that take its number
  int holes = 40;       // balls without a label
  std::uint32_t seed = 1;
};

// Labels as `map` numbers them (lobes of a lung: the first of its side), in the body's frame: bones and lungs from the
// generated surfaces, heart, liver, spleen and stomach from laws of their own on either side of the generated
// diaphragm. The diaphragm itself has no label, as nobody segments it.
absl::StatusOr<LabelVolume> MakePhantom(const PhantomBody& body, const PhantomOptions& options,
                                        const v1::LabelMap& map);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PHANTOM_H_
