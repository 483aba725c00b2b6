// The live parameters of a lung's boundary modes: "lung_piston_right" and the others of Parameters, one per mode, or
// one per lung where people's lungs differ.
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_MODE_PARAMETERS_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_MODE_PARAMETERS_H_

#include <array>

#include "phrenic/v1/parameters.pb.h"
#include "server/mechanics/lungs/boundary_modes.h"

namespace phrenic {

inline constexpr int kModeParameters = 12;

struct ModeParameter {
  const char* name;     // of the field
  Amplitude amplitude;  // the mode and the lungs that it moves
  double (v1::Parameters::*get)() const;
  void (v1::Parameters::*set)(double);

  bool Moves(double outwards) const { return outwards > 0 ? amplitude.left : amplitude.right; }
};

// Returns all of them; they live as long as the program. Thread-safe.
const std::array<ModeParameter, kModeParameters>& ModeParameters();

// Returns the amplitudes that are set [m], in the order of ModeParameters().
Eigen::Vector<double, kModeParameters> ModeAmplitudes(const v1::Parameters& parameters);

// Sets the parameters of these numbers [m] and all others of the modes to 0. Requires: as many values as amplitudes.
void SetModeAmplitudes(const std::vector<Amplitude>& amplitudes, const Eigen::VectorXd& values,
                       v1::Parameters& parameters);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_MODE_PARAMETERS_H_
