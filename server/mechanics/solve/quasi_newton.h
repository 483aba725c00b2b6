// L-BFGS: a constant matrix A in place of the true one, corrected by the differences of previous steps (Nocedal, Math
// Comput 1980;35:773; with the matrix of projective dynamics: Liu, Bouaziz, Kavan, ACM Trans Graph 2017;36:23).
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_QUASI_NEWTON_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_QUASI_NEWTON_H_

#include <vector>

#include "server/mechanics/solve/prefactored_system.h"

namespace phrenic {

// Not thread-safe.
class QuasiNewton {
 public:
  // Forgets all steps and makes room for `most`. Allocates if there was less room.
  void Restart(int vertices, int most);
  // Adds a step over which the residual changed from `before` to `after`; all 3 x n. Ignores a step along which the
  // residual did not fall, since it contradicts a positive definite matrix, and one for which there is no room.
  void Note(const Points& step, const Points& before, const Points& after);
  // Sets y = B r, B symmetric and positive definite: A^-1, corrected by the steps.
  void Times(const Points& r, PrefactoredSystem& a, Points& y);

 private:
  struct Pair {
    Points step, fall;
    double along = 0;  // step . fall
  };
  std::vector<Pair> pairs_;  // the oldest first
  size_t used_ = 0;
  std::vector<double> shares_;
  Points right_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_QUASI_NEWTON_H_
