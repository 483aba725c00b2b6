// Error against bandwidth: what frames of a scene cost to send, by every codec and error bound.
#ifndef PHRENIC_SERVER_STUDY_STREAMING_H_
#define PHRENIC_SERVER_STUDY_STREAMING_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Runs the subject from rest for as many frames as are measured, from which the shapes of CODEC_BASIS are made, and
// then for those that are measured: encoded and decoded by each codec within each bound of the ladder (CPU time of this
// thread). Every field of `request`'s study must be set. Errors: a run that diverges, with where; CANCELLED as soon as
// `progress` says so.
absl::StatusOr<v1::StreamingTable> StudyStreaming(const v1::CreateStudyRequest& request, const Subject& subject,
                                                  const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STREAMING_H_
