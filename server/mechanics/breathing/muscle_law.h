// The law of muscle, tendon and passive tissue as thin sheets: tension per width at rest [N/m] as a function of
// stretch.
//   muscle along:   T = S fl(l) + T0 min(1, q)^2 + P o (1 + g o),  S = active_stress h activation force-velocity,
//                   fl = max(0, 1 - ((l/optimal - 1)/width)^2),  q = max(0, (l - slack)/(1 - slack)),
//                   o = l - 1 clamped to [0, 1];
//   everything else: T = T0 + k (l - 1), times `compressed` where negative (tension field: Reissner 1938).
// T0 is the resting tension of a triangle. The force-length law keeps muscle from folding: canine diaphragm contracts
// to 0.4 of its optimal length and peaks above resting length. Force-velocity (Hill 1938): f = (1 - u)/(1 + 4 u) while
// fibres shorten at u of their largest rate, 1 + (f_max - 1) (-u)/(0.13 - u) while they lengthen.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_LAW_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_LAW_H_

#include "phrenic/v1/forces.pb.h"

namespace phrenic {

// Added to the square of every stretch, so that one of 0 has an inverse.
inline constexpr double kLeastSquaredStretch = 1e-8;

enum class Tissue { kMuscle, kTendon, kPassive };

// Tension that is linear in the stretch.
struct LinearTension {
  double stiffness = 0;   // k [N/m]
  double compressed = 1;  // share of a negative tension that is left [-]
};

struct MuscleLaw {
  double active = 0;                           // S at activation 1 and rest [N/m]
  double optimal = 1, width = 1;               // of force-length [-]
  double slack = 0;                            // [-]
  double passive = 0, growth = 0;              // P [N/m], g [-]
  LinearTension across, tendon;                // across muscle and in passive tissue; in tendon
  double shear = 0, tendon_shear = 0;          // [N/m]
  double viscosity = 0, tendon_viscosity = 0;  // [N s/m]

  LinearTension LinearOf(Tissue tissue) const { return tissue == Tissue::kTendon ? tendon : across; }
  double ShearOf(Tissue tissue) const { return tissue == Tissue::kTendon ? tendon_shear : shear; }
  double ViscosityOf(Tissue tissue) const { return tissue == Tissue::kTendon ? tendon_viscosity : viscosity; }
  // Returns the law with all stiffnesses times `elasticity`; resting and active tensions are the same.
  MuscleLaw Scaled(double elasticity) const;
};
MuscleLaw MakeMuscleLaw(const v1::Muscle& scene);

// The tension of one direction at a stretch, its derivative and its integral.
struct TensionAt {
  double tension, slope, energy;  // [N/m], [N/m], [J/m^2]; the energy has any zero
};
TensionAt LinearAt(const LinearTension& law, double resting, double stretch);
// `active` is S [N/m].
TensionAt MuscleAt(const MuscleLaw& law, double resting, double active, double stretch);

// Force-velocity: the force over that at rest, of fibres whose stretch changes at `rate` [1/s], negative while they
// shorten.
struct HillLaw {
  double shortening_rate = 0;  // the rate without load [1/s]; 0: no dependence
  double lengthening = 1;      // f_max [-]

  bool active() const { return shortening_rate > 0; }
  double At(double rate) const;
};
HillLaw MakeHillLaw(const v1::Muscle& scene);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_LAW_H_
