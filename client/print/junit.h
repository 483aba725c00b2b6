// What was judged, as test runners and CI read it: the JUnit XML format.
#ifndef PHRENIC_CLIENT_PRINT_JUNIT_H_
#define PHRENIC_CLIENT_PRINT_JUNIT_H_

#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic::client {

struct JudgedCase {
  std::string name;
  std::string failure;   // a sentence; empty where all is well
  bool skipped = false;  // could not be judged
};

// One test suite, with a test case for each. DATA_LOSS names the file where it cannot be written.
absl::Status WriteJUnit(const std::string& file, const std::string& suite, const std::vector<JudgedCase>& cases);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_JUNIT_H_
