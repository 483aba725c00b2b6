#include "server/mechanics/lungs/mode_parameters.h"

namespace phrenic {
namespace {

using Fields = v1::Parameters;

#define PHRENIC_MODE(name, mode, right, left) \
  ModeParameter { #name, {mode, right, left }, &Fields::name, &Fields::set_##name }

}  // namespace

const std::array<ModeParameter, kModeParameters>& ModeParameters() {
  static const std::array<ModeParameter, kModeParameters> parameters = {
      PHRENIC_MODE(lung_piston_right, kPiston, true, false),
      PHRENIC_MODE(lung_piston_left, kPiston, false, true),
      PHRENIC_MODE(lung_tilt_front_back_right, kTiltFrontBack, true, false),
      PHRENIC_MODE(lung_tilt_front_back_left, kTiltFrontBack, false, true),
      PHRENIC_MODE(lung_tilt_left_right, kTiltLeftRight, true, true),
      PHRENIC_MODE(lung_dome, kDome, true, true),
      PHRENIC_MODE(lung_pump, kPump, true, true),
      PHRENIC_MODE(lung_low_pump, kLowPump, true, true),
      PHRENIC_MODE(lung_back, kBack, true, true),
      PHRENIC_MODE(lung_apex, kApex, true, true),
      PHRENIC_MODE(lung_mediastinum, kMediastinum, true, true),
      PHRENIC_MODE(lung_mediastinum_tilt, kMediastinumTilt, true, true),
  };
  return parameters;
}

#undef PHRENIC_MODE

Eigen::Vector<double, kModeParameters> ModeAmplitudes(const v1::Parameters& parameters) {
  Eigen::Vector<double, kModeParameters> amplitudes;
  for (Eigen::Index m = 0; m < kModeParameters; ++m) {
    amplitudes[m] = (parameters.*ModeParameters()[static_cast<size_t>(m)].get)();
  }
  return amplitudes;
}

void SetModeAmplitudes(const std::vector<Amplitude>& amplitudes, const Eigen::VectorXd& values,
                       v1::Parameters& parameters) {
  for (const ModeParameter& parameter : ModeParameters()) {
    double sum = 0;
    for (size_t a = 0; a < amplitudes.size(); ++a) {
      const Amplitude& number = amplitudes[a];
      const bool both = number.right == number.left;
      const bool same_lungs = both || number.right == parameter.amplitude.right;
      if (number.mode == parameter.amplitude.mode && same_lungs) sum += values[static_cast<Eigen::Index>(a)];
    }
    (parameters.*parameter.set)(sum);
  }
}

}  // namespace phrenic
