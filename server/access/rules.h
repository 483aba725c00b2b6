// What a call needs: the one table that decides, for every method.
#ifndef PHRENIC_SERVER_ACCESS_RULES_H_
#define PHRENIC_SERVER_ACCESS_RULES_H_

#include <span>
#include <string_view>

#include "phrenic/v1/access.pb.h"

namespace phrenic::access {

struct Rule {
  std::string_view method;                                  // "SessionService.GetSession"
  v1::AccessRole role = v1::ACCESS_ROLE_UNSPECIFIED;        // of the account; unspecified: any, or a join link
  v1::AccessRole in_session = v1::ACCESS_ROLE_UNSPECIFIED;  // in the session that session_id names
  bool changes = false;                                     // goes into the audit log
  bool anybody = false;                                     // needs neither account nor link
  bool uncounted = false;  // in no limit of requests: there are many, and they are cheap
};

std::span<const Rule> Rules();

// Of the method that takes this message, "phrenic.v1.GetSessionRequest": each has one of its own. Null: there is none.
const Rule* RuleOf(std::string_view request_type);

// "viewer", "controller", "owner", "admin"; empty for none.
std::string_view NameOf(v1::AccessRole role);
// Unspecified where there is no such role.
v1::AccessRole RoleOf(std::string_view name);

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_RULES_H_
