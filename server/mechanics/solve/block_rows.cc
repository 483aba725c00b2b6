#include "server/mechanics/solve/block_rows.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "server/mechanics/damping.h"
#include "server/mesh/bucket_sort.h"
#include "server/mesh/locality.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

// Rows within which rows are sorted by their length: a larger window needs less padding and is less local.
constexpr size_t kRowWindow = 256;
constexpr int kQuads = 3;  // per off-diagonal entry

using CallPairs = std::vector<std::pair<int, int>>;

// Records lists of springs, and the off-diagonal blocks, i < j, in the order in which forces add them.
class Recorder final : public StiffnessSink {
 public:
  void Add(int i, int j, const Eigen::Matrix3d&) override {
    if (i < j) pairs.emplace_back(i, j);
  }
  void AddSpringsAt(std::span<const Spring> list, const EvalContext&) override { springs.push_back(list); }
  void AddOuter(double, const Points&) override {}

  CallPairs pairs;
  std::vector<std::span<const Spring>> springs;
};

// The symmetric part of a block in the order of entries.
class SymmetricPart {
 public:
  explicit SymmetricPart(const Eigen::Matrix3d& block) {
    const auto mean = [&block](int r, int c) { return static_cast<float>((block(r, c) + block(c, r)) / 2); };
    low_ << static_cast<float>(block(0, 0)), mean(0, 1), mean(0, 2), static_cast<float>(block(1, 1));
    high_ << mean(1, 2), static_cast<float>(block(2, 2)), 0, 0;
  }
  void AddTo(Quad* entry) const {
    Eigen::Map<Eigen::Array4f, Eigen::Aligned16>(entry[0].at) += low_;
    Eigen::Map<Eigen::Array4f, Eigen::Aligned16>(entry[1].at) += high_;
  }

 private:
  Eigen::Array4f low_, high_;
};

void AddTurning(const Eigen::Matrix3d& block, Quad* entry) {
  const Eigen::Matrix3f b = block.cast<float>() / 2;
  entry[1].at[2] += b(2, 1) - b(1, 2);
  entry[1].at[3] += b(0, 2) - b(2, 0);
  entry[2].at[0] += b(1, 0) - b(0, 1);
}

// The items that rows list, column by column of each slice; a slice has as many columns as its longest row has items.
template <typename Seen>
void LayColumns(const std::vector<std::vector<Seen>>& rows, BlockColumns& columns) {
  columns.first.push_back(0);
  for (size_t first = 0; first < rows.size(); first += kSliceLanes) {
    const size_t begin = columns.neighbours.size();
    size_t width = 0;
    for (size_t lane = 0; lane < kSliceLanes; ++lane) width = std::max(width, rows[first + lane].size());
    columns.neighbours.resize(begin + width);
    for (size_t lane = 0; lane < kSliceLanes; ++lane) {
      const std::vector<Seen>& row = rows[first + lane];
      for (size_t c = 0; c < width; ++c) {
        columns.neighbours[begin + c].at[lane] = 4 * (c < row.size() ? row[c].row : static_cast<int>(first + lane));
      }
    }
    columns.first.push_back(static_cast<std::int64_t>(columns.neighbours.size()));
  }
}

// Calls put(item, column, lane) for all items that rows list.
template <typename Seen, typename Put>
void FillColumns(const std::vector<std::vector<Seen>>& rows, const BlockColumns& columns, Put put) {
  for (size_t r = 0; r < rows.size(); ++r) {
    std::int64_t column = columns.first[r / kSliceLanes];
    for (const Seen& one : rows[r]) put(one, column++, r % kSliceLanes);
  }
}

// Returns the vertices that are ordered, in that order, then the rest.
void PutFirst(std::vector<int> order, int all, std::vector<int>& vertices) {
  std::vector<bool> taken(all, false);
  for (const int vertex : order) taken[vertex] = true;
  std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(order), [&taken](int i) { return !taken[i]; });
  vertices = std::move(order);
}

}  // namespace

BlockRows::BlockRows(const Model& model) : row_(model.rest.cols(), -1), translations_(model) {
  NoteCalls(model);
  for (int i = 0; i < static_cast<int>(row_.size()); ++i) {
    if (model.inverse_mass[i] == 0) continue;
    row_[i] = static_cast<int>(vertices_.size());
    vertices_.push_back(i);
  }
  PlaceRows();
  slices_.scale.resize((vertices_.size() + kSliceLanes - 1) / kSliceLanes);
  PlaceSprings();
  PlaceBlocks();
  MakeRoom();
}

