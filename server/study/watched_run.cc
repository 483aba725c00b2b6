#include "server/study/watched_run.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "server/mechanics/stability/diagnosis.h"
#include "server/mechanics/step/step.h"
#include "server/mechanics/step/step_checkpoint.h"
#include "server/schema/thread_cpu.h"

namespace phrenic::study {

double KineticEnergy(const Model& model, const Points& v) {
  double energy = 0;
  for (Eigen::Index i = 0; i < v.cols(); ++i) {
    if (model.inverse_mass[i] > 0) energy += 0.5 * model.mass[i] * v.col(i).squaredNorm();
  }
  return energy;
}

std::string Where(const v1::Divergence& divergence) {
  return absl::StrFormat("vertex %d of %s, by %s", divergence.vertex(), divergence.body(), divergence.force());
}

absl::StatusOr<WatchedRun> Watch(const Subject& subject, const State& start, double seconds, double dt,
                                 double most_cpu_s, const Progress& progress, const EachState& each) {
  const Model& model = *subject.model;
  v1::Parameters parameters = subject.parameters;
  parameters.set_time_step(dt);
  WatchedRun run;
  State& state = run.last;
  state = start;
  Workspace work = model.MakeWorkspace();
  StepCheckpoint checkpoint;
  const long all = std::max(1L, std::lround(std::ceil(seconds / dt * (1 - 1e-9))));
  const double began = ThreadCpuSeconds();
  if (each) each(state);
  for (long done = 0; done < all; ++done) {
    if (done % kCheckInterval == 0) {
      if (!progress(static_cast<double>(done) / static_cast<double>(all), "stepping")) return Cancelled();
      run.cut = ThreadCpuSeconds() - began > most_cpu_s;
      if (run.cut) return run;
    }
    checkpoint.Note(model, parameters, state);
    run.status = Step(model, parameters, dt, state, work);
    if (!run.status.ok()) {
      const State before = checkpoint.StateBeforeLastStep(model, parameters, dt, work);
      run.divergence = Diagnose(model, parameters, run.status, before, state);
      return run;
    }
    run.simulated_s = state.time;
    const double kinetic = KineticEnergy(model, state.v);
    run.largest_kinetic = std::max(run.largest_kinetic, kinetic);
    if (2 * done >= all) run.late_kinetic = std::max(run.late_kinetic, kinetic);
    if (each) each(state);
  }
  return run;
}

}  // namespace phrenic::study
