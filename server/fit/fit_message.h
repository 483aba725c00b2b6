// A fit as the API sends it.
#ifndef PHRENIC_SERVER_FIT_FIT_MESSAGE_H_
#define PHRENIC_SERVER_FIT_FIT_MESSAGE_H_

#include "phrenic/v1/fit.pb.h"
#include "server/fit/joint_fit.h"
#include "server/fit/motion_fit.h"
#include "server/fit/motion_study.h"

namespace phrenic::fit {

// Returns all numbers of a fit, unrounded; no scene.
v1::MotionFitResult FitMessage(const MotionFit& fit, const FitOptions& options);
v1::MotionFitResult JointFitMessage(const JointFit& fit, const FitOptions& options);

v1::MotionOfPerson PersonMessage(const StudiedPerson& person, const FitOptions& options);
v1::MotionOfPeople PeopleMessage(const MotionStudy& study);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_FIT_MESSAGE_H_
