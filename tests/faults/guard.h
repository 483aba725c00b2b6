// The nginx that guards an open server (deploy/guard), as a child process.
#ifndef PHRENIC_TESTS_FAULTS_GUARD_H_
#define PHRENIC_TESTS_FAULTS_GUARD_H_

#include <sys/types.h>

#include <string>

namespace phrenic::faults {

// Not thread-safe.
class Guard {
 public:
  // Starts it in front of a server's two addresses, with its files in `folder`. running() tells whether it listens
  // within ten seconds: not without deploy/guard or nginx.
  Guard(const std::string& folder, const std::string& listen, const std::string& web);
  ~Guard();
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  bool running() const { return port_ > 0; }
  int port() const { return port_; }  // of gRPC and web, with TLS

 private:
  pid_t pid_ = -1;
  int port_ = 0;
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_GUARD_H_
