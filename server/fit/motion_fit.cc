#include "server/fit/motion_fit.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/fit/assimilation.h"

namespace phrenic::fit {
namespace {

constexpr double kRidge = 1e-3;

absl::Status CheckPairs(const Landmarks& landmarks) {
  if (!landmarks.paired()) {
    return absl::InvalidArgumentError(
        "the landmarks have no inhale points: add the columns inhale_x,inhale_y,inhale_z, or give a second file");
  }
  if (landmarks.phase.size() > 0) {
    return absl::InvalidArgumentError(
        "the landmarks are of several phases: phrenic fit takes them, for one person; leave the column phase out here");
  }
  if (!landmarks.motion.allFinite()) return absl::InvalidArgumentError("a coordinate of the landmarks is not finite");
  if (landmarks.size() >= kFewestPairs) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("there are ", landmarks.size(), " landmark pairs; a fit needs ",
                                                 kFewestPairs, ", half of them to judge it"));
}

// Sets the parameters and what belongs to them, from the fitting half.
Eigen::VectorXd FitAmplitudes(const Person& person, const Landmarks& fitting, const FitOptions& options,
                              MotionFit& fit) {
  fit.person.responses = person.Responses(fitting.exhale);
  fit.person.motion = fitting.motion.reshaped();
  fit.person.descent = fit.descent = DescentOf(person.PlacesAt(fitting.exhale), fitting.motion);
  Estimate estimate =
      BootstrapLeastSquares(fit.person.responses, fit.person.motion, kRidge, fitting.exhale, options.split);
  fit.person.amplitudes = estimate.value;
  fit.correlation = std::move(estimate.correlation);
  fit.volume = person.VolumeResponses().dot(estimate.value);
  if (fit.volume < 0) {
    fit.registered.doubts.push_back(
        absl::StrFormat("the lungs lose %.2f l from exhale to inhale: are the points of exhale and inhale exchanged?",
                        -1e3 * fit.volume));
  }
  const PeopleMotion& people = ShippedPeople(options.numbers);
  for (size_t k = 0; k < person.amplitudes().size(); ++k) {
    const Amplitude& amplitude = person.amplitudes()[k];
    const auto at = static_cast<Eigen::Index>(k);
    const double error = estimate.standard_error[at], spread = people.spread[at] * std::abs(fit.descent);
    fit.parameters.push_back({amplitude.Name(), BoundaryModes()[static_cast<size_t>(amplitude.mode)].what,
                              estimate.value[at], error, spread, error < spread / 2});
  }
  return estimate.value;
}

void Judge(const Person& person, MotionFit& fit) {
  const Points difference = fit.motion - fit.predicted;
  fit.fitting = Summarise(difference, fit.halves.fitting);
  fit.held_out = Summarise(difference, fit.halves.held_out);
  fit.baselines = FitBaselines(fit.exhale, fit.motion, fit.halves);
  fit.regions = ErrorsByRegion(person.PlacesAt(fit.exhale), person.LeftOnes(fit.exhale), fit.motion, difference,
                               fit.halves.held_out);
}

// Adds the smallest elastic deformation through the fitting half to the prediction.
absl::Status AddDeformation(const LungTemplates& templates, MotionFit& fit) {
  const Points residual = fit.motion - fit.predicted;
  const auto deformation = Assimilate(templates, fit.registered, fit.exhale(Eigen::all, fit.halves.fitting),
                                      residual(Eigen::all, fit.halves.fitting), fit.exhale);
  if (!deformation.ok()) return deformation.status();
  fit.predicted += *deformation;
  fit.assimilated = Summarise(fit.motion - fit.predicted, fit.halves.held_out);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<MotionFit> FitMotion(const LungTemplates& templates, const Landmarks& landmarks,
                                    const FitOptions& options, const FitProgress& progress) {
  if (absl::Status status = CheckPairs(landmarks); !status.ok()) return status;
  const auto cancelled = [&](double done, std::string_view stage) { return progress && !progress(done, stage); };
  MotionFit fit;
  fit.halves = SplitInHalves(static_cast<int>(landmarks.size()), options.split);
  const Landmarks fitting = Select(landmarks, fit.halves.fitting);
  if (cancelled(0, "registering")) return absl::CancelledError("interrupted");
  const absl::StatusOr<RegisteredLungs> registered = RegisterLungs(templates, fitting.exhale);
  if (!registered.ok()) return registered.status();
  fit.registered = *registered;
  const std::function<bool()> stop = [&] { return cancelled(0.3, "solving"); };
  const auto person = Person::Make(templates, *registered, BreathAmplitudes(options.numbers), options.elasticity, stop);
  if (!person.ok()) return person.status();
  if (cancelled(0.8, "fitting")) return absl::CancelledError("interrupted");
  const Eigen::VectorXd amplitudes = FitAmplitudes(*person, fitting, options, fit);
  fit.exhale = landmarks.exhale;
  fit.motion = landmarks.motion;
  fit.predicted = (person->Responses(fit.exhale) * amplitudes).reshaped(3, fit.exhale.cols());
  fit.held_out_responses = person->Responses(fit.exhale(Eigen::all, fit.halves.held_out));
  Judge(*person, fit);
  if (!options.assimilate) return fit;
  if (cancelled(0.9, "assimilating")) return absl::CancelledError("interrupted");
  if (absl::Status status = AddDeformation(templates, fit); !status.ok()) return status;
  return fit;
}

}  // namespace phrenic::fit
