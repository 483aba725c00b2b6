// The outputs of one run of a scene: statistics of its measures, and measures of a breath.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_OUTPUTS_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_OUTPUTS_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phrenic/v1/uncertainty.pb.h"
#include "server/calibrate/target.h"
#include "server/study/context.h"

namespace phrenic::study {

// A number of a run: of a measure of the scene, or of a breath.
struct Output {
  std::string name;  // "lung volume, amplitude"; "tidal-volume"
  std::string unit;
  int measure = -1;  // of the model; -1: of the breath
  v1::Statistic statistic = v1::STATISTIC_UNSPECIFIED;
  const calibrate::Target* of_breath = nullptr;
};

// What a run gave.
struct RunOutputs {
  std::vector<double> values;  // one per output, in its unit; NaN if the run failed or has no such value
  std::vector<std::vector<double>>
      curves;           // one per measure of the model [its unit]: at each of kPhases; empty if it failed
  std::string problem;  // why the run failed; empty if it did not
};
inline constexpr int kPhases = 41;  // equidistant moments of the measured time, both ends included

// Runs a scene and reads its outputs. Refers to the model. Immutable, thread-safe.
class Outputs {
 public:
  // Without `seconds`, a run is a breath of the parameters: of a scene with a diaphragm as physiology::Record settles
  // it, of another from rest. With `seconds` [s], it is that time from rest. Empty outputs: the scene's breath
  // measures; without any, the amplitudes of its measures. `automatic_step`: the step of each run is shortened to the
  // stability limit of its parameters. INVALID_ARGUMENT with "outputs[0].measure" and the known names for an unknown
  // one, for a statistic that is missing or does not belong there; FAILED_PRECONDITION if the scene has nothing to
  // measure.
  static absl::StatusOr<std::unique_ptr<const Outputs>> Make(
      const Model& model, const google::protobuf::RepeatedPtrField<v1::StudiedOutput>& wanted,
      std::optional<double> seconds, bool automatic_step);

  const std::vector<Output>& outputs() const { return outputs_; }
  const Model& model() const { return model_; }
  // Returns how many numbers a run gives: its outputs, and its curves.
  size_t NumbersPerRun() const { return outputs_.size() + kPhases * model_.measures.size(); }

  // Requires: every field of `parameters` is set. CANCELLED if `cancelled`, called every few steps, returns true. A run
  // that diverges has a problem. Uses one thread.
  absl::StatusOr<RunOutputs> Run(const v1::Parameters& parameters, const std::function<bool()>& cancelled) const;

 private:
  Outputs(const Model& model, std::optional<double> seconds, bool automatic_step)
      : model_(model), seconds_(seconds), automatic_step_(automatic_step) {}
  absl::Status AddWanted(const v1::StudiedOutput& wanted, const std::string& path);
  absl::Status AddDefaults();
  absl::StatusOr<RunOutputs> Breathe(const v1::Parameters& parameters, const std::function<bool()>& cancelled) const;
  absl::StatusOr<RunOutputs> RunFromRest(const v1::Parameters& parameters, double seconds,
                                         const std::function<bool()>& cancelled) const;

  const Model& model_;
  const std::optional<double> seconds_;
  const bool automatic_step_;
  std::unique_ptr<const physiology::Subject> breathing_;  // null: no breath is measured
  std::vector<Output> outputs_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_OUTPUTS_H_
