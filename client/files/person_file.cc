#include "client/files/person_file.h"

#include <filesystem>

#include "absl/strings/str_cat.h"
#include "client/files/scene_text.h"
#include "client/files/whole_file.h"
#include "server/fit/person_scene.h"
#include "server/schema/schema.h"

namespace phrenic::client {
namespace {

std::string SceneNameOf(const std::string& file) { return std::filesystem::path(file).stem().string(); }

// Writes a scene that Phrenic takes. FAILED_PRECONDITION if it would refuse it.
absl::Status WriteScene(const std::string& file, const v1::Scene& scene, const std::string& comment) {
  if (absl::Status status = schema::Validate(scene); !status.ok()) {
    return absl::FailedPreconditionError(absl::StrCat("this motion is beyond that of a breath, so that ", file,
                                                      " is not written: ", std::string(status.message())));
  }
  return WriteWhole(file, SceneText(scene, comment));
}

}  // namespace

absl::Status WriteFittedScene(const std::string& file, const fit::SceneLungs& lungs, const fit::MotionFit& fit,
                              const fit::FitOptions& options, const std::string& source, bool landmarks) {
  const v1::Scene scene = fit::FittedScene(SceneNameOf(file), source, lungs, fit, options.numbers, landmarks);
  const std::string command = absl::StrCat("Written by phrenic fit --modes ", options.numbers, " --split ",
                                           options.split, " from landmark pairs: ", source, ".");
  return WriteScene(file, scene, command);
}

absl::Status WriteJointScene(const std::string& file, const fit::SceneLungs& lungs, const fit::JointFit& fit,
                             const fit::FitOptions& options, const std::string& source, bool landmarks) {
  const v1::Scene scene = fit::JointScene(SceneNameOf(file), source, lungs, fit, options.numbers, landmarks);
  return WriteScene(file, scene,
                    absl::StrCat("Written by phrenic fit --modes ", options.numbers, " from ", source, "."));
}

absl::Status WriteExpectedScene(const std::string& file, const fit::SceneLungs& lungs, const fit::Person& person,
                                const fit::Prediction& prediction, const std::string& number,
                                const std::string& source) {
  const std::string title = "Expected of people";
  const v1::Preset preset =
      fit::BreathPreset("expected", title, absl::StrCat("The mean breath of people with ", number, "."),
                        person.amplitudes(), prediction.amplitudes);
  const std::string description = absl::StrCat("Lungs of a person with the breath that ", number, " leads to expect.");
  const v1::Scene scene =
      fit::PersonScene({SceneNameOf(file), description, lungs.bodies, person.registered(), {preset}}, lungs.templates);
  return WriteScene(file, scene, absl::StrCat("Written by phrenic fit from points at end exhale: ", source, "."));
}

}  // namespace phrenic::client
