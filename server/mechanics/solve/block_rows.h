// The stiffness of a whole model gathered by vertex in single precision, laid out for the machine: what conjugate
// gradients multiply by.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_ROWS_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_ROWS_H_

#include <span>
#include <vector>

#include "server/mechanics/linalg/block_kernel.h"
#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/model.h"

namespace phrenic {

// A = inertia + g^2 K + g S on the free vertices of a model, S the shared damping. Not thread-safe. Where a block lies
// is found once, from the model at rest, as is the order in which forces hand blocks over; a block that turns up later
// (a contact) is kept beside, more slowly, as are outer products. Springs' blocks are worked out where they lie: a
// force that hands over a list of springs at rest hands over that list always.
class BlockRows final : public StiffnessSink {
 public:
  explicit BlockRows(const Model& model);

  // A at this instant; `inertia` [kg] one a vertex, g [s]. Allocates only for blocks that are new to the pattern.
  void Assemble(const Model& model, const EvalContext& at, double g, const Eigen::VectorXd& inertia);

  void Add(int i, int j, const Eigen::Matrix3d& block) override;
  void AddSpringsAt(std::span<const Spring> springs, const EvalContext& at) override;
  void AddOuter(double scale, const Points& g) override { outer_.Add(scale, g); }

  // The direction p of a search, scaled (BlockSlices): z to begin with, then as block_kernel.h turns it.
  void Face(const RowVector& z) { Pack(z, direction_.data()); }
  void Turn(float along, float keep, const RowVector& z, RowVector& y) {
    phrenic::Turn(along, keep, z, y, direction_.data());
  }
  // q = A p, or without the inertia, scaled too; p . q.
  double Times(bool inertia, RowVector& q);
  const BlockSlices& slices() const { return slices_; }
  size_t row_lanes() const { return kAxes * slices_.size(); }
  OuterProducts& shared_damping() { return shared_; }

  // b = factor s forces; displacements += factor s y, and back, y = displacements/s. Points are 3 x vertices of the
  // model; rows are its free ones.
  void ForcesToRows(double factor, const Points& forces, RowVector& b) const;
  void AddDisplacements(double factor, const RowVector& y, Points& displacements) const;
  void DisplacementsToRows(const Points& displacements, RowVector& y) const;

 private:
  struct Call {
    int i, j;   // i < j, both free
    int place;  // in entries_
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

  std::vector<std::span<const Spring>> springs_;  // whose columns are laid out
  std::vector<int> row_;                          // of each vertex; -1 where it does not move
  std::vector<int> vertices_;                     // of each row
  std::vector<int> held_;           // vertices that do not move, with springs to those that do: rows beyond the slices
  std::vector<Call> calls_;         // in the order in which forces hand blocks over at rest
  std::vector<Call> known_;         // each block once, sorted
  std::vector<size_t> first_call_;  // of each force
  size_t next_ = 0;                 // of calls_, while forces hand over
  double g_ = 0;
  BlockEntries entries_, diagonal_;  // none while nothing but springs hands over
  std::vector<Extra> extra_;
  OuterProducts outer_, shared_;
  BlockSlices slices_;
  std::vector<Lanes> inertia_;
  std::vector<Position> positions_;  // of each row
  std::vector<Quad> direction_;      // of each row; while A is assembled, its scale
  Points beside_x_, beside_y_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_ROWS_H_
