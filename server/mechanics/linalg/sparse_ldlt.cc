#include "server/mechanics/linalg/sparse_ldlt.h"

#include <Eigen/OrderingMethods>
#include <algorithm>

namespace phrenic {
namespace {

// An entry of a row below the diagonal.
struct RowEntry {
  int column;
  double value;
};

}  // namespace

std::vector<int> SparseLdlt::Order(int size, const std::vector<std::pair<int, int>>& below) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<size_t>(size) + 2 * below.size());
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1);
  for (const auto& [i, j] : below) {
    entries.emplace_back(i, j, 1);
    entries.emplace_back(j, i, 1);
  }
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  return {order.indices().begin(), order.indices().end()};
}

SparseLdlt::SparseLdlt(int size, const std::vector<std::pair<int, int>>& below, std::size_t most)
    : size_(size), first_below_(static_cast<size_t>(size) + 1, 0) {
  for (const auto& [i, j] : below) {
    ++first_below_[static_cast<size_t>(i) + 1];
    below_columns_.push_back(j);
  }
  for (size_t i = 0; i < static_cast<size_t>(size); ++i) first_below_[i + 1] += first_below_[i];
  FindRows(most);
  if (complete_) PlaceColumns();
}

// The elimination tree: the first row below the diagonal that is not zero in each column of L.
std::vector<int> SparseLdlt::Parents() const {
  std::vector<int> parent(static_cast<size_t>(size_), -1), ancestor(parent);
  for (int k = 0; k < size_; ++k) {
    for (int p = first_below_[k]; p < first_below_[k + 1]; ++p) {
      for (int j = below_columns_[p]; j != -1 && j < k;) {
        const int next = ancestor[j];
        ancestor[j] = k;
        if (next == -1) parent[j] = k;
        j = next;
      }
    }
  }
  return parent;
}

// Row k of L: all that lies on the paths of the tree from the entries of row k of A to k.
void SparseLdlt::FindRows(std::size_t most) {
  const std::vector<int> parent = Parents();
  std::vector<int> seen(static_cast<size_t>(size_), -1), row;
  first_in_row_.assign(1, 0);
  for (int k = 0; k < size_; ++k) {
    row.clear();
    seen[k] = k;
    for (int p = first_below_[k]; p < first_below_[k + 1]; ++p) {
      for (int j = below_columns_[p]; seen[j] != k; j = parent[j]) {
        seen[j] = k;
        row.push_back(j);
      }
    }
    std::sort(row.begin(), row.end());
    if (places_.size() + row.size() > most) {
      complete_ = false;
      places_ = {};
      return;
    }
    for (const int j : row) places_.push_back({j, 0});
    first_in_row_.push_back(static_cast<int>(places_.size()));
  }
}

void SparseLdlt::PlaceColumns() {
  first_in_column_.assign(static_cast<size_t>(size_) + 1, 0);
  for (const Place& place : places_) ++first_in_column_[place.column + 1];
  for (int j = 0; j < size_; ++j) first_in_column_[j + 1] += first_in_column_[j];
  std::vector<int> next = first_in_column_;
  rows_.resize(places_.size());
  for (int k = 0; k < size_; ++k) {
    for (int p = first_in_row_[k]; p < first_in_row_[k + 1]; ++p) {
      places_[p].at = next[places_[p].column]++;
      rows_[places_[p].at] = k;
    }
  }
}

