// Minimum of a sum of squares within bounds, by Gauss and Newton's method with Levenberg's damping.
//
// Each step minimises the local quadratic within the bounds exactly, by an active set (Nocedal and Wright, Numerical
// Optimization, 2006, section 16.5): numbers at a bound whose descent points outwards are left out, and the others go
// where they would go without these. A step that is taken in full and clamped afterwards stops at wrong points.
#ifndef PHRENIC_SERVER_CALIBRATE_BOUNDED_DESCENT_H_
#define PHRENIC_SERVER_CALIBRATE_BOUNDED_DESCENT_H_

#include <Eigen/Core>

#include "absl/status/statusor.h"

namespace phrenic::calibrate {

// Half the curvature and half the descending gradient at a place.
struct Quadratic {
  Eigen::MatrixXd curvature;  // symmetric, positive definite
  Eigen::VectorXd descent;
};

// Returns the step s that minimises s'Cs - 2 d's, low <= s <= high. Requires low <= 0 <= high.
Eigen::VectorXd StepWithin(const Quadratic& at, const Eigen::VectorXd& low, const Eigen::VectorXd& high);

// A sum of squares of numbers, each in units of its prior's standard deviation.
class SquaresProblem {
 public:
  virtual ~SquaresProblem() = default;

  // Returns the sum at x. FAILED_PRECONDITION if it has none there; other errors end the search.
  virtual absl::StatusOr<double> Try(const Eigen::VectorXd& x) = 0;
  // Makes what was tried last the place.
  virtual void Accept() = 0;
  // Returns the quadratic at the place.
  virtual absl::StatusOr<Quadratic> Expand() = 0;
};

enum class Settling {
  kGoesOn,   // the place has moved
  kSettled,  // the next step is too small to matter
  kStuck     // no step that was tried, each shorter, gave a lower sum
};

// The search's place. Not thread-safe.
class BoundedDescent {
 public:
  // Requires finite low <= x <= high, and that the problem's place is x, with this sum.
  BoundedDescent(SquaresProblem& problem, Eigen::VectorXd x, double sum, Eigen::VectorXd low, Eigen::VectorXd high);

  // Moves to a lower sum. The problem's errors other than FAILED_PRECONDITION of a trial.
  absl::StatusOr<Settling> Step();

  const Eigen::VectorXd& x() const { return x_; }
  const Quadratic& quadratic() const { return at_; }  // of the last expansion
  int without_sum() const { return without_sum_; }    // trials of the last step that had none
  absl::Status Expand();

 private:
  // Returns the next step at a damping, no number's larger than 1.5.
  Eigen::VectorXd Proposed(double damping) const;
  // Returns true if the sum at x is lower, and goes there.
  absl::StatusOr<bool> Lowers(const Eigen::VectorXd& x);

  SquaresProblem& problem_;
  Eigen::VectorXd x_;
  double sum_;
  const Eigen::VectorXd low_, high_;
  Quadratic at_;
  double damping_ = 0;
  int without_sum_ = 0;
};

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_BOUNDED_DESCENT_H_
