#include "server/jobs/noun.h"

#include "absl/strings/str_cat.h"
#include "server/schema/id.h"
#include "server/schema/names.h"

namespace phrenic::jobs {

absl::StatusOr<std::string> Noun::ChooseId(const std::string& wanted, const std::string& base,
                                           absl::FunctionRef<bool(const std::string& id)> taken) const {
  if (absl::Status status = schema::CheckId(absl::StrCat(singular, "_id"), wanted); !status.ok()) return status;
  if (wanted.empty()) return schema::FreeId(base, singular, taken);
  if (!taken(wanted)) return wanted;
  return absl::AlreadyExistsError(
      absl::StrCat(singular, "_id: there is ", article, " ", singular, " \"", wanted, "\" already"));
}

absl::Status Noun::NotFound(const std::string& id, const std::vector<std::string>& ids) const {
  return absl::NotFoundError(absl::StrCat(singular, "_id: there is no ", singular, " \"", schema::ShortId(id), "\"",
                                          schema::ThereAre(id, ids)));
}

absl::Status Noun::Deleted(const std::string& id) const {
  return absl::CancelledError(absl::StrCat(singular, "_id: the ", singular, " \"", id, "\" was deleted"));
}

absl::Status Noun::NoRoom(int kept) const {
  return absl::ResourceExhaustedError(
      absl::StrCat(kept, " ", plural, " wait or run, and no more are allowed: delete one, or wait for one to end"));
}

absl::Status Noun::NoRoomForOwner(int kept) const {
  return absl::ResourceExhaustedError(absl::StrCat(
      "you have ", kept, " ", plural,
      " that wait or run, the most that one caller may have (--max-share): ", "delete one, or wait for one to end"));
}

}  // namespace phrenic::jobs