void BlockRows::NoteCalls(const Model& model) {
  Recorder recorder;
  const State rest = model.InitialState();
  const EvalContext at = MakeEvalContext(model, model.parameters, rest);
  for (const auto& force : model.forces) {
    first_call_.push_back(calls_.size());
    recorder.pairs.clear();
    force->AddStiffness(at, recorder);
    for (const auto& [i, j] : recorder.pairs) {
      if (model.inverse_mass[i] > 0 && model.inverse_mass[j] > 0) calls_.push_back({i, j, 0});
    }
  }
  springs_ = std::move(recorder.springs);
  known_ = calls_;
  BucketSort(known_, static_cast<int>(row_.size()), [](const Call& call) { return call.i; });
  known_.erase(std::unique(known_.begin(), known_.end()), known_.end());
  for (size_t k = 0; k < known_.size(); ++k) known_[k].place = kQuads * static_cast<int>(k + 1);
  for (Call& call : calls_) call.place = std::lower_bound(known_.begin(), known_.end(), call)->place;
  if (!known_.empty()) entries_.resize(kQuads * (known_.size() + 1));
}

// Keeps the order of vertices, unless springs join vertices that are too far apart; within windows, sorts by the
// numbers of springs and of other blocks.
void BlockRows::PlaceRows() {
  std::vector<std::pair<int, int>> degree(row_.size());  // springs, other blocks
  CallPairs joined;
  for (const auto& list : springs_) {
    for (const Spring& spring : list) {
      ++degree[spring.a].first, ++degree[spring.b].first;
      if (row_[spring.a] >= 0 && row_[spring.b] >= 0) joined.emplace_back(spring.a, spring.b);
    }
  }
  for (const Call& call : known_) {
    ++degree[call.i].second, ++degree[call.j].second;
    joined.emplace_back(call.i, call.j);
  }
  const auto all = static_cast<int>(row_.size());
  PutFirst(CuthillMcKeeIfScattered(ToEdges(joined), all), all, vertices_);
  const auto longer = [&degree](int a, int b) { return degree[a] > degree[b]; };
  for (size_t first = 0; first < vertices_.size(); first += kRowWindow) {
    const size_t end = std::min(first + kRowWindow, vertices_.size());
    std::stable_sort(vertices_.begin() + static_cast<std::ptrdiff_t>(first),
                     vertices_.begin() + static_cast<std::ptrdiff_t>(end), longer);
  }
  for (size_t r = 0; r < vertices_.size(); ++r) row_[vertices_[r]] = static_cast<int>(r);
}

void BlockRows::PlaceSprings() {
  struct Seen {
    int row;
    const Spring* spring;
  };
  std::vector<std::vector<Seen>> seen(slices_.size() * kSliceLanes);
  std::vector<int> row = row_;
  const auto row_of = [&](int vertex) {
    if (row[vertex] < 0) {
      row[vertex] = static_cast<int>(seen.size() + held_.size());
      held_.push_back(vertex);
    }
    return row[vertex];
  };
  for (const auto& list : springs_) {
    for (const Spring& spring : list) {
      if (row_[spring.a] >= 0) seen[row_[spring.a]].push_back({row_of(spring.b), &spring});
      if (row_[spring.b] >= 0) seen[row_[spring.b]].push_back({row_of(spring.a), &spring});
    }
  }
  LayColumns(seen, slices_.springs);
  const size_t columns = slices_.springs.neighbours.size();
  slices_.spring_stiffness.resize(columns), slices_.spring_rest.resize(columns);
  slices_.springs.blocks.resize(kSpringValues * columns);
  FillColumns(seen, slices_.springs, [this](const Seen& one, std::int64_t column, size_t lane) {
    slices_.spring_stiffness[column].at[lane] = static_cast<float>(one.spring->stiffness);
    slices_.spring_rest[column].exact[lane] = one.spring->rest_length;
    slices_.spring_rest[column].rounded.at[lane] = static_cast<float>(one.spring->rest_length);
  });
}

void BlockRows::PlaceBlocks() {
  struct Seen {
    int row, entry;
  };
  std::vector<std::vector<Seen>> seen(slices_.size() * kSliceLanes);
  for (const Call& call : known_) {
    seen[row_[call.i]].push_back({row_[call.j], 2 * call.place});
    seen[row_[call.j]].push_back({row_[call.i], 2 * call.place + 1});
  }
  LayColumns(seen, slices_.whole);
  const size_t columns = slices_.whole.neighbours.size();
  slices_.entries.resize(columns);
  slices_.whole.blocks.resize(kWholeValues * columns);
  FillColumns(seen, slices_.whole, [this](const Seen& one, std::int64_t column, size_t lane) {
    slices_.entries[column].at[lane] = one.entry;
  });
}

