// A person's lungs and breath, written as a scene that `phrenic run`, a server and the viewer take.
#ifndef PHRENIC_CLIENT_FILES_PERSON_FILE_H_
#define PHRENIC_CLIENT_FILES_PERSON_FILE_H_

#include <string>

#include "absl/status/status.h"
#include "server/fit/joint_fit.h"
#include "server/fit/motion_fit.h"
#include "server/fit/scene_lungs.h"

namespace phrenic::client {

// Writes a fit; the scene has the file's name. `source` names the landmarks' files. `landmarks`: adds up to 400 of the
// held-out half and what the fit leaves at them. DATA_LOSS names the file if it cannot be
// written; FAILED_PRECONDITION if the motion is beyond the parameters' ranges.
absl::Status WriteFittedScene(const std::string& file, const fit::SceneLungs& lungs, const fit::MotionFit& fit,
                              const fit::FitOptions& options, const std::string& source, bool landmarks);

// The same for a fit to several kinds of data.
absl::Status WriteJointScene(const std::string& file, const fit::SceneLungs& lungs, const fit::JointFit& fit,
                             const fit::FitOptions& options, const std::string& source, bool landmarks);

// Writes the motion that one number leads to expect; `number` says which, such as "a descent of 13 mm".
absl::Status WriteExpectedScene(const std::string& file, const fit::SceneLungs& lungs, const fit::Person& person,
                                const fit::Prediction& prediction, const std::string& number,
                                const std::string& source);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_PERSON_FILE_H_
