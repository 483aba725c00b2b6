// Results of checks in the JUnit XML format, which test runners and CI read.
#ifndef PHRENIC_CLIENT_FILES_JUNIT_H_
#define PHRENIC_CLIENT_FILES_JUNIT_H_

#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic::client {

struct CheckResult {
  std::string name;
  std::string failure;   // a sentence; empty if the check passed
  bool skipped = false;  // true if the check could not be made
};

// Writes one test suite with one test case per check. DATA_LOSS names the file if it cannot be written.
absl::Status WriteJUnit(const std::string& file, const std::string& suite, const std::vector<CheckResult>& checks);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_JUNIT_H_