void BlockRows::MakeRoom() {
  const size_t slices = slices_.size(), rows = slices * kSliceLanes;
  for (std::vector<Lanes>* each : {&slices_.diagonal, &slices_.stiffness, &slices_.factors}) each->resize(6 * slices);
  inertia_.resize(slices);
  positions_.resize(rows + held_.size());
  direction_.resize(rows + held_.size());
}

void BlockRows::Assemble(const Model& model, const EvalContext& at, double g, const Eigen::VectorXd& inertia) {
  g_ = g;
  PlaceAll(at.x);
  std::fill(entries_.begin(), entries_.end(), Quad());
  std::fill(diagonal_.begin(), diagonal_.end(), Quad());
  extra_.clear();
  outer_.Clear();
  translations_.Begin();
  for (size_t f = 0; f < model.forces.size(); ++f) {
    next_ = first_call_[f];
    model.forces[f]->AddStiffness(at, *this);
    next_ = first_call_[f];
    AddViscosity(*model.forces[f], at, 1 / g, *this);
  }
  SumSharedDamping(model, at, shared_);
  for (size_t r = 0; r < vertices_.size(); ++r) {
    inertia_[r / kSliceLanes].at[r % kSliceLanes] = static_cast<float>(inertia[vertices_[r]]);
  }
  const auto weight = static_cast<float>(g * g);
  const auto elasticity = static_cast<float>(at.parameters.elasticity());
  FillDiagonal(diagonal_, positions_, elasticity, inertia_, weight, slices_, direction_.data());
  FillBlocks(entries_, weight, direction_.data(), slices_);
}

// Sets the positions of the slices' rows and of those after them.
void BlockRows::PlaceAll(const ConstPoints& x) {
  const auto place = [&x](int vertex, Position& position) {
    const double* const from = x.data() + 3 * static_cast<std::ptrdiff_t>(vertex);
    position = {from[0], from[1], from[2], 0};
  };
  for (size_t r = 0; r < vertices_.size(); ++r) place(vertices_[r], positions_[r]);
  const size_t rows = slices_.size() * kSliceLanes;
  for (size_t h = 0; h < held_.size(); ++h) place(held_[h], positions_[rows + h]);
}

// Returns the entry of block (i, j), i < j; most often that of the next call at rest. Null if it is not in the pattern.
Quad* BlockRows::Find(int i, int j) {
  if (next_ < calls_.size() && calls_[next_].i == i && calls_[next_].j == j) {
    return entries_.data() + calls_[next_++].place;
  }
  const Call wanted{i, j, 0};
  const auto found = std::lower_bound(known_.begin(), known_.end(), wanted);
  return found != known_.end() && *found == wanted ? entries_.data() + found->place : nullptr;
}

void BlockRows::Add(int i, int j, const Eigen::Matrix3d& block) {
  if (row_[i] < 0 || row_[j] < 0) return;
  if (!translations_.empty()) translations_.Add(i, j, block);
  if (i > j) return;  // (j, i) is its transpose
  if (i == j) {
    if (diagonal_.empty()) diagonal_.resize(2 * kSliceLanes * slices_.size());
    return SymmetricPart(block).AddTo(diagonal_.data() + 2 * static_cast<std::ptrdiff_t>(row_[i]));
  }
  Quad* const entry = Find(i, j);
  if (entry == nullptr) return extra_.push_back({i, j, block});
  SymmetricPart(block).AddTo(entry);
  AddTurning(block, entry);
}

void BlockRows::AddSpringsAt(std::span<const Spring> springs, const EvalContext& at) {
  const auto same = [springs](const auto& list) { return list.data() == springs.data(); };
  if (std::none_of(springs_.begin(), springs_.end(), same)) StiffnessSink::AddSpringsAt(springs, at);
}

double BlockRows::Times(bool inertia, RowVector& q) {
  const double along = Multiply(slices_, inertia ? slices_.diagonal : slices_.stiffness, direction_.data(), q);
  if (extra_.empty() && outer_.empty() && shared_.empty()) return along;
  AddBeside(q);
  double sum = 0;
  for (size_t r = 0; r < vertices_.size(); ++r) {
    for (int k = 0; k < kAxes; ++k) {
      sum += static_cast<double>(direction_[r].at[k]) * q[kAxes * (r / kSliceLanes) + k].at[r % kSliceLanes];
    }
  }
  return sum;
}

