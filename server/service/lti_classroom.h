// Admits the users of learning platforms (lti/) to sessions of this server.
#ifndef PHRENIC_SERVER_SERVICE_LTI_CLASSROOM_H_
#define PHRENIC_SERVER_SERVICE_LTI_CLASSROOM_H_

#include <map>
#include <memory>
#include <set>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/access/accounts.h"
#include "server/lti/classroom.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe. The server owns one if it is a tool of learning platforms.
//
// A teacher gets a token of the course's account with the role of an owner, and the control token of the session's
// owner; a learner gets the session's join link, with the role of a viewer or a controller. Teachers alone control the
// session until a lesson lets learners do so for the first time; when a teacher then takes control back, no later
// launch lends it again. Token and link end after twelve hours or more.
class LtiClassroom final : public lti::Classroom {
 public:
  // All outlive the classroom.
  LtiClassroom(session::Table& table, access::Accounts& accounts) : table_(table), accounts_(accounts) {}

  // Makes the session if it does not exist, and plays it if it is at rest and no one watches. FAILED_PRECONDITION if
  // another account owns a session of this id.
  absl::StatusOr<std::string> Admit(const lti::Visit& visit) override ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Link {
    std::string secret;
    absl::Time renewed;  // from then on a new one is made
  };

  absl::StatusOr<std::shared_ptr<session::Session>> FindOrCreate(const lti::Visit& visit)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the control token of the session's owner, and lets everybody control the session when learners may for the
  // first time.
  absl::StatusOr<std::string> OwnerToken(session::Session& session, bool learners_control)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the secret of a link of the role, which learners of the session share.
  absl::StatusOr<std::string> LinkOf(session::Session& session, v1::AccessRole role)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  session::Table& table_;
  access::Accounts& accounts_;
  absl::Mutex mutex_;                                          // held while a session is made, so that it is made once
  std::set<std::string> lent_ ABSL_GUARDED_BY(mutex_);         // sessions in which learners had control once
  std::map<std::string, Link> links_ ABSL_GUARDED_BY(mutex_);  // by session and role
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_LTI_CLASSROOM_H_
