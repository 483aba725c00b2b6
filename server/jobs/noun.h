// How a queue's ids and errors name its jobs: "there is no export \"a\"; there are b, c".
#ifndef PHRENIC_SERVER_JOBS_NOUN_H_
#define PHRENIC_SERVER_JOBS_NOUN_H_

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"

namespace phrenic::jobs {

// The words for one kind of job, and its errors in them. The field that requests name is SINGULAR_id. Immutable; all
// functions are thread-safe. Errors say what the caller can do next.
struct Noun {
  std::string singular;  // "export"
  std::string plural;    // "exports"
  std::string article;   // "an"

  // Returns `wanted` if it is a valid free id, or, if `wanted` is empty, a free id that begins with `base`.
  // INVALID_ARGUMENT if `wanted` is no id (schema/id.h), or ALREADY_EXISTS if it is taken. Calls `taken` once for each
  // id that it tries.
  absl::StatusOr<std::string> ChooseId(const std::string& wanted, const std::string& base,
                                       absl::FunctionRef<bool(const std::string& id)> taken) const;
  // NOT_FOUND; lists the ids that there are.
  absl::Status NotFound(const std::string& id, const std::vector<std::string>& ids) const;
  // CANCELLED: for those who wait for a job that is deleted meanwhile.
  absl::Status Deleted(const std::string& id) const;
  // RESOURCE_EXHAUSTED: all of the `kept` places of the queue, or of one owner, have jobs that wait or run.
  absl::Status NoRoom(int kept) const;
  absl::Status NoRoomForOwner(int kept) const;
};

}  // namespace phrenic::jobs

#endif  // PHRENIC_SERVER_JOBS_NOUN_H_
