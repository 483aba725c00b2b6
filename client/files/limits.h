// A study held against limits, for harnesses: `--check limits.textproto`.
#ifndef PHRENIC_CLIENT_FILES_LIMITS_H_
#define PHRENIC_CLIENT_FILES_LIMITS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/study.pb.h"

namespace phrenic::client {

// Reads and parses the file; errors name it and the line.
absl::StatusOr<v1::StudyLimits> ReadStudyLimits(const std::string& file);

// "rows.error_mm where integrator=bdf2".
std::string LimitText(const v1::StudyLimit& limit);

// One sentence for each limit that is passed, or that no row has to do with; none where all is well. INVALID_ARGUMENT
// for a limit that names a table or a field that the result does not have.
absl::StatusOr<std::vector<std::string>> PassedLimits(const v1::StudyLimits& limits,
                                                      const google::protobuf::Message& tables);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_LIMITS_H_
