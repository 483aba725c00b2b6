// A person's lungs and breath as a scene that anyone can run: the generated lungs scaled onto the person's, moved by
// the fitted amplitudes (Motion.lung_modes). It has numbers of the fit alone, none of the person's points, unless they
// are asked for.
#ifndef PHRENIC_SERVER_FIT_PERSON_SCENE_H_
#define PHRENIC_SERVER_FIT_PERSON_SCENE_H_

#include <array>
#include <string>
#include <vector>

#include "phrenic/v1/scene.pb.h"
#include "server/fit/joint_fit.h"
#include "server/fit/motion_fit.h"
#include "server/fit/scene_lungs.h"

namespace phrenic::fit {

// A breath to write. The numbers are rounded to 1 um, the lungs' places to 10 um.
struct PersonBreath {
  std::string name;               // of the scene
  std::string description;        // one sentence
  std::array<v1::Body, 2> lungs;  // of the template's scene, by Side
  RegisteredLungs registered;
  std::vector<v1::Preset> presets;  // the first is what the scene starts with
};

// Returns a preset of these amplitudes [m].
v1::Preset BreathPreset(const std::string& name, const std::string& title, const std::string& description,
                        const std::vector<Amplitude>& amplitudes, const Eigen::VectorXd& values);

// Returns the presets of a fit: the fitted breath; that which its descent leads to expect of people; the descent of the
// bases alone; the chest wall alone.
std::vector<v1::Preset> PresetsOf(const MotionFit& fit, const std::vector<Amplitude>& amplitudes);

// Returns the scene. Requires: at least one preset.
v1::Scene PersonScene(const PersonBreath& breath, const LungTemplates& templates);

// Returns the scene of a fit with `numbers` amplitudes. `source` says what the landmarks are of. `landmarks`: adds up
// to 400 of the held-out half and what the fit leaves at them. Its numbers may be beyond the parameters' ranges
// (schema::Validate).
v1::Scene FittedScene(const std::string& name, const std::string& source, const SceneLungs& lungs, const MotionFit& fit,
                      int numbers, bool landmarks);

// Returns the scene of a fit to several kinds of data; its breath has the length and the shares of the recordings.
v1::Scene JointScene(const std::string& name, const std::string& source, const SceneLungs& lungs, const JointFit& fit,
                     int numbers, bool landmarks);

// Adds the landmarks of the held-out half, at most `most` of them, evenly chosen: balls that move with the fitted
// tissue, balls that stay where the landmarks are at end inhale, and a rod from each predicted to each true place.
void AddLandmarks(const MotionFit& fit, int most, v1::Scene& scene);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_PERSON_SCENE_H_
