// A = L D L^T of a sparse symmetric positive semi-definite matrix whose pattern never changes: the pattern of L is
// found once, so that factorising and solving allocate nothing. Where a pivot vanishes, the row depends on the ones
// before and is left out: the solution found has 0 there (redundant links). Up-looking, as in T. Davis, Direct Methods
// for Sparse Linear Systems, SIAM 2006, chapter 4.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_SPARSE_LDLT_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_SPARSE_LDLT_H_

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Immutable; any number of threads may call, each with factors of its own.
class SparseLdlt {
 public:
  // The numbers of one matrix, of any size so far.
  struct Factors {
    std::vector<double> lower;  // values of L
    Eigen::VectorXd inverse_pivot, row;
  };

  SparseLdlt() = default;
  // `below` are the places (i, j), j < i, that may not be zero, each once, sorted.
  SparseLdlt(int size, const std::vector<std::pair<int, int>>& below);

  // An order of rows that keeps L sparse (approximate minimum degree): the old index of each new one.
  static std::vector<int> Order(int size, const std::vector<std::pair<int, int>>& below);

  // `diagonal` of length size, `values` of the places below it in their order.
  void Factorise(const Eigen::VectorXd& diagonal, const std::vector<double>& values, Factors& factors) const;
  // x becomes A^-1 x.
  void Solve(const Factors& factors, Eigen::VectorXd& x) const;
  // The same for three right sides at once, one a row of x: 3 x size.
  void Solve(const Factors& factors, Points& x) const;
  int size() const { return size_; }

 private:
  struct Place {
    int column, at;  // `at` in rows_ and Factors::lower
  };
  std::vector<int> Parents() const;
  void FindRows();
  void PlaceColumns();

  int size_ = 0;
  std::vector<int> first_below_, below_columns_;  // of A, row by row
  std::vector<int> first_in_row_;                 // of L, in places_
  std::vector<Place> places_;                     // of L, row by row, columns ascending
  std::vector<int> first_in_column_, rows_;       // of L, column by column, rows ascending
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_SPARSE_LDLT_H_
