// How the muscle and the tendon of a diaphragm are stretched between two moments.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_FIBRES_H_
#define PHRENIC_SERVER_PHYSIOLOGY_FIBRES_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::physiology {

// Fibres follow the gradient of the harmonic function from the region "insertion" (else "rim") to "tendon". All
// measures compare the positions `to` with `from`, 3 x the vertices of the mesh [m], and are kNone if the mesh lacks
// the regions. Immutable, thread-safe.
class Fibres {
 public:
  // Keeps a reference to the mesh at rest.
  explicit Fibres(const Mesh& rest);

  // False if the mesh lacks the regions.
  bool found() const { return !muscle_.empty(); }

  // 1 - L/L0, L the length of all fibres, equally many for each width of muscle [1].
  double Shortening(const ConstPoints& from, const ConstPoints& to) const;
  // 1 - L/L0 of the muscle's section with a plane at rest, x_axis = at [1]; L follows the material of the section.
  double SectionShortening(int axis, double at, const ConstPoints& from, const ConstPoints& to) const;
  // The share of the muscle's area, 0 to 1, has a strain across the fibres of at most this size [1].
  double StrainAcross(double share, const ConstPoints& from, const ConstPoints& to) const;
  // |A/A0 - 1| of the tendon [1].
  double TendonAreaChange(const ConstPoints& from, const ConstPoints& to) const;
  // Mean thickness over that before, of muscle that lies against the wall beside the domes at both moments, as
  // ultrasound sees it; tissue is incompressible. `wall_from` and `wall_to` are the vertices of `wall` [m].
  double ThickeningAtWall(const Mesh& wall, const ConstPoints& wall_from, const ConstPoints& wall_to,
                          const ConstPoints& from, const ConstPoints& to) const;

 private:
  // A triangle of muscle. The unit vector along its fibres is first e_1 + second e_2, e its edges from corner 0.
  struct Triangle {
    Eigen::Vector3i corners;
    double first, second;
    double area;  // at rest [m^2]
  };
  void AddMuscle(const Eigen::Vector3i& corners, const Eigen::VectorXd& u);
  static double StretchAlong(const Triangle& t, const ConstPoints& x);

  const Mesh& rest_;
  std::vector<Triangle> muscle_;
  std::vector<Eigen::Vector3i> tendon_;
};

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_FIBRES_H_
