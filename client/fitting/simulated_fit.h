// `phrenic fit --parameters`: live parameters of a scene fitted to a person's data, by simulated breaths, in this
// process.
#ifndef PHRENIC_CLIENT_FITTING_SIMULATED_FIT_H_
#define PHRENIC_CLIENT_FITTING_SIMULATED_FIT_H_

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "client/connection/context.h"
#include "server/calibrate/breath_fit.h"
#include "server/fit/motion_fit.h"

namespace phrenic::client {

struct SimulatedFitOptions {
  std::vector<std::string> parameters;  // NAME or NAME:LOW:HIGH; empty: no such fit
  std::string preset = "quiet";         // to begin with
  std::vector<std::string> settings;    // NAME=VALUE
};

struct SimulatedFit {
  v1::Scene scene;    // as it is simulated
  v1::Preset preset;  // "fitted"
  calibrate::BreathFit breath;
};

// Fits the parameters to the recordings, markers and, through a fit of the lungs' motion, to landmarks and surfaces:
// their tidal volume and domes. A breath is as long as the first recording's, unless the settings or parameters say.
// The errors of fit::FitJointly and calibrate::FitBreath; NOT_FOUND for a preset.
absl::StatusOr<SimulatedFit> FitSimulation(const Context& context, const v1::SceneSource& source,
                                           const std::string& name, const fit::Evidence& evidence,
                                           const SimulatedFitOptions& options, const fit::FitOptions& fit,
                                           const std::string& data_dir, calibrate::BreathFitProgress progress);

// Writes the scene with the preset, named after the file, at the preset's parameters. `source` names the data.
absl::Status WriteSimulatedScene(const std::string& file, const SimulatedFit& fit, const std::string& source);

// Returns the preset as text.
std::string TextOf(const SimulatedFit& fit, const std::string& source);

// Prints the numbers, what follows, how well the data are met, and the preset, as the context wants.
void PrintSimulated(const Context& context, const SimulatedFit& fit, const std::string& source);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FITTING_SIMULATED_FIT_H_
