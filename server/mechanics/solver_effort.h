// What the linear systems of a step may take, and what they came to.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVER_EFFORT_H_
#define PHRENIC_SERVER_MECHANICS_SOLVER_EFFORT_H_

#include <algorithm>
#include <chrono>
#include <limits>

namespace phrenic {

// Of the step that was taken last. With a budget a run depends on the machine's speed. For one thread.
class SolverEffort {
 public:
  // A step begins; its systems are given up once `budget` [s] is spent, wall time, where that is not 0, and each after
  // so many iterations.
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
  // A system was solved: what is left over what there was, in the preconditioner's norm; 0 iterations where it was
  // factorised.
  void Note(int iterations, double residual) {
    iterations_ += iterations;
    residual_ = std::max(residual_, residual);
  }
  // Of conjugate gradients, over the whole step; 0 where there were none.
  int iterations() const { return iterations_; }
  // The largest of the step's systems.
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
