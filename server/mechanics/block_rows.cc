#include "server/mechanics/block_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/mechanics/advance.h"
#include "server/mesh/bucket_sort.h"
#include "server/mesh/locality.h"

namespace phrenic {
namespace {

// Rows that may change places to lie beside others of their length: more pads less and is less local.
constexpr size_t kRowWindow = 256;
// Ends of blocks this many vertices apart, on the mean, no longer meet in a core's cache.
constexpr double kEndsFarApart = 8192;

using CallPairs = std::vector<std::pair<int, int>>;

// Notes the blocks off the diagonal in the order in which they come, i < j.
class Recorder final : public StiffnessSink {
 public:
  void Add(int i, int j, const Eigen::Matrix3d&) override {
    if (i >= j) return;
    pairs.emplace_back(i, j);
    springs_only = false;
  }
  void AddSprings(std::span<const SpringStiffness> springs) override {
    for (const auto& spring : springs) pairs.push_back(std::minmax(spring.a, spring.b));
  }
  void AddOuter(double, const Points&) override {}

  CallPairs pairs;
  bool springs_only = true;
};

// The symmetric part of a block, as entries have it.
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

// A spring's stiffness in single precision.
struct SpringPart {
  float x, y, z, axial, transverse;

  explicit SpringPart(const SpringStiffness& spring)
      : x(static_cast<float>(spring.edge[0])),
        y(static_cast<float>(spring.edge[1])),
        z(static_cast<float>(spring.edge[2])),
        axial(static_cast<float>(spring.axial)),
        transverse(static_cast<float>(spring.transverse)) {}
  // To the symmetric part of a block.
  void AddTo(float sign, Quad* entry) const {
    const float by_x = sign * axial * x, by_y = sign * axial * y, t = sign * transverse;
    entry[0].at[0] += by_x * x + t, entry[0].at[1] += by_x * y, entry[0].at[2] += by_x * z;
    entry[0].at[3] += by_y * y + t;
    entry[1].at[0] += by_y * z, entry[1].at[1] += sign * axial * z * z + t;
  }
  // To v and t of a pair, which may have those of another spring already: along the same edge.
  void AddAlong(Quad* entry) const {
    float* const v = entry->at;
    const float before = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    const float root = std::sqrt(before > 0 ? axial + before / (x * x + y * y + z * z) : axial);
    v[0] = root * x, v[1] = root * y, v[2] = root * z;
    v[3] += transverse;
  }
};

void AddTurning(const Eigen::Matrix3d& block, Quad* entry) {
  const Eigen::Matrix3f b = block.cast<float>() / 2;
  entry[1].at[2] += b(2, 1) - b(1, 2);
  entry[1].at[3] += b(0, 2) - b(2, 0);
  entry[2].at[0] += b(1, 0) - b(0, 1);
}

}  // namespace

BlockRows::BlockRows(const Model& model) : row_(model.rest.cols(), -1) {
  NoteCalls(model);
  for (int i = 0; i < static_cast<int>(row_.size()); ++i) {
    if (model.inverse_mass[i] > 0) vertices_.push_back(i);
  }
  PlaceRows(static_cast<int>(row_.size()));
  PlaceBlocks();
}

void BlockRows::NoteCalls(const Model& model) {
  Recorder recorder;
  const State rest = model.InitialState();
  const Instant at = MakeInstant(model, model.parameters, rest);
  for (const auto& force : model.forces) {
    first_call_.push_back(calls_.size());
    recorder.pairs.clear();
    force->AddStiffness(at, recorder);
    for (const auto& [i, j] : recorder.pairs) {
      if (model.inverse_mass[i] > 0 && model.inverse_mass[j] > 0) calls_.push_back({i, j, 0});
    }
  }
  springs_only_ = recorder.springs_only;
  known_ = calls_;
  BucketSort(known_, static_cast<int>(row_.size()), [](const Call& call) { return call.i; });
  known_.erase(std::unique(known_.begin(), known_.end()), known_.end());
  const int quads = springs_only_ ? 1 : 3;
  for (size_t k = 0; k < known_.size(); ++k) known_[k].place = quads * static_cast<int>(k + 1);
  for (Call& call : calls_) call.place = std::lower_bound(known_.begin(), known_.end(), call)->place;
  entries_.resize(quads * (known_.size() + 1));
}

// Vertices as they come, unless what a block joins is too far apart for that; by their number of blocks in windows.
void BlockRows::PlaceRows(int vertices) {
  Edges edges(2, static_cast<Eigen::Index>(known_.size()));
  std::vector<int> degree(vertices, 0);
  for (size_t k = 0; k < known_.size(); ++k) {
    edges.col(static_cast<Eigen::Index>(k)) << known_[k].i, known_[k].j;
    ++degree[known_[k].i], ++degree[known_[k].j];
  }
  const double apart = known_.empty() ? 0 : (edges.row(1) - edges.row(0)).cast<double>().mean();
  if (apart > kEndsFarApart) {
    const auto joined = [&degree](int i) { return degree[i] > 0; };
    vertices_.erase(std::remove_if(vertices_.begin(), vertices_.end(), joined), vertices_.end());
    const std::vector<int> local = LocalOrder(edges, vertices);
    vertices_.insert(vertices_.begin(), local.begin(), local.end());
  }
  const auto longer = [&degree](int a, int b) { return degree[a] > degree[b]; };
  for (size_t first = 0; first < vertices_.size(); first += kRowWindow) {
    const size_t end = std::min(first + kRowWindow, vertices_.size());
    std::stable_sort(vertices_.begin() + static_cast<std::ptrdiff_t>(first),
                     vertices_.begin() + static_cast<std::ptrdiff_t>(end), longer);
  }
  for (size_t r = 0; r < vertices_.size(); ++r) row_[vertices_[r]] = static_cast<int>(r);
}

void BlockRows::PlaceBlocks() {
  const size_t slices = (vertices_.size() + kSliceLanes - 1) / kSliceLanes, rows = slices * kSliceLanes;
  struct Seen {
    int row, entry;
  };
  std::vector<std::vector<Seen>> seen(rows);  // what each row has
  for (const Call& call : known_) {
    seen[row_[call.i]].push_back({row_[call.j], 2 * call.place});
    seen[row_[call.j]].push_back({row_[call.i], 2 * call.place + 1});
  }
  slices_.values = springs_only_ ? kSpringValues : 9;
  slices_.first_column.push_back(0);
  for (size_t first = 0; first < rows; first += kSliceLanes) {
    size_t width = 0;
    for (size_t lane = 0; lane < kSliceLanes; ++lane) width = std::max(width, seen[first + lane].size());
    for (size_t c = 0; c < width; ++c) {
      LanePlaces& neighbours = slices_.neighbours.emplace_back();
      LanePlaces& entries = slices_.entries.emplace_back();
      for (size_t lane = 0; lane < kSliceLanes; ++lane) {
        const std::vector<Seen>& row = seen[first + lane];
        neighbours.at[lane] = 4 * (c < row.size() ? row[c].row : static_cast<int>(first + lane));
        entries.at[lane] = c < row.size() ? row[c].entry : 0;
      }
    }
    slices_.first_column.push_back(static_cast<std::int64_t>(slices_.neighbours.size()));
  }
  slices_.blocks.resize(slices_.values * slices_.neighbours.size());
  slices_.scale.resize(slices);
  for (std::vector<Lanes>* each : {&slices_.diagonal, &slices_.stiffness, &slices_.factors}) each->resize(6 * slices);
  inertia_.resize(slices);
  diagonal_.resize(2 * rows);
  direction_.resize(rows);
}

void BlockRows::Assemble(const Model& model, const Instant& at, double g, const Eigen::VectorXd& inertia) {
  g_ = g;
  std::fill(entries_.begin(), entries_.end(), Quad());
  std::fill(diagonal_.begin(), diagonal_.end(), Quad());
  extra_.clear();
  outer_.Clear();
  for (size_t f = 0; f < model.forces.size(); ++f) {
    next_ = first_call_[f];
    model.forces[f]->AddStiffness(at, *this);
  }
  SumSharedDamping(model, at, shared_);
  for (size_t r = 0; r < vertices_.size(); ++r) {
    inertia_[r / kSliceLanes].at[r % kSliceLanes] = static_cast<float>(inertia[vertices_[r]]);
  }
  const auto weight = static_cast<float>(g * g);
  FillDiagonal(diagonal_, entries_, inertia_, weight, slices_, direction_.data());
  FillBlocks(entries_, weight, direction_.data(), slices_);
}

// Where block (i, j) is kept, i < j: most often the one that came next at rest. Null where it is not.
Quad* BlockRows::Find(int i, int j) {
  if (next_ < calls_.size() && calls_[next_].i == i && calls_[next_].j == j) {
    return entries_.data() + calls_[next_++].place;
  }
  const Call wanted{i, j, 0};
  const auto found = std::lower_bound(known_.begin(), known_.end(), wanted);
  return found != known_.end() && *found == wanted ? entries_.data() + found->place : nullptr;
}

void BlockRows::Add(int i, int j, const Eigen::Matrix3d& block) {
  if (i > j || row_[i] < 0 || row_[j] < 0) return;  // (j, i) is its transpose
  if (i == j) return SymmetricPart(block).AddTo(diagonal_.data() + 2 * static_cast<std::ptrdiff_t>(row_[i]));
  Quad* const entry = springs_only_ ? nullptr : Find(i, j);
  if (entry == nullptr) return extra_.push_back({i, j, block});
  SymmetricPart(block).AddTo(entry);
  AddTurning(block, entry);
}

void BlockRows::AddSprings(std::span<const SpringStiffness> springs) {
  for (const SpringStiffness& spring : springs) {
    const std::ptrdiff_t row_a = row_[spring.a], row_b = row_[spring.b];
    const bool both = row_a >= 0 && row_b >= 0;
    const auto [i, j] = std::minmax(spring.a, spring.b);
    Quad* const entry = both ? Find(i, j) : nullptr;
    const SpringPart part(spring);
    if (entry != nullptr && springs_only_) {
      part.AddAlong(entry);
      continue;
    }
    if (row_a >= 0) part.AddTo(1, diagonal_.data() + 2 * row_a);
    if (row_b >= 0) part.AddTo(1, diagonal_.data() + 2 * row_b);
    if (entry != nullptr) part.AddTo(-1, entry);
    if (both && entry == nullptr) extra_.push_back({i, j, -spring.Block()});
  }
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

void BlockRows::AddDisplacements(double factor, const RowVector& y, Points& displacements) const {
  for (size_t row = 0; row < vertices_.size(); ++row) {
    const size_t slice = row / kSliceLanes, lane = row % kSliceLanes;
    const double scale = factor * slices_.scale[slice].at[lane];
    double* const to = displacements.data() + 3 * static_cast<std::ptrdiff_t>(vertices_[row]);
    for (int k = 0; k < kAxes; ++k) to[k] += scale * static_cast<double>(y[kAxes * slice + k].at[lane]);
  }
}

}  // namespace phrenic
