// The stability map: verdicts over stiffness and time step for each integrator.
#ifndef PHRENIC_SERVER_STUDY_STABILITY_MAP_H_
#define PHRENIC_SERVER_STUDY_STABILITY_MAP_H_

#include <vector>

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Returns factors of the scene's stiffness: 1, 10, ... up to `stiffest`.
std::vector<double> StiffnessFactors(double stiffest);

// Appends rows for every integrator at every stiffness. Each runs the scene from a small perturbation (Perturbed) over
// the study's time. Time steps are 0.95 and 1.05 times the theoretical limit, divided or multiplied by powers of 2;
// without a limit they start at 0.1 s and are halved. The longest step is first. After a run of an integrator exceeds
// its CPU time, runs with as many steps or more are skipped ("out of time"). The verdict compares kinetic energies with
// a velocity Verlet run at a quarter of its limit: "grown" above 10 times, "damped" below 1 %, else "stable";
// "diverged" and "stopped" if a step fails. CANCELLED if `progress` returns false.
absl::Status AddMap(const Subject& subject, const v1::StabilityStudy& study, const Progress& progress,
                    v1::StabilityTable& table);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STABILITY_MAP_H_
