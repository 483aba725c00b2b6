// The audit log: one JSON object per line for each admitted call that changes something and each refused call.
#ifndef PHRENIC_SERVER_ACCESS_AUDIT_H_
#define PHRENIC_SERVER_ACCESS_AUDIT_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/access/caller.h"

namespace spdlog {
class logger;
}

namespace phrenic::access {

// Thread-safe. Lines are ASCII, and what a caller wrote is escaped and shortened. The file has mode 0600 and is rotated
// at 16 MiB, to FILE.1 up to FILE.4. It contains the names of callers, machines and sessions, but no token, no secret
// and no simulated data. The server owns one, which AccessGuard writes to.
class AuditLog {
 public:
  // Writes nothing if `file` is empty. PERMISSION_DENIED if the file cannot be written.
  static absl::StatusOr<std::unique_ptr<AuditLog>> Open(const std::string& file);

  // Appends a line. `outcome` is OK for an admitted call, else the refusal. Each line is in the file when the call
  // returns. Of `session` and the peer, 128 bytes are kept. `method` is "SessionService.PlaySession".
  void Note(const Caller& caller, std::string_view method, const std::string& session, const absl::Status& outcome);

 private:
  std::shared_ptr<spdlog::logger> log_;  // null: no audit log
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_AUDIT_H_
