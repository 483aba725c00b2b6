// The streaming study: error, bandwidth and CPU time of every codec and error bound.
#ifndef PHRENIC_SERVER_STUDY_STREAMING_H_
#define PHRENIC_SERVER_STUDY_STREAMING_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Runs the subject from rest for two equal numbers of frames. The shapes of CODEC_BASIS are made from the first half;
// the second half is encoded and decoded with each codec and each error bound (CPU time of this thread). A row has
// bytes per frame, Mbit/s at 30 frames per second, largest and RMS error [mm], and times [us]. Requires: every field of
// the request's study is set. Errors: those of a step that diverges; FAILED_PRECONDITION if the scene streams no
// vertices; CANCELLED if `progress` returns false.
absl::StatusOr<v1::StreamingTable> StudyStreaming(const v1::CreateStudyRequest& request, const Subject& subject,
                                                  const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STREAMING_H_
