#include "server/study/trajectory.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "server/mechanics/skinning/probe_position.h"
#include "server/mechanics/skinning/tissue_bodies.h"
#include "server/mechanics/step/step.h"
#include "server/schema/thread_cpu.h"

namespace phrenic::study {
namespace {

// Describes why a run ended with this error.
std::string Ended(const absl::Status& why, double time) {
  if (absl::IsAborted(why)) return absl::StrFormat("stopped at %.4g s: %s", time, std::string(why.message()));
  return absl::StrFormat("diverged at %.4g s", time);
}

// Adds the squared distances of free vertices to the sums; `sum.largest` is squared until the end.
void Add(const Points& a, const Points& b, const Model& model, Distance& sum, double& squares, long& count) {
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    if (model.inverse_mass[i] <= 0) continue;
    const double squared = (a.col(i) - b.col(i)).squaredNorm();
    sum.largest = std::max(sum.largest, squared);
    squares += squared;
    ++count;
  }
}

// Largest distance of a probe [m].
double ProbeDistance(const Model& model, const State& a, const State& b) {
  double largest = 0;
  for (const Probe& probe : model.probes) {
    const BodyModel& body = model.bodies[static_cast<size_t>(probe.body)];
    if (!FollowsTissue(model, body)) continue;
    largest = std::max(largest, (ProbePosition(model, a, probe) - ProbePosition(model, b, probe)).norm());
  }
  return largest;
}

}  // namespace

std::vector<double> Moments(double seconds, int count) {
  std::vector<double> moments(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) moments[static_cast<size_t>(i)] = seconds * (i + 1) / count;
  return moments;
}

double DividingStep(const std::vector<double>& moments, double dt) {
  return moments.front() / std::max(1.0, std::ceil(moments.front() / dt * (1 - 1e-9)));
}

absl::StatusOr<Trajectory> Simulate(const Subject& subject, const std::vector<double>& moments, double dt,
                                    double most_cpu_s, const Progress& progress) {
  const Model& model = *subject.model;
  v1::Parameters parameters = subject.parameters;
  const double step = DividingStep(moments, dt);
  parameters.set_time_step(step);
  const long each = std::lround(moments.front() / step);
  const long all = each * static_cast<long>(moments.size());
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  Trajectory trajectory;
  const double start = ThreadCpuSeconds();
  for (long done = 0; done < all; ++done) {
    const absl::Status stepped = Step(model, parameters, step, state, work);
    trajectory.simulated_s = state.time;
    if (!stepped.ok()) trajectory.problem = Ended(stepped, state.time);
    if (done % kCheckInterval == 0) {
      trajectory.cpu_s = ThreadCpuSeconds() - start;
      if (!progress(static_cast<double>(done) / static_cast<double>(all), "stepping")) return Cancelled();
      if (trajectory.cpu_s > most_cpu_s) trajectory.problem = absl::StrFormat("out of time at %.4g s", state.time);
    }
    if (!trajectory.problem.empty()) return trajectory;
    if ((done + 1) % each == 0) trajectory.states.push_back(state);
  }
  trajectory.cpu_s = ThreadCpuSeconds() - start;
  return trajectory;
}

double LargestDisplacement(const Model& model, const Trajectory& trajectory) {
  double largest = 0;
  for (const State& state : trajectory.states) {
    if (state.x.cols() > 0) largest = std::max(largest, (state.x - model.rest).colwise().norm().maxCoeff());
  }
  return largest;
}

Distance DistanceBetween(const Subject& subject, const Trajectory& a, const Trajectory& b) {
  const Model& model = *subject.model;
  Distance distance;
  double squares = 0;
  long count = 0;
  for (size_t i = 0; i < std::min(a.states.size(), b.states.size()); ++i) {
    Add(a.states[i].x, b.states[i].x, model, distance, squares, count);
    distance.probes = std::max(distance.probes, ProbeDistance(model, a.states[i], b.states[i]));
    distance.energy = std::max(distance.energy, std::abs(Energy(subject, a.states[i]) - Energy(subject, b.states[i])));
  }
  distance.largest = std::sqrt(distance.largest);
  distance.rms = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
  return distance;
}

double RmsDistance(const Model& model, const Points& a, const Points& b) {
  Distance distance;
  double squares = 0;
  long count = 0;
  Add(a, b, model, distance, squares, count);
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
}

double Energy(const Subject& subject, const State& state) {
  const Model& model = *subject.model;
  double energy = 0;
  for (Eigen::Index i = 0; i < state.v.cols(); ++i) {
    if (model.inverse_mass[i] > 0) energy += 0.5 * model.mass[i] * state.v.col(i).squaredNorm();
  }
  const EvalContext at = MakeEvalContext(model, subject.parameters, state);
  for (const auto& force : model.forces) {
    if (force->conservative()) energy += force->Energy(at);
  }
  return energy;
}

}  // namespace phrenic::study
