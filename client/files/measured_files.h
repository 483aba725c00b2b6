// A person's files as they are named on the command line.
#ifndef PHRENIC_CLIENT_FILES_MEASURED_FILES_H_
#define PHRENIC_CLIENT_FILES_MEASURED_FILES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fit/evidence.h"

namespace phrenic::client {

// The options' values, with the suffix after "@".
struct MeasuredOptions {
  std::vector<std::string> landmarks;      // FILE or FILE@PHASE
  std::vector<std::string> exhale;         // FILE, at most one
  std::vector<std::string> surfaces;       // FILE@inhale or FILE@exhale; inhale if not said
  std::vector<std::string> lung_surfaces;  // the same
  std::vector<std::string> volumes;        // FILE
  std::vector<std::string> m_modes;        // FILE@right or FILE@left; right if not said
  std::vector<std::string> markers;        // FILE
  std::vector<std::string> errors;         // KIND=VALUE
};

// True if anything but pairs at end inhale is given.
bool HasOtherKinds(const MeasuredOptions& options);
// Checks KIND=VALUE. INVALID_ARGUMENT names the kinds.
absl::Status CheckError(const std::string& text);
// Reads the files. NOT_FOUND names the file and its option's kind; INVALID_ARGUMENT for a time or side that is unknown,
// or an error of a kind that is not given.
absl::StatusOr<std::vector<fit::MeasuredFile>> ReadMeasured(const MeasuredOptions& options);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_MEASURED_FILES_H_
