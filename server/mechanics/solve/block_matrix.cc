#include "server/mechanics/solve/block_matrix.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "server/mechanics/damping.h"
#include "server/mesh/bucket_sort.h"

namespace phrenic {
namespace {

// Records which blocks forces add to.
class Pattern final : public StiffnessSink {
 public:
  explicit Pattern(bool springs) : springs_(springs) {}
  void Add(int i, int j, const Eigen::Matrix3d&) override { places.emplace_back(i, j); }
  void AddSprings(std::span<const SpringStiffness> springs) override {
    if (!springs_) return;
    for (const auto& [a, b, edge, axial, transverse] : springs) {
      places.insert(places.end(), {{a, b}, {b, a}});
    }
  }
  void AddOuter(double, const Points&) override {}

  std::vector<std::pair<int, int>> places;

 private:
  const bool springs_;
};

}  // namespace

BlockMatrix::BlockMatrix(const Model& model, Springs springs) {
  Pattern pattern(springs == Springs::kWithin);
  const int n = static_cast<int>(model.rest.cols());
  for (int i = 0; springs == Springs::kWithin && i < n; ++i) pattern.places.emplace_back(i, i);
  const State rest = model.InitialState();
  const EvalContext at = MakeEvalContext(model, model.parameters, rest);
  for (const auto& force : model.forces) {
    force->AddStiffness(at, pattern);
    if (springs == Springs::kElsewhere) force->AddLatentStiffness(at, pattern);
  }
  BucketSort(pattern.places, n, [](const std::pair<int, int>& place) { return place.first; });
  pattern.places.erase(std::unique(pattern.places.begin(), pattern.places.end()), pattern.places.end());
  first_.assign(static_cast<size_t>(n) + 1, 0);
  diagonal_.assign(n, -1);
  for (const auto& [i, j] : pattern.places) {
    if (i == j) diagonal_[i] = static_cast<int>(columns_.size());
    columns_.push_back(j);
    ++first_[i + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  blocks_.assign(columns_.size(), Eigen::Matrix3d::Zero());
}

void BlockMatrix::Assemble(const Model& model, const EvalContext& at, double viscosity) {
  std::fill(blocks_.begin(), blocks_.end(), Eigen::Matrix3d::Zero());
  extra_.clear();
  outer_.Clear();
  for (const auto& force : model.forces) {
    force->AddStiffness(at, *this);
    if (viscosity > 0) AddViscosity(*force, at, viscosity, *this);
  }
}

void BlockMatrix::Add(int i, int j, const Eigen::Matrix3d& block) {
  const auto begin = columns_.begin() + first_[i], end = columns_.begin() + first_[i + 1];
  const bool known = i == j && diagonal_[i] >= 0;
  const auto place = known ? columns_.begin() + diagonal_[i] : std::lower_bound(begin, end, j);
  if (place != end && *place == j) {
    blocks_[place - columns_.begin()] += block;
  } else {
    extra_.push_back({i, j, block});
  }
}

void BlockMatrix::Times(const ConstPoints& x, MutablePoints y) const {
  for (int i = 0; i < vertices(); ++i) {
    double sum[3] = {};
    for (int k = first_[i]; k < first_[i + 1]; ++k) {
      const double* const b = blocks_[k].data();
      const double* const from = x.data() + 3 * static_cast<std::ptrdiff_t>(columns_[k]);
      for (int r = 0; r < 3; ++r) sum[r] += b[r] * from[0] + b[3 + r] * from[1] + b[6 + r] * from[2];
    }
    y.col(i) = Eigen::Vector3d(sum);
  }
  for (const Extra& extra : extra_) y.col(extra.i) += extra.block * x.col(extra.j);
  outer_.AddTimes(1, x, y);
}

Eigen::SparseMatrix<double> BlockMatrix::ToSparse() const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * (blocks_.size() + extra_.size()));
  const auto add = [&entries](int i, int j, const Eigen::Matrix3d& block) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) entries.emplace_back(3 * i + r, 3 * j + c, block(r, c));
    }
  };
  ForEachBlock(add);
  for (const Extra& extra : extra_) add(extra.i, extra.j, extra.block);
  Eigen::SparseMatrix<double> sparse(3L * vertices(), 3L * vertices());
  sparse.setFromTriplets(entries.begin(), entries.end());
  return sparse;
}

}  // namespace phrenic
