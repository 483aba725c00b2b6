// Environment variables.
#ifndef PHRENIC_CLIENT_TERMINAL_ENVIRONMENT_H_
#define PHRENIC_CLIENT_TERMINAL_ENVIRONMENT_H_

#include <cstdlib>
#include <string>

namespace phrenic::client {

// Returns the value of an environment variable; empty if it is not set. Requires: no other thread changes the
// environment at the same time. A variable that is set to nothing counts as not set. The result is a copy.
inline std::string EnvironmentVariable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_ENVIRONMENT_H_
