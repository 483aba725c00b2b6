// L-BFGS: a fixed matrix A for the true one, corrected by what the steps so far have shown (Nocedal, Math Comput
// 1980;35:773; with the matrix of projective dynamics: Liu, Bouaziz, Kavan, ACM Trans Graph 2017;36:23).
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_QUASI_NEWTON_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_QUASI_NEWTON_H_

#include <vector>

#include "server/mechanics/solve/prefactored_system.h"

namespace phrenic {

// Not thread-safe.
class QuasiNewton {
 public:
  // Forgets all steps, and has room for `most`. Allocates where it had not.
  void Restart(int vertices, int most);
  // The residual went from `before` to `after` over this step; all 3 x n. A step along which it did not fall says
  // nothing of a positive definite matrix, and is left out, as is one for which there is no room.
  void Note(const Points& step, const Points& before, const Points& after);
  // y = B r, B symmetric and positive definite: A^-1 where nothing is noted, and by the steps noted what they showed.
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
