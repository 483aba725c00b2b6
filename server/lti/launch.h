// What a learning platform's signed token says of a launch (LTI 1.3 core, Deep Linking 2.0).
#ifndef PHRENIC_SERVER_LTI_LAUNCH_H_
#define PHRENIC_SERVER_LTI_LAUNCH_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/lti/platform.h"

namespace phrenic::lti {

// Plain data. Texts are empty where the platform leaves them out.
struct Launch {
  bool chooses = false;  // a teacher is to choose a lesson (deep linking); otherwise a lesson is opened
  std::string user;      // "sub"
  bool teaches = false;  // has a teacher's role in the course
  std::string deployment;
  std::string course;             // id of the course; of the activity if it is in none
  std::string lesson;             // name of the lesson that the teacher chose
  bool learners_control = false;  // the teacher let learners change the simulation
  std::string line_item;          // where scores go; empty: the platform takes none
  std::string memberships;        // where the names of the course's members are; empty: the platform does not give them
  std::string return_url, data;   // of deep linking
};

// Reads the claims of a token whose signature was verified. `nonce` is that of this server's request; `url` is this
// server's origin. UNAUTHENTICATED with a plain reason for a token that is for another tool, deployment or request, has
// no time or has expired; INVALID_ARGUMENT for what LTI requires and the token has not; PERMISSION_DENIED for an
// address outside of the platform (CheckAddress) or of this server. Thread-safe.
absl::StatusOr<Launch> ReadLaunch(std::string_view claims, const Platform& platform, std::string_view nonce,
                                  std::string_view url, absl::Time now);

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_LAUNCH_H_
