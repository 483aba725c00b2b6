#include "server/study/reference.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/schema/thread_cpu.h"
#include "server/study/acceleration.h"

namespace phrenic::study {
namespace {

constexpr double kFastest = 10;  // velocities may err by as much as this lets positions err in a second [1/s]
constexpr int kStop = -1;        // CVODE: an error that nothing recovers from
constexpr int kRetry = 1;        // CVODE: try a smaller step

// What a problem's evaluations share with the one who solves it.
struct Problem {
  Acceleration acceleration;
  const Progress& progress;
  double seconds;
  std::int64_t evaluations = 0;
  bool cancelled = false;
};

Eigen::Map<Points> Half(N_Vector y, int half) {
  const Eigen::Index n = N_VGetLength(y) / 6;
  return {N_VGetArrayPointer(y) + 3 * n * half, 3, n};
}

int Evaluate(realtype t, N_Vector y, N_Vector derivative, void* user) {
  Problem& problem = *static_cast<Problem*>(user);
  // The fixed-point iteration takes a stop for one step's failure: it is said until CVODE believes it.
  if (problem.cancelled) return kStop;
  if (problem.evaluations++ % kLook == 0 && !problem.progress(t / problem.seconds, "solving the reference")) {
    problem.cancelled = true;
    return kStop;
  }
  problem.acceleration.Place(t, Half(y, 0), Half(y, 1));
  Half(derivative, 0) = Half(y, 1);
  problem.acceleration.Evaluate(Half(derivative, 1));
  return Half(derivative, 1).allFinite() ? 0 : kRetry;
}

// What CVODE calls an outcome; the name is ours to free.
std::string OutcomeName(int outcome) {
  const std::unique_ptr<char, decltype(&std::free)> name(CVodeGetReturnFlagName(outcome), &std::free);
  return name == nullptr ? "unknown" : name.get();
}

// CVODE's parts, freed in the opposite order.
class Solver {
 public:
  Solver(const Model& model, const State& start, Problem& problem, double tolerance, double omega) : problem_(problem) {
    SUNContext_Create(nullptr, &context_);
    const auto n = static_cast<Eigen::Index>(problem.acceleration.free().size());
    y_ = N_VNew_Serial(6 * n, context_);
    scale_ = N_VNew_Serial(6 * n, context_);
    // CVODE holds the root mean square of all errors: with 1/sqrt(n) none of them is above the tolerance.
    const double each = tolerance / std::sqrt(6.0 * static_cast<double>(n));
    Half(scale_, 0).setConstant(each);
    Half(scale_, 1).setConstant(each * std::clamp(omega, 1.0, kFastest));
    for (Eigen::Index i = 0; i < n; ++i) {
      const int vertex = problem.acceleration.free()[static_cast<size_t>(i)];
      Half(y_, 0).col(i) = start.x.col(vertex) - model.rest.col(vertex);
      Half(y_, 1).col(i) = start.v.col(vertex);
    }
    cvode_ = CVodeCreate(CV_ADAMS, context_);
    iteration_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
    ok_ = CVodeInit(cvode_, &Evaluate, 0, y_) == CV_SUCCESS && CVodeSVtolerances(cvode_, each, scale_) == CV_SUCCESS &&
          CVodeSetUserData(cvode_, &problem_) == CV_SUCCESS &&
          CVodeSetNonlinearSolver(cvode_, iteration_) == CV_SUCCESS &&
          CVodeSetMaxNumSteps(cvode_, 1'000'000'000) == CV_SUCCESS &&
          CVodeSetErrHandlerFn(
              cvode_, [](int, const char*, const char*, char*, void*) {}, nullptr) == CV_SUCCESS;
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  ~Solver() {
    CVodeFree(&cvode_);
    SUNNonlinSolFree(iteration_);
    N_VDestroy(scale_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  // The state at `time`, which is later than the last one.
  absl::StatusOr<State> Reach(double time) {
    realtype reached = 0;
    CVodeSetStopTime(cvode_, time);
    const int outcome = ok_ ? CVode(cvode_, time, y_, &reached, CV_NORMAL) : CV_MEM_FAIL;
    if (problem_.cancelled) return Cancelled();
    if (outcome < 0) {
      return absl::AbortedError(absl::StrFormat(
          "the reference found no next step at %.4g s (CVODE: %s): shorten the study, or raise the tolerance", reached,
          OutcomeName(outcome)));
    }
    return problem_.acceleration.Place(time, Half(y_, 0), Half(y_, 1));
  }

 private:
  Problem& problem_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr, scale_ = nullptr;
  SUNNonlinearSolver iteration_ = nullptr;
  void* cvode_ = nullptr;
  bool ok_ = false;
};

}  // namespace

absl::StatusOr<Trajectory> SolveReference(const Subject& subject, const std::vector<double>& moments, double tolerance,
                                          const Progress& progress, v1::Reference& report) {
  return SolveReferenceFrom(subject, subject.model->InitialState(), moments, tolerance, progress, report);
}

absl::StatusOr<Trajectory> SolveReferenceFrom(const Subject& subject, const State& start,
                                              const std::vector<double>& moments, double tolerance,
                                              const Progress& progress, v1::Reference& report) {
  const double began = ThreadCpuSeconds();
  auto acceleration = Acceleration::Make(subject);
  if (!acceleration.ok()) return acceleration.status();
  if (acceleration->free().empty()) return absl::FailedPreconditionError("no vertex of the scene moves by forces");
  const double omega = LargestStableStep(*subject.model, subject.parameters).omega_max();
  Problem problem{.acceleration = *std::move(acceleration), .progress = progress, .seconds = moments.back()};
  Solver solver(*subject.model, start, problem, tolerance, omega);
  Trajectory trajectory;
  for (const double moment : moments) {
    auto state = solver.Reach(moment);
    if (!state.ok()) return state.status();
    trajectory.states.push_back(*std::move(state));
  }
  trajectory.simulated_s = moments.back();
  trajectory.cpu_s = ThreadCpuSeconds() - began;
  report.set_method("CVODE, Adams-Moulton of variable order");
  report.set_tolerance_m(tolerance);
  report.set_evaluations(problem.evaluations);
  report.set_cpu_s(trajectory.cpu_s);
  report.set_largest_displacement_mm(1e3 * LargestWay(*subject.model, trajectory));
  return trajectory;
}

absl::StatusOr<Trajectory> ConfirmedReference(const Subject& subject, const std::vector<double>& moments,
                                              double tolerance, const Progress& progress, v1::Reference& report) {
  v1::Reference first;
  const auto coarse = SolveReference(subject, moments, tolerance, Part(progress, 0, 0.4), first);
  if (!coarse.ok()) return coarse.status();
  auto fine = SolveReference(subject, moments, 0.1 * tolerance, Part(progress, 0.4, 1), report);
  if (!fine.ok()) return fine.status();
  const Distance apart = DistanceBetween(subject, *coarse, *fine);
  report.set_tolerance_m(tolerance);
  report.set_error_max_mm(1e3 * apart.largest);
  report.set_error_rms_mm(1e3 * apart.rms);
  report.set_cpu_s(first.cpu_s() + report.cpu_s());
  report.set_evaluations(first.evaluations() + report.evaluations());
  return fine;
}

}  // namespace phrenic::study
