// Whether the time step of a study's runs is chosen automatically.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_STEP_CHOICE_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_STEP_CHOICE_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// True if neither the request nor the scene sets it.
inline bool ChoosesStep(const v1::CreateStudyRequest& request, const Subject& subject) {
  return !request.parameters().has_time_step() && !subject.model->scene.parameters().has_time_step();
}

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_STEP_CHOICE_H_
