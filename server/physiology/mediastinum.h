// What the lungs gain because what lies between them keeps its volume.
//
// The diaphragm under the heart descends and the sternum before it moves forward: the mediastinum gets longer and
// deeper, and because it is incompressible, narrower. The lungs beside it gain what is swept there. It narrows evenly,
// by the same part of its width everywhere (lung_surroundings.h), as an incompressible body that is stretched does.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_MEDIASTINUM_H_
#define PHRENIC_SERVER_PHYSIOLOGY_MEDIASTINUM_H_

#include <array>
#include <vector>

#include "server/mechanics/lungs/lung_surroundings.h"
#include "server/mesh/mesh.h"

namespace phrenic::physiology {

// Immutable, thread-safe.
class Mediastinum {
 public:
  // The sheet of a diaphragm, its normals towards the thorax, and the inner wall of the cage, at rest; `boundary` has
  // points on the lungs' surfaces, 3 x n [m], and `touches` is true for those on the mediastinum. A triangle of the
  // sheet, or of the wall above its border, belongs to the mediastinum if the nearest of these points touches it.
  Mediastinum(const Mesh& sheet, const Mesh& wall, const Points& boundary, const std::vector<bool>& touches);

  // Returns the volume that these triangles have swept from rest, right and left of x = 0 [m^3].
  std::array<double, 2> Swept(const ConstPoints& sheet, const ConstPoints& wall) const;
  // Returns how it moves: its lower end by the mean descent of the sheet below it, over the area seen from above, its
  // upper end, at the top of the wall, not; `narrowing` as given.
  MediastinalMotion Stretched(const ConstPoints& sheet, double narrowing) const;

 private:
  // Triangles of a surface, by side; `outwards` is 1 if their normals point out of the thorax, else -1.
  struct Faces {
    Points rest;
    std::array<std::vector<Eigen::Vector3i>, 2> of_side;
    double outwards;
  };
  // Returns the mean of z of the triangles of the sheet over their area seen from above at rest [m].
  double HeightOfSheet(const ConstPoints& sheet) const;
  static std::array<double, 2> SweptBy(const Faces& faces, const ConstPoints& now);

  Faces sheet_, wall_;
  double bottom_, top_;  // z of its ends [m]
};

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_MEDIASTINUM_H_
