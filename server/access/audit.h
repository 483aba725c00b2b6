// Who did what: an object of JSON a line, of each call that changes something and of each that was refused.
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

// Any thread may call. The file is its owner's alone; past 16 MiB it goes to FILE.1, and so on up to FILE.4. It names
// callers, machines and sessions, and holds no token, no secret and nothing of what a session simulates.
class AuditLog {
 public:
  // Empty: nothing is written. PERMISSION_DENIED where the file cannot be.
  static absl::StatusOr<std::unique_ptr<AuditLog>> Open(const std::string& file);

  // `outcome` OK: the call went on to its service.
  void Note(const Caller& caller, std::string_view method, const std::string& session, const absl::Status& outcome);

 private:
  std::shared_ptr<spdlog::logger> log_;
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_AUDIT_H_
