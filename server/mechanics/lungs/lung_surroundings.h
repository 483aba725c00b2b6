// What touches a lung, and how it moves: the diaphragm below, the inner wall of the cage around and above, the
// mediastinum inside. Each boundary point of the tissue that faces one of them closely at rest follows it along the
// normal, and at the root (lung_root.h) in every direction. The others are free: the margin at the mouth of the
// costophrenic recess, also where it faces the diaphragm, because the sheet that peels off the wall there is another
// part of it at each moment.
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_SURROUNDINGS_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_SURROUNDINGS_H_

#include <array>
#include <vector>

#include "server/mechanics/lungs/lung_tissue.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Motion of the mediastinum relative to rest: it is stretched evenly between its ends.
struct MediastinalMotion {
  double narrowing = 0;        // towards the midline, of its width [1]
  double descent = 0;          // of its lower end [m]; the upper one stays
  double bottom = 0, top = 1;  // z of its ends at rest [m]
};

enum class LungNeighbour { kDiaphragm, kWall, kMediastinum, kNone };

// Immutable, thread-safe. Refers to the model.
class LungSurroundings {
 public:
  // `sheet` and `wall` are indices of bodies; the lung is that of the tissue, at rest. The margin is bound to the sheet
  // that it touches at rest if `is_margin_free` is false.
  LungSurroundings(const Model& model, int sheet, int wall, const LungTissue& tissue, bool is_margin_free = true);

  // Returns how far what touches each boundary point is from where it is at rest (3 x points) [m]; NaN for free points.
  // A point follows the material that is nearest to it at rest. The mediastinum is shifted sideways by the coordinate
  // "mediastinal shift" over its area.
  Points Displacement(const State& state, const MediastinalMotion& mediastinum = {}) const;
  // The same for placed bodies: the vertices of the sheet and of the wall [m] in the state.
  Points Displacement(const State& state, const Points& sheet, const Points& wall,
                      const MediastinalMotion& mediastinum = {}) const;
  // The volume that the lung gains per narrowing of the mediastinum [m^3].
  double BesideMediastinum() const { return beside_mediastinum_; }

  const std::vector<LungNeighbour>& neighbours() const { return neighbours_; }  // of each boundary point
  // The part of the surface that touches a neighbour, 0..1.
  double Share(LungNeighbour neighbour) const;

 private:
  struct Contact {
    Eigen::Index point;       // of the boundary
    Eigen::Vector3i corners;  // of the triangle of the neighbour
    Eigen::Vector3d weights;
  };
  void Bind(const LungTissue& tissue, const Mesh& sheet, const Mesh& wall, bool is_margin_free);
  Eigen::Vector3d MoveMediastinum(Eigen::Index point, double sideways, const MediastinalMotion& motion) const;
  double MediastinalShift(const State& state) const;

  const Model& model_;
  std::array<int, 2> bodies_;  // by LungNeighbour
  std::vector<LungNeighbour> neighbours_;
  std::array<std::vector<Contact>, 2> contacts_;
  Eigen::VectorXd areas_;        // [m^2]
  Points points_;                // the boundary points [m]
  double mediastinal_area_ = 0;  // projected along x [m^2]
  double beside_mediastinum_ = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_SURROUNDINGS_H_
