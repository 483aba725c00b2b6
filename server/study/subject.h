// What a study is about: a model under parameters and an integrator.
#ifndef PHRENIC_SERVER_STUDY_SUBJECT_H_
#define PHRENIC_SERVER_STUDY_SUBJECT_H_

#include <google/protobuf/repeated_field.h>

#include <string>
#include <vector>

#include "server/study/context.h"

namespace phrenic::study {

// The wanted ones; all that carry motion (every one but the static) where none is named.
std::vector<v1::Integrator> IntegratorsFor(const google::protobuf::RepeatedField<int>& wanted);
// "velocity_verlet"
std::string NameOf(v1::Integrator integrator);

// The subject under another integrator.
Subject With(const Subject& subject, v1::Integrator integrator);
// The largest stable step of the subject's own integrator, as predicted [s]; 0 where none is.
double PredictedStep(const Subject& subject);

// The model of `source` with the parameters of the request over the scene's and the preset's; the time step that the
// compile step chooses where none is named. INVALID_ARGUMENT names what is wrong.
absl::StatusOr<Subject> MakeSubject(const v1::SceneSource& source, const std::string& preset,
                                    const v1::Parameters& parameters, const Compiler& compile);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_SUBJECT_H_
