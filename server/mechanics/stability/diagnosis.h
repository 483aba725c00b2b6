// Why a step diverged.
#ifndef PHRENIC_SERVER_MECHANICS_STABILITY_DIAGNOSIS_H_
#define PHRENIC_SERVER_MECHANICS_STABILITY_DIAGNOSIS_H_

#include "absl/status/status.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Returns the vertex furthest from rest in a diverged state, the largest force on it in the state before, and a remedy.
// `why` is the status of the step (step/step.h).
v1::Divergence Diagnose(const Model& model, const v1::Parameters& parameters, const absl::Status& why,
                        const State& before, const State& diverged);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STABILITY_DIAGNOSIS_H_
