#include "server/service/calls/access_guard.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/time/clock.h"
#include "server/crypto/secret.h"
#include "server/crypto/sha256.h"
#include "server/schema/schema.h"
#include "server/service/calls/messages.h"
#include "server/service/calls/peer.h"

namespace phrenic::service {
namespace {

using access::Caller;
using access::Rule;

constexpr std::string_view kBearer = "Bearer ";
constexpr std::size_t kMaxLinksPerCall = 8, kSecretLength = 32;

absl::Status SessionNotVisible(const std::string& id) {
  return absl::NotFoundError(absl::StrCat("session_id: there is no session \"", id.substr(0, 64),
                                          "\" that you may see; its owner can send you a join link"));
}

absl::Status NeedsRole(std::string_view method, v1::AccessRole role, const char* scope) {
  return absl::PermissionDeniedError(absl::StrCat("authorization: ", std::string(method), " requires the role ",
                                                  std::string(access::NameOf(role)), scope,
                                                  "; ask an administrator or the session's owner for it"));
}

// Returns the request's session_id; empty if it has none.
std::string SessionOf(const google::protobuf::Message& request) {
  const auto* field = SessionIdField(*request.GetDescriptor());
  return field == nullptr ? "" : request.GetReflection()->GetString(request, field);
}

// Returns the token of a "Bearer TOKEN" header (RFC 6750 section 2.1); empty for another scheme.
std::string_view TokenOf(std::string_view authorization) {
  if (!absl::StartsWithIgnoreCase({authorization.data(), authorization.size()}, "bearer ")) return {};
  return authorization.substr(kBearer.size());
}

absl::Status NoLink() {
  return absl::UnauthenticatedError(
      "x-join: no session has this join link, or it has expired; ask the session's owner for a new one");
}

// Adds the hashes of a comma-separated list of link secrets (browsers join repeated headers with commas). Leaves out
// what is not a secret.
void AddLinks(std::string_view secrets, std::vector<std::string>& links) {
  for (absl::string_view secret : absl::StrSplit(absl::string_view(secrets.data(), secrets.size()), ',')) {
    secret = absl::StripAsciiWhitespace(secret);
    const bool is_secret =
        secret.size() == kSecretLength && std::all_of(secret.begin(), secret.end(), absl::ascii_isxdigit);
    if (is_secret && links.size() < kMaxLinksPerCall) links.push_back(Sha256Hex({secret.data(), secret.size()}));
  }
}

std::string_view TextOf(const grpc::string_ref& text) { return {text.data(), text.size()}; }

}  // namespace

absl::StatusOr<Caller> AccessGuard::Identify(const Headers& headers) const {
  Caller caller;
  caller.peer = headers.peer;
  if (!guarded() || caller.peer.empty()) {
    caller.account.role = v1::ACCESS_ROLE_ADMIN;
    return caller;
  }
  const auto [first, last] = headers.metadata.equal_range("x-join");
  for (auto given = first; given != last; ++given) AddLinks(TextOf(given->second), caller.links);
  KeepLive(caller.links);
  const auto given = headers.metadata.find("authorization");
  if (given == headers.metadata.end()) {
    if (first != last && caller.links.empty()) return NoLink();
    return caller;
  }
  auto account = accounts_.Check(TokenOf(TextOf(given->second)));
  if (!account.ok()) return account.status();
  caller.account = *std::move(account);
  return caller;
}

void AccessGuard::KeepLive(std::vector<std::string>& links) const {
  constexpr int kMaxSessions = 1000;
  if (links.empty()) return;
  const absl::Time now = absl::Now();
  const auto sessions = table_.List(kMaxSessions, "").sessions;
  std::erase_if(links, [&](const std::string& hash) {
    return std::none_of(sessions.begin(), sessions.end(), [&](const auto& session) {
      const auto access = session->access();
      return std::any_of(access->links.begin(), access->links.end(), [&](const session::ControlState::Link& link) {
        return SameToken(hash, link.secret_sha256) && now < link.expires;
      });
    });
  });
}

v1::AccessRole AccessGuard::RoleIn(const Caller& caller, const session::Session& session) const {
  if (caller.admin()) return v1::ACCESS_ROLE_ADMIN;
  const auto access = session.access();
  if (caller.known() && access->account == caller.account.name) return v1::ACCESS_ROLE_OWNER;
  v1::AccessRole role = access->account.empty() ? caller.account.role : v1::ACCESS_ROLE_UNSPECIFIED;
  for (const session::ControlState::Link& link : access->links) {
    const bool held = std::any_of(caller.links.begin(), caller.links.end(),
                                  [&link](const std::string& hash) { return SameToken(hash, link.secret_sha256); });
    if (held && absl::Now() < link.expires) role = std::max(role, link.role);
  }
  return role;
}

bool AccessGuard::MaySee(const Caller& caller, const session::Session& session) const {
  return RoleIn(caller, session) >= v1::ACCESS_ROLE_VIEWER;
}

std::function<bool()> AccessGuard::StillMaySee(const Caller& caller, const session::Session& session) const {
  if (!guarded()) return nullptr;
  return [this, caller, &session] { return accounts_.StillHas(caller.account) && MaySee(caller, session); };
}

absl::StatusOr<std::shared_ptr<session::Session>> AccessGuard::Find(const Caller& caller, const std::string& id) const {
  auto session = table_.Find(id);
  if (!guarded() || (session.ok() && MaySee(caller, **session))) return session;
  return SessionNotVisible(id);
}

absl::Status AccessGuard::CheckSessionRole(const Rule& rule, const Caller& caller, const std::string& session) const {
  if (caller.admin()) return absl::OkStatus();  // the service reports a missing session
  const auto found = table_.Find(session);
  if (!found.ok() || !MaySee(caller, **found)) return SessionNotVisible(session);
  if (RoleIn(caller, **found) >= rule.in_session) return absl::OkStatus();
  return NeedsRole(rule.method, rule.in_session, " in this session");
}

absl::Status AccessGuard::CheckRule(const Rule& rule, const Caller& caller, const std::string& session) const {
  if (!guarded() || rule.open) return absl::OkStatus();
  if (!caller.known() && !caller.admin() && caller.links.empty()) {
    return absl::UnauthenticatedError(
        "authorization: this server requires an account; send a token (phrenic --token-file FILE, PHRENIC_TOKEN, "
        "or \"Sign in\" in the viewer), or open a join link");
  }
  if (caller.account.role < rule.role) return NeedsRole(rule.method, rule.role, "");
  return rule.in_session == v1::ACCESS_ROLE_UNSPECIFIED ? absl::OkStatus() : CheckSessionRole(rule, caller, session);
}

// Calls from this machine without an account come from its operator and are not limited.
absl::Status AccessGuard::CountCall(const Caller& caller) {
  if (!caller.known() && IsThisMachine(caller.peer)) return absl::OkStatus();
  return rate_.Take(caller.known() ? "account " + caller.account.name : caller.peer, absl::Now());
}

absl::Status AccessGuard::CheckRate(const Rule& rule, const Caller& caller) {
  return rule.uncounted ? absl::OkStatus() : CountCall(caller);
}

bool AccessGuard::IsKnown(const Caller& caller) const {
  return !guarded() || caller.known() || caller.admin() || !caller.links.empty();
}

absl::StatusOr<Caller> AccessGuard::AdmitHeaders(const grpc::ServerContextBase& context, const Rule& rule) {
  auto caller = Identify({context.client_metadata(), PeerOf(context)});
  if (caller.ok() && (rule.open || IsKnown(*caller))) return caller;
  Caller unknown;
  unknown.peer = PeerOf(context);
  if (rule.open) return unknown;
  absl::Status refusal = CheckRate(rule, unknown);
  if (refusal.ok()) refusal = caller.ok() ? CheckRule(rule, unknown, "") : caller.status();
  metrics_.CountRequest(refusal);
  if (logged_refusals_.Take("", absl::Now()).ok()) audit_.Note(unknown, rule.method, "", refusal);
  return refusal;
}

std::string AccessGuard::ShareOf(const Caller& caller) const {
  if (caller.known() || !caller.links.empty()) return absl::StrCat(caller.known() ? "account " : "", caller.id());
  return !guarded() && IsThisMachine(caller.peer) ? "" : caller.peer;
}

std::string AccessGuard::KeyOf(const Caller& caller, const grpc::ServerContextBase& context) const {
  const bool by_connection = !guarded() && IsThisMachine(caller.peer) && !caller.peer.empty();
  return by_connection ? absl::StrCat(caller.peer, " ", context.peer()) : ShareOf(caller);
}

absl::StatusOr<Caller> AccessGuard::Admit(const grpc::ServerContextBase& context,
                                          const google::protobuf::Message& request) {
  return Admit(Headers{context.client_metadata(), PeerOf(context)}, request);
}

absl::StatusOr<Caller> AccessGuard::Admit(const Headers& headers, const google::protobuf::Message& request) {
  const Rule* rule = access::RuleOf(request.GetDescriptor()->full_name());
  if (rule == nullptr)
    return absl::InternalError(absl::StrCat(request.GetTypeName(), " has no rule in access/rules.cc"));
  const std::string session = SessionOf(request);
  auto caller = Identify(headers);
  Caller who;
  who.peer = headers.peer;
  if (caller.ok()) who = *caller;
  absl::Status outcome = CheckRate(*rule, who);
  if (outcome.ok()) outcome = rule->open ? absl::OkStatus() : caller.status();
  if (outcome.ok()) outcome = CheckRule(*rule, who, session);
  metrics_.CountRequest(outcome);
  if (outcome.ok() ? rule->changes : logged_refusals_.Take("", absl::Now()).ok()) {
    audit_.Note(who, rule->method, session, outcome);
  }
  if (outcome.ok()) outcome = schema::Validate(request);
  if (!outcome.ok()) return outcome;
  return who;
}

bool AccessGuard::Owns(const Caller& caller, const std::string& session) const {
  if (!guarded()) return false;
  if (caller.admin()) return true;
  const auto found = table_.Find(session);
  return found.ok() && caller.known() && (*found)->access()->account == caller.account.name;
}

bool AccessGuard::MayUse(const std::string& owner, const Caller& caller) const {
  if (!guarded() || caller.admin()) return true;
  return !owner.empty() && owner == caller.id();
}

absl::Status AccessGuard::CheckOwns(Kind kind, const std::string& id, const std::optional<std::string>& owner,
                                    const Caller& caller) const {
  if (MayUse(owner.value_or(""), caller)) return absl::OkStatus();
  const char* what = kind == Kind::kExport ? "export" : kind == Kind::kStudy ? "study" : "patient";
  return absl::NotFoundError(
      absl::StrCat(what, "_id: there is no ", what, " \"", id.substr(0, 80), "\" that belongs to you"));
}

std::optional<std::string> AccessGuard::Known(std::string_view authorization, std::string_view join) const {
  if (!guarded()) return "";
  if (const auto account = accounts_.Check(TokenOf(authorization)); account.ok()) return "account " + account->name;
  Caller caller;
  AddLinks(join, caller.links);
  KeepLive(caller.links);
  return caller.links.empty() ? std::nullopt : std::optional(caller.id());
}

session::Requester AccessGuard::RequesterOf(const Caller& caller, const grpc::ServerContextBase& context) const {
  const std::string owner = caller.id();
  return {.owner = owner,
          .all_files = caller.admin(),
          .share = owner.empty() ? absl::StrCat(caller.peer, " ", context.peer()) : owner,
          .cancelled = [&context] { return context.IsCancelled(); }};
}

bool AccessGuard::IsAdmin(std::string_view authorization) const {
  if (!guarded()) return true;
  const auto account = accounts_.Check(TokenOf(authorization));
  return account.ok() && account->role == v1::ACCESS_ROLE_ADMIN;
}

}  // namespace phrenic::service
