// On whose behalf the server reads uploaded files and compiles scenes. Plain data.
#ifndef PHRENIC_SERVER_SESSION_REQUESTER_H_
#define PHRENIC_SERVER_SESSION_REQUESTER_H_

#include <functional>
#include <string>

namespace phrenic::session {

// Services make one for each call; Models::Restore makes a trusted one. The thread that makes the call asks
// `cancelled`.
struct Requester {
  std::string owner = {};                     // account or guest (access::Caller::id()); empty without accounts
  bool all_files = false;                     // an administrator may name the files of every owner
  std::string share = {};                     // whose share of the compiles this one takes: the owner, or an address
  std::function<bool()> cancelled = nullptr;  // true once the caller has gone or its deadline has passed; null: never
  bool trusted = false;                       // a scene that this server, or an earlier one, has accepted before
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_REQUESTER_H_
