// Admits or refuses every call: identity, permission, request rate, and validation of the request.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_ACCESS_GUARD_H_
#define PHRENIC_SERVER_SERVICE_CALLS_ACCESS_GUARD_H_

#include <google/protobuf/message.h>
#include <grpcpp/server_context.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/access/accounts.h"
#include "server/access/audit.h"
#include "server/access/caller.h"
#include "server/access/rate.h"
#include "server/access/rules.h"
#include "server/service/calls/metrics.h"
#include "server/session/requester.h"
#include "server/session/table.h"

namespace phrenic::service {

// Every service method calls Admit first. gRPC's auth processors and interceptors do not serve here, because the calls
// of browsers arrive in process, through the gateway. Thread-safe.
//
// The server has one guard. Handlers call it on threads of their lanes, IncomingCall on gRPC's threads and the web
// gateway on its own, so no method waits for a session's steps. It has no lock of its own: accounts, audit log, table,
// metrics and rates lock themselves.
class AccessGuard {
 public:
  // What Admit reads of a call. Views of the call's metadata, names in lower case.
  struct Headers {
    const std::multimap<grpc::string_ref, grpc::string_ref>& metadata;
    std::string peer;  // PeerOf
  };

  // Resources outside of sessions that belong to the caller who made them; they know their owner. CheckOwns names the
  // kind in its error.
  enum class Kind { kExport, kStudy, kPatient };

  // All references outlive the guard. `max_requests` is per caller [1/s]; 0 means no limit.
  AccessGuard(const access::Accounts& accounts, access::AuditLog& audit, const session::Table& table, Metrics& metrics,
              double max_requests)
      : accounts_(accounts), audit_(audit), table_(table), metrics_(metrics), rate_(max_requests) {}

  // Returns the caller if the rule of the method (access::Rules) allows the call and schema::Validate accepts the
  // request. Writes to the audit log and counts the outcome. Checks in this order: rate, identity, rule, fields. A call
  // from this process, and every call to a server without accounts, has the role of an administrator. A method whose
  // rule is open admits unknown callers, even with a bad token. Only calls whose rule says `changes`, and refusals,
  // reach the audit log, refusals at 10 a second at most. A field that Validate refuses counts as an admitted call.
  // INTERNAL if access/rules.cc has no rule for the request type.
  // Errors: UNAUTHENTICATED without an account, with a bad token, or with a join link that no session has;
  // PERMISSION_DENIED if the role is too low; RESOURCE_EXHAUSTED above the rate limit; NOT_FOUND if the session does
  // not exist or is not visible to the caller; INVALID_ARGUMENT for a bad field.
  absl::StatusOr<access::Caller> Admit(const grpc::ServerContextBase& context,
                                       const google::protobuf::Message& request);
  // The same for a call that does not come over gRPC.
  absl::StatusOr<access::Caller> Admit(const Headers& headers, const google::protobuf::Message& request);

  // Returns the caller by the headers of a call alone, before its request is read. UNAUTHENTICATED if the method needs
  // an account or a link and the caller has none; Admit counts and checks the calls that pass. IncomingCall calls it on
  // gRPC's threads. A refused call counts towards the rate of its address. Returns the caller with its address alone
  // for an open method whose caller is unknown. RESOURCE_EXHAUSTED above the rate limit.
  absl::StatusOr<access::Caller> AdmitHeaders(const grpc::ServerContextBase& context, const access::Rule& rule);
  // True if the caller has an account or a link, or if the server needs none.
  bool IsKnown(const access::Caller& caller) const;
  // Returns the name under which limits count the calls of a caller: its account or link, else its address; without
  // accounts, each connection from this machine is a caller of its own. Empty for this process. IncomingCall uses it
  // for every limit of CallLimits.
  std::string KeyOf(const access::Caller& caller, const grpc::ServerContextBase& context) const;
  // Returns the name under which limits count what a caller has, such as viewers: its account or link, else its
  // address. Empty, without a limit of its own, for this machine if the server has no accounts. FairShare counts the
  // empty name only towards the limit of all callers.
  std::string ShareOf(const access::Caller& caller) const;

  // Counts one more call of an admitted caller towards its rate: one whose rule says `uncounted`, but which turned out
  // to be costly. RESOURCE_EXHAUSTED above the rate. Does not count this machine's calls without an account.
  absl::Status CountCall(const access::Caller& caller);

