// What is timed: models of the generated diaphragm, the thorax, and nets of rigid links.
#ifndef PHRENIC_TESTS_BENCH_SUBJECTS_H_
#define PHRENIC_TESTS_BENCH_SUBJECTS_H_

#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/forces/spring_rows.h"
#include "server/mechanics/solve/implicit_system.h"

namespace phrenic::bench {

inline constexpr double kFrame = 1.0 / 60;  // [s]

using ModelPointer = std::shared_ptr<const Model>;

// A session that is stepped: it goes on from one repetition to the next.
struct Run {
  ModelPointer model;
  v1::Parameters parameters;
  State state;
  Workspace work;
  absl::Status status;  // of the step that failed, if one did

  explicit Run(ModelPointer of);
  void Step();
};

// Conjugate gradients on a model's stiffness for steps of a frame, always as many iterations.
class Solver {
 public:
  static constexpr int kIterations = 25;
  explicit Solver(ModelPointer model);
  void Solve();

 private:
  ModelPointer model_;
  State state_;
  ImplicitSystem system_;
  Points b_, y_;
  SolverEffort effort_;
};

struct Subjects {
  MeshSource meshes;  // makes each once
  ModelPointer springs, single_springs, membrane, muscle, thorax, thesis, few_links, many_links;
};

absl::StatusOr<Subjects> MakeSubjects();

// The springs of the first body, as an array.
std::vector<Spring> SpringsOf(const Model& model);

// The same springs of vertices that are numbered otherwise, along a curve through space, as one's own mesh may be:
// hardly two follow each other whose neighbours do.
struct Renumbered {
  Renumbered(const std::vector<Spring>& springs, const Points& x);
  std::vector<Spring> springs;
  Points x;
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_SUBJECTS_H_
