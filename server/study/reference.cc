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

constexpr double kMaxVelocityRatio = 10;  // largest ratio of the tolerances of velocities and positions [1/s]
constexpr double kScalarRatio = 10;       // of the tolerances of scalars, in their SI unit, and positions [unit/m]
constexpr int kStop = -1;                 // CVODE: unrecoverable error
constexpr int kRetry = 1;                 // CVODE: recoverable error, retry with a smaller step

// State shared by the right-hand side and the solver.
struct Problem {
  Acceleration acceleration;
  const Progress& progress;
  double seconds;
  std::int64_t evaluations = 0;
  bool cancelled = false;
};

// The unknowns y: positions and velocities of n vertices, then scalars.
Eigen::Index VerticesOf(const Acceleration& acceleration) {
  return static_cast<Eigen::Index>(acceleration.free().size());
}

// The positions (half 0) or velocities (half 1), 3 x n.
Eigen::Map<Points> Half(const Problem& problem, N_Vector y, int half) {
  const Eigen::Index n = VerticesOf(problem.acceleration);
  return {N_VGetArrayPointer(y) + 3 * n * half, 3, n};
}

Eigen::Map<Eigen::VectorXd> Scalars(const Problem& problem, N_Vector y) {
  return {N_VGetArrayPointer(y) + 6 * VerticesOf(problem.acceleration),
          static_cast<Eigen::Index>(problem.acceleration.scalars().size())};
}

const State& SetState(Problem& problem, double t, N_Vector y) {
  return problem.acceleration.SetState(t, Half(problem, y, 0), Half(problem, y, 1), Scalars(problem, y));
}

int Evaluate(realtype t, N_Vector y, N_Vector derivative, void* user) {
  Problem& problem = *static_cast<Problem*>(user);
  // CVODE's fixed-point iteration treats a stop as a failed step and calls again, so every further call stops too.
  if (problem.cancelled) return kStop;
  if (problem.evaluations++ % kCheckInterval == 0 && !problem.progress(t / problem.seconds, "solving the reference")) {
    problem.cancelled = true;
    return kStop;
  }
  SetState(problem, t, y);
  Half(problem, derivative, 0) = Half(problem, y, 1);
  problem.acceleration.Evaluate(Half(problem, derivative, 1), Scalars(problem, derivative));
  return Half(problem, derivative, 1).allFinite() && Scalars(problem, derivative).allFinite() ? 0 : kRetry;
}

// CVODE's name of a return code. The caller owns the C string that CVODE returns.
std::string OutcomeName(int outcome) {
  const std::unique_ptr<char, decltype(&std::free)> name(CVodeGetReturnFlagName(outcome), &std::free);
  return name == nullptr ? "unknown" : name.get();
}

// Owns the objects of CVODE and frees them in reverse order.
class Solver {
 public:
  Solver(const Model& model, const State& start, Problem& problem, double tolerance, double omega) : problem_(problem) {
    SUNContext_Create(nullptr, &context_);
    const Acceleration& acceleration = problem.acceleration;
    const auto unknowns = static_cast<Eigen::Index>(6 * acceleration.free().size() + acceleration.scalars().size());
    y_ = N_VNew_Serial(unknowns, context_);
    scale_ = N_VNew_Serial(unknowns, context_);
    // CVODE bounds the RMS of all errors: divided by the root of their number, it bounds each of them by the tolerance.
    const double each = tolerance / std::sqrt(static_cast<double>(unknowns));
    Half(problem, scale_, 0).setConstant(each);
    Half(problem, scale_, 1).setConstant(each * std::clamp(omega, 1.0, kMaxVelocityRatio));
    Scalars(problem, scale_).setConstant(each * kScalarRatio);
    Start(model, start);
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

  // Integrates to `time` and returns the state. Requires: `time` is later than in the last call.
  absl::StatusOr<State> Reach(double time) {
    realtype reached = 0;
    CVodeSetStopTime(cvode_, time);
    const int outcome = ok_ ? CVode(cvode_, time, y_, &reached, CV_NORMAL) : CV_MEM_FAIL;
    if (problem_.cancelled) return Cancelled();
    if (outcome < 0) {
      return absl::AbortedError(
          absl::StrFormat("the reference solver failed at %.4g s (CVODE: %s): shorten the study or raise the tolerance",
                          reached, OutcomeName(outcome)));
    }
    return SetState(problem_, time, y_);
  }

 private:
  void Start(const Model& model, const State& start) {
    const Acceleration& acceleration = problem_.acceleration;
    for (Eigen::Index i = 0; i < VerticesOf(acceleration); ++i) {
      const int vertex = acceleration.free()[static_cast<size_t>(i)];
      Half(problem_, y_, 0).col(i) = start.x.col(vertex) - model.rest.col(vertex);
      Half(problem_, y_, 1).col(i) = start.v.col(vertex);
    }
    for (size_t i = 0; i < acceleration.scalars().size(); ++i) {
      Scalars(problem_, y_)[static_cast<Eigen::Index>(i)] = start.scalars.q[acceleration.scalars()[i]];
    }
  }

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
  if (acceleration->free().empty()) return absl::FailedPreconditionError("the scene has no vertex that forces move");
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
  report.set_largest_displacement_mm(1e3 * LargestDisplacement(*subject.model, trajectory));
  return trajectory;
}

absl::StatusOr<Trajectory> ConfirmedReference(const Subject& subject, const std::vector<double>& moments,
                                              double tolerance, const Progress& progress, v1::Reference& report) {
  v1::Reference first;
  const auto coarse = SolveReference(subject, moments, tolerance, Part(progress, 0, 0.4), first);
  if (!coarse.ok()) return coarse.status();
  auto fine = SolveReference(subject, moments, 0.1 * tolerance, Part(progress, 0.4, 1), report);
  if (!fine.ok()) return fine.status();
  const Distance error = DistanceBetween(subject, *coarse, *fine);
  report.set_tolerance_m(tolerance);
  report.set_error_max_mm(1e3 * error.largest);
  report.set_error_rms_mm(1e3 * error.rms);
  report.set_cpu_s(first.cpu_s() + report.cpu_s());
  report.set_evaluations(first.evaluations() + report.evaluations());
  return fine;
}

}  // namespace phrenic::study