  // True if calls need an account. Constant while the server runs.
  bool guarded() const { return accounts_.required(); }
  // True if the caller has at least the role of a viewer in the session: as an administrator, as the account that owns
  // it, by a join link that has not expired, or by any account's role if no account owns the session.
  bool MaySee(const access::Caller& caller, const session::Session& session) const;
  // Returns a predicate that re-evaluates MaySee during a stream, since accounts and links can be revoked; null if the
  // server has no accounts. The guard and the session outlive it. The predicate is false as well once the token file no
  // longer has the account. It is thread-safe.
  std::function<bool()> StillMaySee(const access::Caller& caller, const session::Session& session) const;
  // Returns a session that a request names beside its session_id. NOT_FOUND if the caller may not see it. The session
  // lives as long as the caller holds it, even if it is deleted meanwhile.
  absl::StatusOr<std::shared_ptr<session::Session>> Find(const access::Caller& caller, const std::string& id) const;

  // True if the caller's account owns the session or is an administrator; no control token is needed then. False on a
  // server without accounts, where the control token decides alone.
  bool Owns(const access::Caller& caller, const std::string& session) const;
  // True if the caller may use a resource that belongs to `owner`, the id() of a caller. Always true for administrators
  // and on a server without accounts; false for an empty owner otherwise.
  bool MayUse(const std::string& owner, const access::Caller& caller) const;
  // Returns NOT_FOUND if the caller does not own the resource, so that its existence is not revealed. `owner` is
  // nullopt if there is no such resource: the call then goes on and reports that, if the caller may know it. `id`
  // appears in the error, cut to 80 bytes.
  absl::Status CheckOwns(Kind kind, const std::string& id, const std::optional<std::string>& owner,
                         const access::Caller& caller) const;
  // Returns what the caller may use of uploads and compiles. `context` outlives it. Its `cancelled` reads the context.
  // Without an account or a link, each connection has a share of the compiles of its own.
  session::Requester RequesterOf(const access::Caller& caller, const grpc::ServerContextBase& context) const;
  // Returns the present name of an account that an earlier version stored (Accounts::Qualified).
  std::string AccountOf(const std::string& stored) const { return accounts_.Qualified(stored); }

  // True if an HTTP Authorization header has an administrator's token, or if the server has no accounts. The web
  // gateway asks it for /metrics.
  bool IsAdmin(std::string_view authorization) const;
  // Returns the name of a caller, given its Authorization and X-Join headers: of the account, or of a link to one of
  // this server's sessions that has not expired. Empty if the server has no accounts; nullopt if the caller is unknown.
  // The web gateway asks it before it reads a long body.
  std::optional<std::string> Known(std::string_view authorization, std::string_view join) const;

 private:
  // Reads the address, up to 8 join links and the token. UNAUTHENTICATED for a token that no account has, and for links
  // without a token of which none is live.
  absl::StatusOr<access::Caller> Identify(const Headers& headers) const;
  // Removes links that no session has, or that have expired. Looks at the first 1000 sessions by id.
  void KeepLive(std::vector<std::string>& links) const;
  // Checks the account's role, then the role in the session. OK for an open rule and without accounts.
  absl::Status CheckRule(const access::Rule& rule, const access::Caller& caller, const std::string& session) const;
  // NOT_FOUND if the caller may not see the session, so that its existence is not revealed; PERMISSION_DENIED if the
  // role there is too low. OK for administrators, also for a session that does not exist: the service reports that.
  absl::Status CheckSessionRole(const access::Rule& rule, const access::Caller& caller,
                                const std::string& session) const;
  // As CountCall, unless the method's rule says `uncounted`.
  absl::Status CheckRate(const access::Rule& rule, const access::Caller& caller);
  // Returns the highest role that the caller has in the session; unspecified if it may not see it.
  v1::AccessRole RoleIn(const access::Caller& caller, const session::Session& session) const;

  const access::Accounts& accounts_;
  access::AuditLog& audit_;
  const session::Table& table_;
  Metrics& metrics_;
  access::RateLimit rate_;
  access::RateLimit logged_refusals_{10};  // [1/s], so that refused calls cannot fill the disk
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_ACCESS_GUARD_H_
