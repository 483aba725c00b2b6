// How large the request of a study may be.
#ifndef PHRENIC_SERVER_STUDY_QUEUE_REQUEST_SIZE_H_
#define PHRENIC_SERVER_STUDY_QUEUE_REQUEST_SIZE_H_

#include "absl/status/status.h"
#include "phrenic/v1/study.pb.h"

namespace phrenic::study {

// A study keeps its request until it has ended, and takes a run for each integrator, resolution or input that it names.
// INVALID_ARGUMENT, naming the list, if a list of the study has more than 256 entries; RESOURCE_EXHAUSTED if the
// request, with its scene, takes more than 16 MiB of memory. Pure function, thread-safe.
absl::Status CheckSize(const v1::CreateStudyRequest& request);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_QUEUE_REQUEST_SIZE_H_
