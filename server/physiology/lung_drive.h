// The motion of a model's lungs by its causes: their surroundings, the space that opens for each of them, their weight.
//
// A lung fills its side of the thorax, also where it cannot follow what touched it at rest: at its margin, which slides
// into the recess that the diaphragm opens. So the tissue follows its surroundings under a pressure p on its whole
// free surface, one for each side, at which the lungs of the side gain the space s that opens for them,
//   integral n . u dS = s,  u = u_surroundings + p u_pressure.
// p is the fall of the pleural pressure over Young's modulus [1], less what the springs of the contact bear.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_LUNG_DRIVE_H_
#define PHRENIC_SERVER_PHYSIOLOGY_LUNG_DRIVE_H_

#include <array>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/lungs/lung_surroundings.h"
#include "server/mechanics/lungs/lung_weight.h"
#include "server/physiology/mediastinum.h"
#include "server/physiology/parts.h"

namespace phrenic::physiology {

// The causes that act on the lungs beside what touches them. Comparisons switch one of them off.
struct LungCauses {
  bool weight = true;  // the tissue has a weight
  bool space = true;   // the lungs fill the space that opens for them
  bool root = true;    // the root binds them to the mediastinum
  bool margin = true;  // their margin is free to slide into the recess
};

// Returns the elasticity of lungs that a breath drives. Poisson's ratio is 0.42: small changes about an inflation at
// the pressure P have a bulk modulus of about 4 P and a shear modulus of 0.7 P (Lai-Fook, Wilson, Hyatt and Rodarte, J
// Appl Physiol 1976;40:508). The contact is a penalty: four times as stiff as that of fits to people's landmarks, which
// tell neither number, so that the tissue is where its surroundings are.
LungElasticity DrivenLungs();

// Makes the tissue of each lung of `parts`, of one side with one root. As LungTissue::Make.
absl::StatusOr<std::vector<LungTissue>> MakeLungs(const Model& model, const Parts& parts,
                                                  const LungElasticity& elasticity, LungCauses causes = {},
                                                  const StopCheck& stop = {});

// Refers to the model. Immutable, thread-safe.
class LungDrive {
 public:
  // What a state does, relative to rest.
  struct Moment {
    std::vector<Points> displacement;  // of what touches each lung, 3 x boundary points [m]; NaN where it is free
    std::array<double, 2> space = {};  // that opens on the right and left [m^3]; kNone if the model does not say it
  };

  // `tissues` are the lungs of `parts`, in that order. Requires: parts has a muscle and a wall.
  LungDrive(const Model& model, const Parts& parts, const std::vector<LungTissue>& tissues, LungCauses causes = {});

  // A lung follows by 1 - the pneumothorax of its side: air between them transmits nothing.
  Moment At(const State& state, const v1::Parameters& parameters) const;
  // The weight of the lungs in a posture; none if the model has no recoil curve.
  LungWeight WeightIn(v1::Posture posture) const;
  const LungSurroundings& surroundings(size_t lung) const { return surroundings_[lung]; }
  size_t side(size_t lung) const { return sides_[lung]; }  // 0 right, 1 left

 private:
  std::array<double, 2> SpacesAt(const State& state, const v1::Parameters& parameters) const;

  const Model& model_;
  Parts parts_;
  LungCauses causes_;
  std::vector<LungSurroundings> surroundings_;
  std::vector<size_t> sides_;
  std::array<double, 2> beside_ = {};  // LungSurroundings::BesideMediastinum of each side [m^3]
  std::optional<Mediastinum> mediastinum_;
  std::optional<v1::ThoraxPressures> pressures_;
  double volume_ = 0;                                 // of all lungs at rest [m^3]
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();  // [m]
};

// Returns how far the lung of a side follows its surroundings, 0..1: not at all where air of a pneumothorax is between.
double FollowsSurroundings(v1::Side side, const v1::Parameters& parameters);

// Returns the pressure p of each side, by the space [m^3] and what the lungs gain by their surroundings and by p = 1.
// 0 where the space is not known, or no pressure changes the lungs.
std::array<double, 2> FillingPressures(const std::array<double, 2>& space, const std::array<double, 2>& followed,
                                       const std::array<double, 2>& pressed);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_LUNG_DRIVE_H_
