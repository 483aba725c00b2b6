// Makes and varies the subject of a study: a model with its parameters.
#ifndef PHRENIC_SERVER_STUDY_SUBJECT_H_
#define PHRENIC_SERVER_STUDY_SUBJECT_H_

#include <google/protobuf/repeated_field.h>

#include <string>
#include <vector>

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Returns the given integrators; all time integrators (all but the static solver) if none is given.
std::vector<v1::Integrator> IntegratorsFor(const google::protobuf::RepeatedField<int>& wanted);
// Returns the name of an integrator as in JSON and on the command line: "velocity_verlet".
std::string NameOf(v1::Integrator integrator);

// Returns the subject with another integrator.
Subject With(const Subject& subject, v1::Integrator integrator);
// Returns the predicted largest stable step of the subject's integrator [s]; infinity if there is no limit, 0 if no
// step is stable.
double PredictedStep(const Subject& subject);

// Compiles `source`. Parameters are those of the scene, overridden by the preset and then by `parameters`; the time
// step is chosen from the stability limit if neither the request nor the scene sets it. Errors: those of `compile`;
// INVALID_ARGUMENT with the field's name if a parameter or the preset is invalid.
absl::StatusOr<Subject> MakeSubject(const v1::SceneSource& source, const std::string& preset,
                                    const v1::Parameters& parameters, const Compiler& compile);

// Compiles another scene in place of the request's, under the subject's parameters.
absl::StatusOr<Subject> Recompile(const v1::CreateStudyRequest& request, const Subject& subject, const v1::Scene& scene,
                                  const Compiler& compile);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_SUBJECT_H_
