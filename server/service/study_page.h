// A study as one HTML file.
#ifndef PHRENIC_SERVER_SERVICE_STUDY_PAGE_H_
#define PHRENIC_SERVER_SERVICE_STUDY_PAGE_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/study.pb.h"

namespace phrenic::service {

// WEB_ROOT/report.html, which draws what stands in its <script id="study">, with the study's JSON in there.
// FAILED_PRECONDITION for a study that is not done, NOT_FOUND where the viewer was not built.
absl::StatusOr<std::string> StudyPage(const v1::Study& study, const std::string& web_root);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_STUDY_PAGE_H_
