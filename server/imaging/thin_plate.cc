#include "server/imaging/thin_plate.h"

#include <vector>

namespace phrenic::imaging {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

constexpr double kLeastWeight = 1e-9;

// Returns the five-point Laplacian at interior nodes, and second differences along the grid's edges.
Sparse Laplacian(const PlateGrid& grid) {
  Entries entries;
  const int right = grid.columns - 1, top = grid.rows - 1;
  for (int j = 0; j <= top; ++j) {
    for (int i = 0; i <= right; ++i) {
      const int at = grid.Index(i, j);
      const auto along = [&](int before, int after) {
        entries.emplace_back(at, at, -2);
        entries.emplace_back(at, before, 1);
        entries.emplace_back(at, after, 1);
      };
      const int before = i > 0 ? i - 1 : right, after = i < right ? i + 1 : 0;
      if (grid.around || (i > 0 && i < right)) along(grid.Index(before, j), grid.Index(after, j));
      if (j > 0 && j < top) along(grid.Index(i, j - 1), grid.Index(i, j + 1));
    }
  }
  Sparse laplacian(grid.nodes(), grid.nodes());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

// Returns the differences between neighbours in a column.
Sparse DifferencesAlong(const PlateGrid& grid) {
  Entries entries;
  for (int at = 0; at + grid.columns < grid.nodes(); ++at) {
    entries.emplace_back(at, at, -1);
    entries.emplace_back(at, at + grid.columns, 1);
  }
  Sparse differences(grid.nodes(), grid.nodes());
  differences.setFromTriplets(entries.begin(), entries.end());
  return differences;
}

}  // namespace

ThinPlate::ThinPlate(const PlateGrid& grid, double bending, double tension) {
  const Sparse laplacian = Laplacian(grid);
  stiffness_ = bending * Sparse(laplacian.transpose()) * laplacian;
  if (tension == 0) return;
  const Sparse differences = DifferencesAlong(grid);
  stiffness_ += tension * Sparse(differences.transpose()) * differences;
}

Eigen::VectorXd ThinPlate::Fit(const Eigen::VectorXd& weights, const Eigen::VectorXd& observed) {
  Sparse system = stiffness_;
  system.diagonal() += (weights.array() + kLeastWeight).matrix();
  if (!analysed_) solver_.analyzePattern(system);
  analysed_ = true;
  solver_.factorize(system);
  return solver_.solve(weights.cwiseProduct(observed));
}

std::array<double, 4> SplineWeights(double t) {
  const double u = 1 - t;
  return {u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * u * u * u - 6 * u * u + 4) / 6, t * t * t / 6};
}

}  // namespace phrenic::imaging
