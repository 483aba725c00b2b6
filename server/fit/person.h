// A person's lungs: the generated ones moved onto exhale points, with the response of their tissue to boundary modes.
#ifndef PHRENIC_SERVER_FIT_PERSON_H_
#define PHRENIC_SERVER_FIT_PERSON_H_

#include <array>
#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fit/registration.h"
#include "server/fit/sides.h"
#include "server/mechanics/lungs/boundary_modes.h"
#include "server/mechanics/lungs/lung_tissue.h"

namespace phrenic::fit {

// The generated lungs, by Side.
using LungTemplates = std::array<LungTemplate, 2>;

struct RegisteredLungs {
  double gap = 0;  // x [m]
  std::array<Registration, 2> lungs;
  std::array<int, 2> points = {};   // that each was registered to
  std::vector<std::string> doubts;  // of LungSides
};

// The errors of FindSides and Register.
absl::StatusOr<RegisteredLungs> RegisterLungs(const LungTemplates& templates, const Points& exhale);

// Immutable, thread-safe.
class Person {
 public:
  // Factorises both lungs and solves each boundary mode of the amplitudes once: 1 s. The status of LungTissue::Make;
  // CANCELLED if `stop` returns true between two solves.
  static absl::StatusOr<Person> Make(const LungTemplates& templates, const RegisteredLungs& registered,
                                     const std::vector<Amplitude>& amplitudes, const LungElasticity& elasticity,
                                     const std::function<bool()>& stop = {});

  const RegisteredLungs& registered() const { return registered_; }
  const std::vector<Amplitude>& amplitudes() const { return amplitudes_; }
  const LungTissue& tissue(Side side) const { return tissues_[side]; }
  Side SideOf(const Eigen::Vector3d& point) const { return point.x() > registered_.gap ? kLeft : kRight; }
  // Returns each point's place over its lung's box: xi, eta in -1..1 (lateral, posterior) and zeta in 0..1.
  Points PlacesAt(const Points& points) const;
  // True for the points of the left lung.
  std::vector<bool> LeftOnes(const Points& points) const;

  // Returns the displacement of the points per amplitude: row 3 i + axis for point i, one column per amplitude [1].
  Eigen::MatrixXd Responses(const Points& points) const;
  // Returns the lungs' change of volume per amplitude [m^2], of both sides: the surface integral of n . u.
  Eigen::VectorXd VolumeResponses() const;
  // Returns the displacement of the nodes of a lung's grid for these amplitudes [m].
  Points NodesAt(Side side, const Eigen::VectorXd& amplitudes) const;

 private:
  Person(RegisteredLungs registered, std::vector<Amplitude> amplitudes, std::vector<LungTissue> tissues)
      : registered_(std::move(registered)), amplitudes_(std::move(amplitudes)), tissues_(std::move(tissues)) {}
  bool Moves(size_t amplitude, Side side) const {
    return side == kLeft ? amplitudes_[amplitude].left : amplitudes_[amplitude].right;
  }

  RegisteredLungs registered_;
  std::vector<Amplitude> amplitudes_;
  std::vector<LungTissue> tissues_;            // by Side
  std::array<std::vector<Points>, 2> fields_;  // by Side and amplitude: of the nodes; empty if it does not move
};

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_PERSON_H_
