// Resource limits of a server: every list, buffer and queue is bounded.
#ifndef PHRENIC_SERVER_SESSION_LIMITS_H_
#define PHRENIC_SERVER_SESSION_LIMITS_H_

#include <cstdint>

namespace phrenic::session {

// Plain data, set from the server's options once and then constant. Beyond a limit a call returns RESOURCE_EXHAUSTED,
// or the oldest entry makes room.
struct Limits {
  int sessions = 16;                  // of a server, or of one of a cluster
  int sessions_of_user = 8;           // on a server with accounts
  int viewers = 64;                   // of one session
  int viewers_in_all = 256;           // of all sessions
  double session_cpu = 1;             // share of a core for stepping one session; 1: no limit
  int exports = 2;                    // running at the same time; comparisons, checks, batches and fits as well
  int models = 4;                     // compiled scenes kept for the next session
  std::int64_t vertices = 4'000'000;  // of one scene
  std::int64_t elements = 4'000'000;  // of one scene (SizeLimits)
  double compile_seconds = 60;        // of one scene; 0: any time
  int kept_exports = 16;              // that wait, run or have ended
  int export_minutes = 60;            // how long a file is kept for download
  std::int64_t upload_bytes = std::int64_t{256} << 20;  // of one file
  std::int64_t uploads_bytes = std::int64_t{1} << 30;   // of all of them
  int uploads = 1024;                                   // kept; a patient has 60
  // Of each account, on a server with accounts.
  std::int64_t uploads_bytes_of_user = std::int64_t{256} << 20;
  int uploads_of_user = 256;  // kept
  double pause_minutes = 5;   // a session without viewers or calls plays on; 0: forever
  double delete_minutes = 0;  // a session without viewers or calls is kept; 0: forever
  double share = 0.75;  // fraction of viewers, exports, comparisons, checks, batches, fits and studies of a caller
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_LIMITS_H_
