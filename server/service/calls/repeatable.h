// Requests with a request_id: carried out once, answered alike however often they come.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_REPEATABLE_H_
#define PHRENIC_SERVER_SERVICE_CALLS_REPEATABLE_H_

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "server/session/idempotency_cache.h"

namespace phrenic::service {

// Whether the request may have changed something, so that a repeat must not carry it out again.
inline bool MayHaveChanged(const absl::Status& status) {
  return status.ok() || absl::IsAborted(status) || absl::IsOutOfRange(status);
}

// `act` fills the response. The token is part of what is repeated: nobody reads another's answer by its id.
template <class Request, class Response, class Act>
absl::Status Once(session::IdempotencyCache& answers, const Request& request, Response* response, Act act) {
  const std::string& id = request.request_id();
  if (id.empty()) return act();
  const auto before = answers.Begin(id, absl::StrCat(Request::descriptor()->full_name(), request.SerializeAsString()));
  if (!before.ok()) return before.status();
  if (before->has_value()) {
    if ((*before)->status.ok()) response->ParseFromString((*before)->bytes);
    return (*before)->status;
  }
  absl::Status status = act();
  if (MayHaveChanged(status)) {
    answers.Keep(id, {status, response->SerializeAsString()});
  } else {
    answers.Forget(id);
  }
  return status;
}

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_REPEATABLE_H_
