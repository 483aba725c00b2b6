// How much a server takes on: every list, buffer and queue of it ends somewhere.
#ifndef PHRENIC_SERVER_SESSION_LIMITS_H_
#define PHRENIC_SERVER_SESSION_LIMITS_H_

namespace phrenic::session {

struct Limits {
  int sessions = 16;
  int viewers = 64;  // of one session
  int exports = 2;   // at once
  int models = 4;    // compiled scenes kept for the next session
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_LIMITS_H_
