// Checks a study's or campaign's tables against the limits in a file: `--check limits.textproto`.
#ifndef PHRENIC_CLIENT_FILES_STUDY_LIMITS_H_
#define PHRENIC_CLIENT_FILES_STUDY_LIMITS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/study.pb.h"

namespace phrenic::client {

// Reads and parses the file. Errors name the file and the line.
absl::StatusOr<v1::StudyLimits> ReadStudyLimits(const std::string& file);
absl::StatusOr<v1::StudyLimits> ParseStudyLimits(const std::string& file, const std::string& text);

// Returns the limit as text: "rows.error_mm where integrator=bdf2".
std::string LimitText(const v1::StudyLimit& limit);

// Returns one sentence per limit that is exceeded or to which no row applies. INVALID_ARGUMENT if a limit names a table
// or a column that the result does not have.
absl::StatusOr<std::vector<std::string>> ExceededLimits(const v1::StudyLimits& limits,
                                                        const google::protobuf::Message& tables);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_STUDY_LIMITS_H_
