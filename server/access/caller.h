// Who calls, and what they may do.
#ifndef PHRENIC_SERVER_ACCESS_CALLER_H_
#define PHRENIC_SERVER_ACCESS_CALLER_H_

#include <string>
#include <vector>

#include "phrenic/v1/access.pb.h"

namespace phrenic::access {

struct Account {
  std::string name;
  v1::AccessRole role = v1::ACCESS_ROLE_UNSPECIFIED;  // the most that it may do anywhere but in its own sessions
  std::string token_sha256 = "";                      // by which a file has it; empty: another gave it
};

struct Caller {
  Account account;                 // without a name: unknown
  std::vector<std::string> links;  // the SHA-256 of each join link's secret that came with the call
  std::string peer;                // "192.0.2.1"; empty: this process

  bool known() const { return !account.name.empty(); }
  bool admin() const { return account.role == v1::ACCESS_ROLE_ADMIN; }
  // By which what they made is theirs; guests are told apart by their links.
  std::string id() const {
    constexpr std::size_t kShort = 12;
    return known() || links.empty() ? account.name : "guest " + links.front().substr(0, kShort);
  }
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_CALLER_H_
