// Continues a saved session in a build whose model of the scene has other bits.
#ifndef PHRENIC_SERVER_SESSION_CARRY_OVER_H_
#define PHRENIC_SERVER_SESSION_CARRY_OVER_H_

#include <memory>

#include "absl/status/statusor.h"
#include "server/mechanics/model.h"
#include "server/session/saving.h"
#include "server/store/layout.h"

namespace phrenic::session {

// Matches the last saved state with `model`: bodies, poses and scalar coordinates by name; vertices by index where all
// rest positions of a body agree within 1e-5 of the model's size, else by the nearest rest position within half an
// edge. A store of format 2 has neither names nor rest positions: all numbers must agree. The state must be finite and
// in bounds, keep its edges' lengths and its constraints, and take a step.
//
// Then takes the steps and changes of the journal in this build; they are approximately those of the other one. If that
// fails, continues from the saved state, with the last parameters. `carried_over` of the result says what was done.
//
// FAILED_PRECONDITION, with the session's id and the remedy, if something cannot be matched. Steps on the calling
// thread, before the session exists, which may take seconds. A session that had diverged takes no trial step.
// Thread-safe.
absl::StatusOr<Replayed> CarryOver(const std::shared_ptr<const Model>& model, const store::SavedSession& saved);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_CARRY_OVER_H_
