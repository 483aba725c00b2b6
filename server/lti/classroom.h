// Where a launch ends: a session of this server. The server implements it; tests have one of their own.
#ifndef PHRENIC_SERVER_LTI_CLASSROOM_H_
#define PHRENIC_SERVER_LTI_CLASSROOM_H_

#include <string>

#include "absl/status/statusor.h"

namespace phrenic::lti {

// Who is to be admitted to which session. Plain data.
struct Visit {
  std::string session;  // id; the session is made if it does not exist
  std::string account;  // that owns it: the course of a platform
  std::string scene;
  bool teaches = false;           // as the owner; otherwise as a guest
  bool learners_control = false;  // guests may change the session; otherwise they watch and answer
};

// Thread-safe.
class Classroom {
 public:
  virtual ~Classroom() = default;
  // Returns the credentials as the fragment of the viewer's address: "account=TOKEN&control=TOKEN" or "join=SECRET".
  // Blocks while the session is made. The errors of the session's creation, in words for its users.
  virtual absl::StatusOr<std::string> Admit(const Visit& visit) = 0;
};

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_CLASSROOM_H_