void BlockRows::AddBeside(RowVector& q) {
  const auto vertices = static_cast<Eigen::Index>(row_.size());
  const auto scale = [this](size_t row) { return slices_.scale[row / kSliceLanes].at[row % kSliceLanes]; };
  beside_x_.setZero(3, vertices);
  beside_y_.setZero(3, vertices);
  for (size_t r = 0; r < vertices_.size(); ++r) {
    for (int k = 0; k < kAxes; ++k) beside_x_(k, vertices_[r]) = static_cast<double>(scale(r)) * direction_[r].at[k];
  }
  for (const Extra& extra : extra_) {
    beside_y_.col(extra.i) += g_ * g_ * extra.block * beside_x_.col(extra.j);
    beside_y_.col(extra.j) += g_ * g_ * extra.block.transpose() * beside_x_.col(extra.i);
  }
  outer_.AddTimes(g_ * g_, beside_x_, beside_y_);
  shared_.AddTimes(g_, beside_x_, beside_y_);
  for (size_t r = 0; r < vertices_.size(); ++r) {
    for (int k = 0; k < kAxes; ++k) {
      q[kAxes * (r / kSliceLanes) + k].at[r % kSliceLanes] += scale(r) * static_cast<float>(beside_y_(k, vertices_[r]));
    }
  }
}

void BlockRows::ForcesToRows(double factor, const Points& forces, RowVector& b) const {
  for (size_t row = 0; row < vertices_.size(); ++row) {
    const size_t slice = row / kSliceLanes, lane = row % kSliceLanes;
    const double scale = factor * slices_.scale[slice].at[lane];
    const double* const from = forces.data() + 3 * static_cast<std::ptrdiff_t>(vertices_[row]);
    for (int k = 0; k < kAxes; ++k) b[kAxes * slice + k].at[lane] = static_cast<float>(scale * from[k]);
  }
}

void BlockRows::DisplacementsToRows(const Points& displacements, RowVector& y) const {
  for (size_t row = 0; row < vertices_.size(); ++row) {
    const size_t slice = row / kSliceLanes, lane = row % kSliceLanes;
    const double scale = 1.0 / slices_.scale[slice].at[lane];
    const double* const from = displacements.data() + 3 * static_cast<std::ptrdiff_t>(vertices_[row]);
    for (int k = 0; k < kAxes; ++k) y[kAxes * slice + k].at[lane] = static_cast<float>(scale * from[k]);
  }
}

void BlockRows::RowsToForces(const RowVector& b, Points& forces) const {
  forces.setZero();
  for (size_t row = 0; row < vertices_.size(); ++row) {
    const size_t slice = row / kSliceLanes, lane = row % kSliceLanes;
    const double scale = 1.0 / slices_.scale[slice].at[lane];
    double* const to = forces.data() + 3 * static_cast<std::ptrdiff_t>(vertices_[row]);
    for (int k = 0; k < kAxes; ++k) to[k] = scale * static_cast<double>(b[kAxes * slice + k].at[lane]);
  }
}

Eigen::Matrix3d BlockRows::Diagonal(int vertex) const {
  if (row_[vertex] < 0) return Eigen::Matrix3d::Zero();
  const size_t slice = static_cast<size_t>(row_[vertex]) / kSliceLanes;
  const size_t lane = static_cast<size_t>(row_[vertex]) % kSliceLanes;
  const double scale = slices_.scale[slice].at[lane];
  const auto entry = [&](size_t k) { return slices_.diagonal[6 * slice + k].at[lane] / (scale * scale); };
  Eigen::Matrix3d block;
  block << entry(0), entry(1), entry(2), entry(1), entry(3), entry(4), entry(2), entry(4), entry(5);
  return block;
}

void BlockRows::AddDisplacements(double factor, const RowVector& y, Points& displacements) const {
  for (size_t row = 0; row < vertices_.size(); ++row) {
    const size_t slice = row / kSliceLanes, lane = row % kSliceLanes;
    const double scale = factor * slices_.scale[slice].at[lane];
    double* const to = displacements.data() + 3 * static_cast<std::ptrdiff_t>(vertices_[row]);
    for (int k = 0; k < kAxes; ++k) to[k] += scale * static_cast<double>(y[kAxes * slice + k].at[lane]);
  }
}

}  // namespace phrenic
