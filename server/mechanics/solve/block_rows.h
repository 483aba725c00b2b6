// The matrix of implicit steps by vertex, in single precision, in the layout of linalg/block_kernel.h: conjugate
// gradients multiply by it.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_ROWS_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_ROWS_H_

#include <span>
#include <vector>

#include "server/mechanics/linalg/block_kernel.h"
#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/model.h"
#include "server/mechanics/solve/translations.h"

namespace phrenic {

// A = inertia + g^2 K + g S on the free vertices of a model, S the shared damping. The pattern, and the order in which
// forces add blocks, are those of the model at rest; blocks that appear later (contacts) and outer products are kept
// apart, which is slower. The blocks of springs are computed in the layout: a force that adds a list of springs at rest
// always adds the same list. Not thread-safe.
class BlockRows final : public StiffnessSink {
 public:
  explicit BlockRows(const Model& model);

  // Sets A at this moment; `inertia` is one per vertex [kg], g in [s]. Allocates only for blocks outside the pattern.
  void Assemble(const Model& model, const EvalContext& at, double g, const Eigen::VectorXd& inertia);

  void Add(int i, int j, const Eigen::Matrix3d& block) override;
  void AddSpringsAt(std::span<const Spring> springs, const EvalContext& at) override;
  void AddOuter(double scale, const Points& g) override { outer_.Add(scale, g); }

  // Sets the search direction p, scaled as BlockSlices: first to z, then as phrenic::Turn does.
  void Face(const RowVector& z) { Pack(z, direction_.data()); }
  void Turn(float along, float keep, const RowVector& z, RowVector& y) {
    phrenic::Turn(along, keep, z, y, direction_.data());
  }
  // Sets q = A p, with or without the inertia, scaled in the same way. Returns p . q.
  double Times(bool inertia, RowVector& q);
  const BlockSlices& slices() const { return slices_; }
  // Returns the diagonal block of A of a vertex, without blocks that appeared later and outer products; 0 if it does
  // not move.
  Eigen::Matrix3d Diagonal(int vertex) const;
  // Corrects y so that A y has the sum of b over each part that nothing holds. `inertia` and g are those of Assemble.
  void KeepSums(const Points& b, const Eigen::VectorXd& inertia, Points& y) {
    translations_.Correct(b, inertia, g_, outer_, shared_, y);
  }
  size_t row_lanes() const { return kAxes * slices_.size(); }
  OuterProducts& shared_damping() { return shared_; }

  // Sets b = factor s forces; adds factor s y to `displacements`; sets y = displacements/s. Points are 3 x vertices of
  // the model, rows are its free vertices.
  void ForcesToRows(double factor, const Points& forces, RowVector& b) const;
  void AddDisplacements(double factor, const RowVector& y, Points& displacements) const;
  void DisplacementsToRows(const Points& displacements, RowVector& y) const;
  // Sets forces = b/s; 0 for vertices that do not move.
  void RowsToForces(const RowVector& b, Points& forces) const;

 private:
  struct Call {
    int i, j;   // i < j, both free
    int place;  // index into entries_
    bool operator==(const Call& other) const { return i == other.i && j == other.j; }
    bool operator<(const Call& other) const { return i != other.i ? i < other.i : j < other.j; }
  };
  struct Extra {
    int i, j;
    Eigen::Matrix3d block;
  };
  void NoteCalls(const Model& model);
  void PlaceRows();
  void PlaceSprings();
  void PlaceBlocks();
  void MakeRoom();
  void PlaceAll(const ConstPoints& x);
  Quad* Find(int i, int j);
  void AddBeside(RowVector& q);

  std::vector<std::span<const Spring>> springs_;  // in the order of their columns
  std::vector<int> row_;                          // of each vertex; -1 if it does not move
  std::vector<int> vertices_;                     // of each row
  std::vector<int> held_;           // vertices that do not move, with springs to some that do: rows after the slices
  std::vector<Call> calls_;         // in the order in which forces add blocks at rest
  std::vector<Call> known_;         // each block once, sorted
  std::vector<size_t> first_call_;  // of each force
  size_t next_ = 0;                 // index into calls_ while forces add
  double g_ = 0;
  BlockEntries entries_, diagonal_;  // empty if there are only springs
  std::vector<Extra> extra_;
  OuterProducts outer_, shared_;
  Translations translations_;
  BlockSlices slices_;
  std::vector<Lanes> inertia_;
  std::vector<Position> positions_;  // of each row
  std::vector<Quad> direction_;      // of each row; while A is assembled, its scale
  Points beside_x_, beside_y_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_ROWS_H_
