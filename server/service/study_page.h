// Renders a study as one HTML file.
#ifndef PHRENIC_SERVER_SERVICE_STUDY_PAGE_H_
#define PHRENIC_SERVER_SERVICE_STUDY_PAGE_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/study.pb.h"

namespace phrenic::service {

// Returns WEB_ROOT/report.html with the study's JSON in its <script id="study"> element, from which the page draws.
// Reads the file at each call. The page needs nothing else, so it can be kept and opened without a server. "<" in the
// JSON is escaped, so that text of a scene cannot end the element.
// Errors: FAILED_PRECONDITION if the study is not done; NOT_FOUND if the viewer is not built. Thread-safe.
absl::StatusOr<std::string> StudyPage(const v1::Study& study, const std::string& web_root);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_STUDY_PAGE_H_
