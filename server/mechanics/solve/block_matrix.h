// The stiffness of a model as a sparse matrix of 3 x 3 blocks, for factorisations and for repeated products.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_MATRIX_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_MATRIX_H_

#include <Eigen/SparseCore>
#include <vector>

#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/model.h"

namespace phrenic {

// K, 3n x 3n, symmetric. The pattern is that of the model at rest; blocks that appear later (contacts) are kept apart,
// which is slower. Not thread-safe.
class BlockMatrix final : public StiffnessSink {
 public:
  // Whether springs have blocks. If not, the diagonal has only those of vertices on which other forces act.
  enum class Springs { kWithin, kElsewhere };
  // Makes the pattern of all forces of the model at rest, and the diagonal; values are zero.
  explicit BlockMatrix(const Model& model, Springs springs = Springs::kWithin);

  // Sets K to the stiffness of the model's forces at this moment, plus `viscosity` [1/s] times their viscosity.
  // Allocates only for blocks outside the pattern.
  void Assemble(const Model& model, const EvalContext& at, double viscosity = 0);

  void Add(int i, int j, const Eigen::Matrix3d& block) override;
  void AddOuter(double scale, const Points& g) override { outer_.Add(scale, g); }

  // Sets y = K x, both 3 x n.
  void Times(const ConstPoints& x, MutablePoints y) const;
  // Returns the diagonal block of vertex i, without outer products. Requires: Springs::kWithin.
  Eigen::Matrix3d Diagonal(int i) const { return blocks_[diagonal_[i]]; }
  // Calls f(i, j, block) for every block of the pattern, row by row, columns ascending.
  template <typename F>
  void ForEachBlock(F f) const {
    for (int i = 0; i < vertices(); ++i) {
      for (int k = first_[i]; k < first_[i + 1]; ++k) f(i, columns_[k], blocks_[k]);
    }
  }
  // Returns K as scalars, for factorisations, without outer products.
  Eigen::SparseMatrix<double> ToSparse() const;
  OuterProducts& outer() { return outer_; }
  int vertices() const { return static_cast<int>(first_.size()) - 1; }

 private:
  struct Extra {
    int i, j;
    Eigen::Matrix3d block;
  };

  std::vector<int> first_;     // index of row i in columns_ and blocks_; n + 1 of them
  std::vector<int> columns_;   // ascending in each row
  std::vector<int> diagonal_;  // index of block (i, i); -1 if there is none
  std::vector<Eigen::Matrix3d> blocks_;
  std::vector<Extra> extra_;
  OuterProducts outer_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_BLOCK_MATRIX_H_
