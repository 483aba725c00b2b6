// The permissions of every method, in one table.
#ifndef PHRENIC_SERVER_ACCESS_RULES_H_
#define PHRENIC_SERVER_ACCESS_RULES_H_

#include <span>
#include <string_view>

#include "phrenic/v1/access.pb.h"

namespace phrenic::access {

// AccessGuard checks it before a method runs; the services check further that exports, studies and uploads belong to
// the caller.
struct Rule {
  std::string_view method;                            // "SessionService.GetSession"
  v1::AccessRole role = v1::ACCESS_ROLE_UNSPECIFIED;  // required of the account; unspecified: any account or join link
  v1::AccessRole in_session = v1::ACCESS_ROLE_UNSPECIFIED;  // required in the session of session_id
  bool changes = false;                                     // admitted calls are written to the audit log
  bool open = false;                                        // needs neither account nor link
  bool uncounted = false;  // exempt from the rate limit, because it is frequent and mostly cheap
};

// Returns all rules. All functions are thread-safe. The table is constant.
std::span<const Rule> Rules();

// Returns the rule of the method with this request type, such as "phrenic.v1.GetSessionRequest"; no two methods share
// one. Null if there is none.
const Rule* RuleOf(std::string_view request_type);

// Returns "viewer", "controller", "owner" or "admin"; empty for ACCESS_ROLE_UNSPECIFIED.
std::string_view NameOf(v1::AccessRole role);
// Returns ACCESS_ROLE_UNSPECIFIED if there is no such role.
v1::AccessRole RoleOf(std::string_view name);

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_RULES_H_
