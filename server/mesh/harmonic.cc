#include "server/mesh/harmonic.h"

#include <Eigen/Geometry>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <cstdint>

namespace phrenic {
namespace {

constexpr double kAnchor =
    1e-12;  // added to the diagonal, so that components without a boundary value are not singular

// Of the factorisation: some ten seconds, and 400 MB. A surface of n vertices takes about 10 n^1.5 and 8 n log2 n.
constexpr std::int64_t kMostOperations = 20'000'000'000, kMostEntries = 30'000'000;

using Entries = std::vector<Eigen::Triplet<double>>;
using Sparse = Eigen::SparseMatrix<double>;

// True if the Cholesky factor of the matrix takes more than that, in the order that the solver takes:
// follows the elimination tree row by row (T. Davis, Direct Methods for Sparse Linear Systems, SIAM 2006, chapter 4).
bool FillsUp(const Sparse& matrix) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(matrix, order);
  const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> place = order.inverse();
  Sparse upper(matrix.rows(), matrix.cols());
  upper.selfadjointView<Eigen::Upper>() = matrix.selfadjointView<Eigen::Lower>().twistedBy(place);
  std::vector<int> parent(static_cast<std::size_t>(matrix.rows()), -1), seen(parent);
  std::vector<std::int64_t> in_column(parent.size(), 0);
  std::int64_t entries = 0, operations = 0;  // a column of c entries takes c^2
  for (int k = 0; k < matrix.cols(); ++k) {
    seen[k] = k;
    for (Sparse::InnerIterator above(upper, k); above; ++above) {
      for (int i = static_cast<int>(above.index()); i < k && seen[i] != k; i = parent[i]) {
        if (parent[i] == -1) parent[i] = k;
        seen[i] = k;
        operations += 2 * in_column[static_cast<std::size_t>(i)]++ + 1;
        if (++entries > kMostEntries || operations > kMostOperations) return true;
      }
    }
  }
  return false;
}

// Adds a triangle's part of the cotangent Laplacian: each edge weighs cot(angle opposite) / 2.
void AddTriangle(const Mesh& mesh, const Eigen::Vector3i& corner, Entries& entries) {
  for (int k = 0; k < 3; ++k) {
    const int a = corner[k], b = corner[(k + 1) % 3], opposite = corner[(k + 2) % 3];
    const Eigen::Vector3d to_a = mesh.vertices.col(a) - mesh.vertices.col(opposite);
    const Eigen::Vector3d to_b = mesh.vertices.col(b) - mesh.vertices.col(opposite);
    const double twice_area = to_a.cross(to_b).norm();
    if (twice_area == 0) return;
    const double weight = 0.5 * to_a.dot(to_b) / twice_area;
    entries.emplace_back(a, a, weight), entries.emplace_back(b, b, weight);
    entries.emplace_back(a, b, -weight), entries.emplace_back(b, a, -weight);
  }
}

}  // namespace

absl::StatusOr<Eigen::VectorXd> HarmonicBetween(const Mesh& mesh, const std::vector<bool>& zero,
                                                const std::vector<bool>& one) {
  const Eigen::Index n = mesh.vertices.cols();
  Entries entries;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) AddTriangle(mesh, mesh.triangles.col(t), entries);
  Eigen::VectorXd value = Eigen::VectorXd::Zero(n), load = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) value[i] = one[i] ? 1 : 0;
  Entries free;
  const auto held = [&](Eigen::Index i) { return zero[i] || one[i]; };
  for (Eigen::Index i = 0; i < n; ++i) free.emplace_back(i, i, held(i) ? 1 : kAnchor);
  for (const auto& entry : entries) {
    if (held(entry.row())) continue;
    if (held(entry.col())) load[entry.row()] -= entry.value() * value[entry.col()];
    if (!held(entry.col())) free.push_back(entry);
  }
  Eigen::SparseMatrix<double> laplacian(n, n);
  laplacian.setFromTriplets(free.begin(), free.end());
  if (FillsUp(laplacian)) {
    return absl::InvalidArgumentError(
        "Laplace's equation on the surface takes too much work: make the mesh coarser, and without triangles that "
        "join "
        "distant vertices");
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(laplacian);
  if (solver.info() != Eigen::Success) {
    return absl::InvalidArgumentError(
        "Laplace's equation has no solution on the surface: its cotangent matrix cannot be factorised");
  }
  for (Eigen::Index i = 0; i < n; ++i) load[i] = held(i) ? value[i] : load[i];
  value = solver.solve(load);
  if (!value.allFinite()) {
    return absl::InvalidArgumentError(
        "Laplace's equation has no solution on the surface: its cotangent matrix cannot be factorised");
  }
  return value;
}

}  // namespace phrenic
