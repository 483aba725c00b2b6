// What a study needs of whoever runs it.
#ifndef PHRENIC_SERVER_STUDY_CONTEXT_H_
#define PHRENIC_SERVER_STUDY_CONTEXT_H_

#include <functional>
#include <memory>
#include <string_view>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::study {

using Compiler = std::function<absl::StatusOr<std::shared_ptr<const Model>>(const v1::SceneSource&)>;

// Is told how much is done, 0 to 1, and what is being done; false asks the study to end with CANCELLED.
using Progress = std::function<bool(double done, std::string_view doing)>;
inline constexpr long kLook = 16;  // steps between two looks at the clock and the caller

// One model under the parameters that the study was asked for.
struct Subject {
  std::shared_ptr<const Model> model;
  v1::Parameters parameters;  // every field set
};

inline absl::Status Cancelled() { return absl::CancelledError("the study was cancelled"); }

// The part of a study from `from` to `to` of the whole.
inline Progress Part(const Progress& whole, double from, double to) {
  return [&whole, from, to](double done, std::string_view doing) { return whole(from + (to - from) * done, doing); };
}

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_CONTEXT_H_
