// How a queue's ids and errors name its jobs.
#ifndef PHRENIC_SERVER_JOBS_NOUN_H_
#define PHRENIC_SERVER_JOBS_NOUN_H_

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"

namespace phrenic::jobs {

// The words for one kind of job, and its errors in them. The field that requests name is SINGULAR_id.
struct Noun {
  std::string singular;  // "export"
  std::string plural;    // "exports"
  std::string article;   // "an"

  // Returns `wanted` if it is a valid free id, or, if `wanted` is empty, a free id that begins with `base`.
  // INVALID_ARGUMENT, or ALREADY_EXISTS if the id is taken.
  absl::StatusOr<std::string> ChooseId(const std::string& wanted, const std::string& base,
                                       absl::FunctionRef<bool(const std::string& id)> taken) const;
  // NOT_FOUND; lists the ids that there are.
  absl::Status NotFound(const std::string& id, const std::vector<std::string>& ids) const;
  // CANCELLED.
  absl::Status Deleted(const std::string& id) const;
  // RESOURCE_EXHAUSTED.
  absl::Status NoRoom(int kept) const;
  absl::Status NoRoomForOwner(int kept) const;
};

}  // namespace phrenic::jobs

#endif  // PHRENIC_SERVER_JOBS_NOUN_H_
