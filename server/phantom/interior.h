// How the inside of a structure moves when its surface moves.
//
// A rigid structure (bone) moves rigidly. A compact one is elastic tissue (mechanics/lungs/lung_tissue.h, linear,
// homogeneous): an organ is held at its surface, and a lung slides along it, as pleura transmits no shear; the moved
// boundary of the tissue is brought onto the moved surface by iteration. In a thin one (diaphragm, vessels, cartilages)
// a point moves with the nearest point of the surface.
#ifndef PHRENIC_SERVER_PHANTOM_INTERIOR_H_
#define PHRENIC_SERVER_PHANTOM_INTERIOR_H_

#include <Eigen/Geometry>
#include <optional>

#include "absl/status/status.h"
#include "server/mechanics/lungs/lung_tissue.h"
#include "server/mesh/mesh.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic::phantom {

// Thread-safe but for MoveTo.
class Interior {
 public:
  // `surface` [m] is closed; where it moves from. `slides`: as a lung does. A compact surface that no elastic tissue
  // can be made in counts as thin: see tissue().
  Interior(Mesh surface, bool slides);

  // Sets where the vertices of the surface are now (3 x n) [m].
  void MoveTo(const Points& vertices);

  // Returns the displacement of a point inside the surface [m].
  Eigen::Vector3d DisplacementAt(const Eigen::Vector3d& point) const;
  // Returns the point that the motion brings to `place` [m].
  Eigen::Vector3d OriginOf(const Eigen::Vector3d& place) const;
  // Returns the volume of tissue at a point relative to that before the motion, det(1 + grad u) [1]. 1 unless the
  // structure is elastic tissue.
  double VolumeRatioAt(const Eigen::Vector3d& point) const;

  // Returns the largest distance between the moved boundary of elastic tissue and the moved surface at the 95 % of the
  // boundary where it is least [m]; 0 for other structures.
  double misfit() const { return misfit_; }
  // Returns why no elastic tissue could be made in a compact surface: the errors of LungTissue::Make; else OK.
  const absl::Status& tissue() const { return made_; }
  bool is_elastic() const { return tissue_.has_value() && !rigid_; }

 private:
  void FollowSurface(const Points& vertices);

  Mesh surface_;
  bool slides_;
  absl::Status made_;  // of tissue_, which sets it
  std::optional<LungTissue> tissue_;
  TriangleTree tree_;
  TriangleTree::Boxes boxes_;               // of the surface before the motion
  std::optional<Eigen::Isometry3d> rigid_;  // the motion, if it is rigid
  Points nodes_;                            // displacement of the tissue's nodes [m]
  Points displacement_;                     // of the surface's vertices [m]
  double misfit_ = 0;
};

}  // namespace phrenic::phantom

#endif  // PHRENIC_SERVER_PHANTOM_INTERIOR_H_
