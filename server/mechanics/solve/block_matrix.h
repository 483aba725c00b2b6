// The stiffness of a whole model as a sparse matrix of 3 x 3 blocks: assembled once, multiplied many times.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_MATRIX_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_MATRIX_H_

#include <Eigen/SparseCore>
#include <vector>

#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/model.h"

namespace phrenic {

// K, 3n x 3n, symmetric. Not thread-safe. Where a block lies is found once, from the model at rest; a block that turns
// up later (a contact) is kept beside, more slowly.
class BlockMatrix final : public StiffnessSink {
 public:
  // Whether springs have blocks. Where they have not, the diagonal has only those of vertices on which others act.
  enum class Springs { kWithin, kElsewhere };
  // The pattern of every force of the model at rest, and on the diagonal; values zero.
  explicit BlockMatrix(const Model& model, Springs springs = Springs::kWithin);

  // K = the stiffness of the model's forces at this instant. Allocates only for blocks that are new to the pattern.
  void Assemble(const Model& model, const EvalContext& at);

  void Add(int i, int j, const Eigen::Matrix3d& block) override;
  void AddOuter(double scale, const Points& g) override { outer_.Add(scale, g); }

  // y = K x, both 3 x n.
  void Times(const ConstPoints& x, MutablePoints y) const;
  // The block on the diagonal of vertex i, outer products left out; with springs within.
  Eigen::Matrix3d Diagonal(int i) const { return blocks_[diagonal_[i]]; }
  // Calls f(i, j, block) for every block whose place was known at rest, row by row, columns ascending.
  template <typename F>
  void ForEachBlock(F f) const {
    for (int i = 0; i < vertices(); ++i) {
      for (int k = first_[i]; k < first_[i + 1]; ++k) f(i, columns_[k], blocks_[k]);
    }
  }
  // K as scalars, for factorisations; outer products left out.
  Eigen::SparseMatrix<double> ToSparse() const;
  OuterProducts& outer() { return outer_; }
  int vertices() const { return static_cast<int>(first_.size()) - 1; }

 private:
  struct Extra {
    int i, j;
    Eigen::Matrix3d block;
  };

  std::vector<int> first_;     // of row i in columns_ and blocks_; n + 1 of them
  std::vector<int> columns_;   // ascending in each row
  std::vector<int> diagonal_;  // place of block (i, i); -1 where there is none
  std::vector<Eigen::Matrix3d> blocks_;
  std::vector<Extra> extra_;
  OuterProducts outer_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_MATRIX_H_
