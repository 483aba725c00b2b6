// Changes of a session's parameters that wait for a tick.
#ifndef PHRENIC_SERVER_SESSION_UPDATE_SCHEDULE_H_
#define PHRENIC_SERVER_SESSION_UPDATE_SCHEDULE_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "absl/status/status.h"
#include "phrenic/v1/saved.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::session {

inline constexpr std::size_t kMostWaiting = 256;  // updates

// Changes ordered by tick, and by call for the same tick. Not thread-safe: the stepping thread owns it.
class UpdateSchedule {
 public:
  // Returns RESOURCE_EXHAUSTED if kMostWaiting changes wait already. Requires: `tick` is after the session's present
  // tick.
  absl::Status Add(std::int64_t tick, const v1::Parameters& changes);
  // Removes and returns the first changes whose tick is at most `tick`; nullopt if all are later. Call it until it
  // returns nullopt.
  std::optional<v1::Parameters> TakeDue(std::int64_t tick);
  void Clear() { waiting_.clear(); }
  bool empty() const { return waiting_.empty(); }
  int size() const { return static_cast<int>(waiting_.size()); }

  // Restore adds the saved updates, in the same order, to an empty schedule.
  void Save(v1::SavedMoment& moment) const;
  void Restore(const v1::SavedMoment& moment);

 private:
  std::multimap<std::int64_t, v1::Parameters> waiting_;  // by tick
};

// Returns the largest stable step [s] for `parameters`. It is `known_step`, that of `known`, if nothing that the step
// depends on differs; otherwise the computation takes a while. Thread-safe. The step depends on stiffness (elasticity)
// and integrator; a computation is that of LargestStableStep.
double StableStepFor(const Model& model, const v1::Parameters& parameters, const v1::Parameters& known,
                     double known_step);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_UPDATE_SCHEDULE_H_