int SparseLdlt::Factorise(const Eigen::VectorXd& diagonal, const std::vector<double>& values, Factors& factors,
                          double vanishes) const {
  if (factors.lower.size() < places_.size()) factors.lower.resize(places_.size());
  if (factors.row.size() < size_) {
    factors.row.resize(size_);
    factors.inverse_pivot.resize(size_);
  }
  double* const row = factors.row.data();
  std::fill(row, row + size_, 0.0);
  int left_out = 0;
  for (int k = 0; k < size_; ++k) {
    for (int p = first_below_[k]; p < first_below_[k + 1]; ++p) row[below_columns_[p]] = values[p];
    double pivot = diagonal[k];
    for (int p = first_in_row_[k]; p < first_in_row_[k + 1]; ++p) {
      const auto [j, at] = places_[p];
      const double y = row[j];
      row[j] = 0;
      for (int q = first_in_column_[j]; q < at; ++q) row[rows_[q]] -= factors.lower[q] * y;
      factors.lower[at] = y * factors.inverse_pivot[j];
      pivot -= factors.lower[at] * y;
    }
    const bool independent = pivot > vanishes * diagonal[k];
    factors.inverse_pivot[k] = independent ? 1 / pivot : 0;
    left_out += !independent;
  }
  return left_out;
}

void SparseLdlt::Solve(const Factors& factors, Eigen::VectorXd& x) const {
  for (int j = 0; j < size_; ++j) {
    for (int q = first_in_column_[j]; q < first_in_column_[j + 1]; ++q) x[rows_[q]] -= factors.lower[q] * x[j];
  }
  for (int j = 0; j < size_; ++j) x[j] *= factors.inverse_pivot[j];
  for (int j = size_ - 1; j >= 0; --j) {
    for (int q = first_in_column_[j]; q < first_in_column_[j + 1]; ++q) x[j] -= factors.lower[q] * x[rows_[q]];
  }
}

void SparseLdlt::Solve(const Factors& factors, Points& x) const {
  for (int j = 0; j < size_; ++j) {
    const Eigen::Vector3d solved = x.col(j);
    for (int q = first_in_column_[j]; q < first_in_column_[j + 1]; ++q) x.col(rows_[q]) -= factors.lower[q] * solved;
  }
  for (int j = size_ - 1; j >= 0; --j) {
    Eigen::Vector3d sum = factors.inverse_pivot[j] * x.col(j);
    for (int q = first_in_column_[j]; q < first_in_column_[j + 1]; ++q) sum -= factors.lower[q] * x.col(rows_[q]);
    x.col(j) = sum;
  }
}

bool OrderedLdlt::Factorise(const Eigen::SparseMatrix<double>& a) {
  const auto size = static_cast<int>(a.cols());
  std::vector<std::pair<int, int>> below;
  const auto for_each_below = [&](const auto& visit) {
    for (int j = 0; j < size; ++j) {
      for (Eigen::SparseMatrix<double>::InnerIterator entry(a, j); entry; ++entry) {
        if (entry.row() > j) visit(static_cast<int>(entry.row()), j, entry.value());
      }
    }
  };
  for_each_below([&](int i, int j, double) { below.emplace_back(i, j); });
  const std::vector<int> order = SparseLdlt::Order(size, below);
  row_.resize(static_cast<size_t>(size));
  for (int k = 0; k < size; ++k) row_[order[k]] = k;
  std::vector<std::vector<RowEntry>> rows(static_cast<size_t>(size));
  for_each_below([&](int i, int j, double value) {
    rows[std::max(row_[i], row_[j])].push_back({std::min(row_[i], row_[j]), value});
  });
  std::vector<double> values;
  below.clear();
  for (int i = 0; i < size; ++i) {
    std::sort(rows[i].begin(), rows[i].end(), [](const RowEntry& p, const RowEntry& q) { return p.column < q.column; });
    for (const RowEntry& entry : rows[i]) {
      below.emplace_back(i, entry.column);
      values.push_back(entry.value);
    }
  }
  Eigen::VectorXd diagonal(size);
  const Eigen::VectorXd unordered = a.diagonal();
  for (int i = 0; i < size; ++i) diagonal[row_[i]] = unordered[i];
  pattern_ = SparseLdlt(size, below);
  return pattern_.Factorise(diagonal, values, factors_, 0) == 0;
}

void OrderedLdlt::Solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  Eigen::VectorXd ordered(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) ordered[row_[i]] = b[i];
  pattern_.Solve(factors_, ordered);
  x.resize(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = ordered[row_[i]];
}

}  // namespace phrenic
