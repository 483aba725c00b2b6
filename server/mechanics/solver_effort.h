// The limits and the result of the linear solves of a step.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVER_EFFORT_H_
#define PHRENIC_SERVER_MECHANICS_SOLVER_EFFORT_H_

#include <algorithm>
#include <chrono>
#include <limits>

namespace phrenic {

// Belongs to the last step. With a time limit, results depend on the speed of the machine. Not thread-safe.
class SolverEffort {
 public:
  // Begins a step. Solves end when `budget` [s] of wall time is spent, unless it is 0, and each after
  // `most_iterations`.
  void Begin(double budget, int most_iterations = std::numeric_limits<int>::max()) {
    most_iterations_ = most_iterations;
    limited_ = budget > 0;
    if (limited_) deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(budget));
    iterations_ = 0;
    residual_ = 0;
  }
  bool limited() const { return limited_; }
  bool Spent() const { return limited_ && Clock::now() >= deadline_; }
  int most_iterations() const { return most_iterations_; }
  // Adds a solve: its iterations, 0 for a factorisation, and its relative residual in the preconditioner's norm.
  void Note(int iterations, double residual) {
    iterations_ += iterations;
    residual_ = std::max(residual_, residual);
  }
  // The iterations of conjugate gradients in the whole step.
  int iterations() const { return iterations_; }
  // The largest relative residual of the step.
  double residual() const { return residual_; }

 private:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  bool limited_ = false;
  int most_iterations_ = std::numeric_limits<int>::max();
  Clock::time_point deadline_;
  int iterations_ = 0;
  double residual_ = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVER_EFFORT_H_
