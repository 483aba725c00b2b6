// The interface between a study and its caller: scene compiler, progress, subject.
#ifndef PHRENIC_SERVER_STUDY_CONTEXT_H_
#define PHRENIC_SERVER_STUDY_CONTEXT_H_

#include <functional>
#include <memory>
#include <string_view>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::study {

// Compiles a scene source, as the server or the client does.
using Compiler = std::function<absl::StatusOr<std::shared_ptr<const Model>>(const v1::SceneSource&)>;

// Reports the completed fraction, 0 to 1, and the current activity. Returns false to cancel: the study then ends with
// CANCELLED.
using Progress = std::function<bool(double done, std::string_view doing)>;
inline constexpr long kCheckInterval = 16;  // steps between two checks of the CPU time and of Progress

// A model with the parameters under which it is studied.
struct Subject {
  std::shared_ptr<const Model> model;
  v1::Parameters parameters;  // every field set
};

// The status of a study whose Progress returned false.
inline absl::Status Cancelled() { return absl::CancelledError("the study was cancelled"); }

// Maps the progress of one part of a study, 0 to 1, onto `from` to `to` of the whole. Requires: `whole` outlives it.
inline Progress Part(const Progress& whole, double from, double to) {
  return [&whole, from, to](double done, std::string_view doing) { return whole(from + (to - from) * done, doing); };
}

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_CONTEXT_H_
