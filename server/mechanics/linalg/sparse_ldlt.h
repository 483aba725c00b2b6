// The factorisation A = L D L^T of a sparse symmetric positive semi-definite matrix with a constant pattern.
//
// The pattern of L is found once, so that factorising and solving allocate nothing. A row with a vanishing pivot
// depends on the rows before it and is left out: its unknown is 0 (redundant links). Up-looking, as in T. Davis, Direct
// Methods for Sparse Linear Systems, SIAM 2006, chapter 4.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_SPARSE_LDLT_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_SPARSE_LDLT_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <utility>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Immutable and thread-safe; each thread has Factors of its own.
class SparseLdlt {
 public:
  // The values of one factorised matrix.
  struct Factors {
    std::vector<double> lower;  // values of L
    Eigen::VectorXd inverse_pivot, row;
  };

  static constexpr std::size_t kMostEntries = std::size_t{1} << 30;
  // A smaller pivot, relative to the diagonal, is that of a redundant row.
  static constexpr double kVanishes = 1e-11;

  SparseLdlt() = default;
  // `below` are the indices (i, j), j < i, of the entries that may be non-zero, each once, sorted. If L has more than
  // `most` entries below the diagonal, the object is not complete() and must not be used.
  SparseLdlt(int size, const std::vector<std::pair<int, int>>& below, std::size_t most = kMostEntries);
  bool complete() const { return complete_; }

  // Returns an order of rows that keeps L sparse (approximate minimum degree): the old index of each new row.
  static std::vector<int> Order(int size, const std::vector<std::pair<int, int>>& below);

  // Factorises the matrix with this `diagonal`, of length size, and these `values` of the entries of `below`. Leaves
  // out rows with a pivot of at most `vanishes` times the diagonal, or NaN. Returns the number of rows left out.
  int Factorise(const Eigen::VectorXd& diagonal, const std::vector<double>& values, Factors& factors,
                double vanishes = kVanishes) const;
  // Replaces x by A^-1 x.
  void Solve(const Factors& factors, Eigen::VectorXd& x) const;
  // The same for three right-hand sides at once, the rows of x: 3 x size.
  void Solve(const Factors& factors, Points& x) const;
  int size() const { return size_; }

 private:
  struct Place {
    int column, at;  // `at` in rows_ and Factors::lower
  };
  std::vector<int> Parents() const;
  void FindRows(std::size_t most);
  void PlaceColumns();

  int size_ = 0;
  bool complete_ = true;
  std::vector<int> first_below_, below_columns_;  // of A, row by row
  std::vector<int> first_in_row_;                 // of L, in places_
  std::vector<Place> places_;                     // of L, row by row, columns ascending
  std::vector<int> first_in_column_, rows_;       // of L, column by column, rows ascending
};

// The factorisation of a matrix that is positive definite, in an order that keeps L sparse. Not thread-safe.
class OrderedLdlt {
 public:
  // Factorises A, of which it reads the lower triangle. Returns false if A is not positive definite or not finite.
  // Allocates.
  bool Factorise(const Eigen::SparseMatrix<double>& a);
  // Sets x = A^-1 b. Requires: Factorise returned true.
  void Solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

 private:
  std::vector<int> row_;  // of each unknown in the order of elimination
  SparseLdlt pattern_;
  SparseLdlt::Factors factors_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_SPARSE_LDLT_H_
