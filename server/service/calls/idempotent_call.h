// Idempotent calls: a request with a request_id takes effect once; a repeat gets the first response.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_IDEMPOTENT_CALL_H_
#define PHRENIC_SERVER_SERVICE_CALLS_IDEMPOTENT_CALL_H_

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "server/session/idempotency_cache.h"
#include "server/session/session.h"

namespace phrenic::service {

// True if a call with this status may have changed the session, so that a repeat must not run again. ABORTED may come
// after a part of the steps, and OUT_OF_RANGE is a divergence on the way; other errors mean that nothing has changed.
// Pure function, thread-safe.
inline bool MayHaveChanged(const absl::Status& status) {
  return status.ok() || absl::IsAborted(status) || absl::IsOutOfRange(status);
}

// Runs `act`, which fills `response`, unless the cache has the response to this request_id. The cache compares the
// whole request, with its control token, so that another client cannot read a response by guessing its id. Returns the
// status of `act`, now or at the first call, or an error of IdempotencyCache::Begin. Thread-safe. `act` runs at most
// once, on the calling thread. A repeat that comes while the first call runs waits for it, so the calling thread may
// block. The cache keeps what MayHaveChanged accepts, and a repeat gets it with its status; after any other error a
// repeat runs `act` again. A cached error leaves the response empty. Without a request_id `act` always runs.
// INVALID_ARGUMENT if the id came with another request before, or is not valid.
template <class Request, class Response, class Act>
absl::Status RunUnlessCached(session::IdempotencyCache& cache, const Request& request, Response* response, Act act) {
  const std::string& id = request.request_id();
  if (id.empty()) return act();
  const auto cached = cache.Begin(id, absl::StrCat(Request::descriptor()->full_name(), request.SerializeAsString()));
  if (!cached.ok()) return cached.status();
  if (cached->has_value()) {
    if ((*cached)->status.ok()) response->ParseFromString((*cached)->bytes);
    return (*cached)->status;
  }
  absl::Status status = act();
  if (MayHaveChanged(status)) {
    cache.Keep(id, {status, response->SerializeAsString()});
  } else {
    cache.Forget(id);
  }
  return status;
}

// The same for a session, whose change is acknowledged only if other servers of its cluster would continue from it: the
// errors of Session::Acknowledge, also for a repeat, whose change is not made again. Waits for the session's copy;
// without a cluster it does not wait. An error of Acknowledge means that the change may be lost with this server. The
// handlers of SessionService call it, and hold the session meanwhile.
template <class Request, class Response, class Act>
absl::Status RunOnce(session::Session& session, const Request& request, Response* response, Act act) {
  absl::Status status = RunUnlessCached(session.answers(), request, response, act);
  if (!MayHaveChanged(status)) return status;
  const absl::Status acknowledged = session.Acknowledge();
  return acknowledged.ok() ? status : acknowledged;
}

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_IDEMPOTENT_CALL_H_
