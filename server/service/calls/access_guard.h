// Every call's way in: who calls, whether they may, whether the request is in order.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_ACCESS_GUARD_H_
#define PHRENIC_SERVER_SERVICE_CALLS_ACCESS_GUARD_H_

#include <google/protobuf/message.h>
#include <grpcpp/server_context.h>

#include <functional>
#include <map>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/access/accounts.h"
#include "server/access/audit.h"
#include "server/access/caller.h"
#include "server/access/rate.h"
#include "server/access/rules.h"
#include "server/service/calls/metrics.h"
#include "server/session/table.h"

namespace phrenic::service {

// Services ask it first of all, as gRPC's own means see no call within the process, which every browser's is. Any
// thread may call.
class AccessGuard {
 public:
  // What is not a session and belongs to whoever made it.
  enum class Kind { kExport, kStudy, kUpload };

  // All outlive the guard.
  AccessGuard(const access::Accounts& accounts, access::AuditLog& audit, const session::Table& table, Metrics& metrics,
              double max_requests)
      : accounts_(accounts), audit_(audit), table_(table), metrics_(metrics), rate_(max_requests) {}

  // Who calls, where the rule of the request's method (access::Rules) lets them in and the request keeps its own
  // (schema::Validate). Else UNAUTHENTICATED, PERMISSION_DENIED, RESOURCE_EXHAUSTED, INVALID_ARGUMENT, or NOT_FOUND for
  // a session that they may not see.
  absl::StatusOr<access::Caller> Admit(const grpc::ServerContextBase& context,
                                       const google::protobuf::Message& request);

  // Whether calls need an account.
  bool guarded() const { return accounts_.required(); }
  bool MaySee(const access::Caller& caller, const session::Session& session) const;
  // The same, asked again and again while somebody watches: an account or a link may be taken away.
  std::function<bool()> StillMaySee(const access::Caller& caller, const session::Session& session) const;
  // The session that somebody names inside a request, where they may see it.
  absl::StatusOr<std::shared_ptr<session::Session>> Find(const access::Caller& caller, const std::string& id) const;

  // Whether the session is this account's own, or anything is as an administrator's: no control token is needed then.
  bool Owns(const access::Caller& caller, const std::string& session) const;
  // What they made is theirs from now on.
  void Give(Kind kind, const std::string& id, const std::string& caller_id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Caller::id() of whom it is; empty: nobody's.
  std::string OwnerOf(Kind kind, const std::string& id) const ABSL_LOCKS_EXCLUDED(mutex_);
  bool Owns(Kind kind, const std::string& id, const access::Caller& caller) const ABSL_LOCKS_EXCLUDED(mutex_);
  // NOT_FOUND, as if there were none.
  absl::Status CheckOwns(Kind kind, const std::string& id, const access::Caller& caller) const;

  // Who asks for a page with this in "authorization".
  bool IsAdmin(std::string_view authorization) const;

 private:
  absl::StatusOr<access::Caller> Identify(const grpc::ServerContextBase& context) const;
  absl::Status Decide(const access::Rule& rule, const access::Caller& caller, const std::string& session) const;
  absl::Status DecideInSession(const access::Rule& rule, const access::Caller& caller,
                               const std::string& session) const;
  absl::Status Count(const access::Rule& rule, const access::Caller& caller);
  v1::AccessRole RoleIn(const access::Caller& caller, const session::Session& session) const;

  const access::Accounts& accounts_;
  access::AuditLog& audit_;
  const session::Table& table_;
  Metrics& metrics_;
  access::RateLimit rate_;
  access::RateLimit noted_refusals_{10};  // a second: nobody fills the disk with them
  mutable absl::Mutex mutex_;
  std::map<std::pair<Kind, std::string>, std::string> owners_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_ACCESS_GUARD_H_
