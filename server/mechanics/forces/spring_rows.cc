#include "server/mechanics/forces/spring_rows.h"

#include <algorithm>

#include "server/mesh/locality.h"

namespace phrenic {
namespace {

// Ends of springs this many vertices apart, on the mean, no longer meet in a core's cache.
constexpr double kFarApart = 8192;

// One end of a spring as its row sees it; vertices by their places.
struct RowSpring {
  int other = 0;
  double stiffness = 0, rest_length = 0;
};
using Rows = std::vector<std::vector<RowSpring>>;  // a place

// The order that the springs' vertices are to be taken in: none, as they come, which reads and writes them in one go,
// unless what a spring joins is too far apart for that.
std::vector<int> OrderOf(const std::vector<Spring>& springs, int vertices) {
  if (springs.empty()) return {};
  Edges edges(2, static_cast<Eigen::Index>(springs.size()));
  for (size_t s = 0; s < springs.size(); ++s) edges.col(static_cast<Eigen::Index>(s)) << springs[s].a, springs[s].b;
  const double apart = (edges.row(1) - edges.row(0)).cwiseAbs().cast<double>().mean();
  return apart > kFarApart ? LocalOrder(edges, vertices) : std::vector<int>();
}

Rows ByPlace(const std::vector<Spring>& springs, const std::vector<int>& order, int vertices) {
  std::vector<int> place(vertices);
  for (int i = 0; i < vertices; ++i) place[i] = i;
  for (size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
  Rows rows(order.empty() ? vertices : order.size());
  for (const Spring& spring : springs) {
    rows[place[spring.a]].push_back({place[spring.b], spring.stiffness, spring.rest_length});
    rows[place[spring.b]].push_back({place[spring.a], spring.stiffness, spring.rest_length});
  }
  return rows;
}

// The block's rows that have springs, longest first.
std::vector<int> SortedBlock(const Rows& rows, size_t first) {
  std::vector<int> block;
  for (size_t i = first; i < std::min(first + kVertexBlock, rows.size()); ++i) {
    if (!rows[i].empty()) block.push_back(static_cast<int>(i));
  }
  std::stable_sort(block.begin(), block.end(), [&rows](int a, int b) { return rows[a].size() > rows[b].size(); });
  return block;
}

bool Alike(const std::vector<Spring>& springs) {
  return std::all_of(springs.begin(), springs.end(),
                     [&springs](const Spring& spring) { return spring.stiffness == springs.front().stiffness; });
}

// Appends the slice of `count` rows, the longest first. What they lack to a whole slice, and to the longest, is filled
// up with springs to themselves.
void AppendSlice(const Rows& rows, const int* members, int count, SpringSlices& slices) {
  SpringSlice& slice = slices.slices.back();
  slice.rows = count;
  const size_t first = slices.columns.size(), width = rows[members[0]].size();
  slices.columns.resize(first + width);
  slices.neighbours.resize(first + width);
  if (slices.common_stiffness == 0) slices.stiffness.resize(first + width);
  const int last = static_cast<int>(rows.size()) - 1;
  for (int i = 0; i < kSliceRows; ++i) {
    const int own = members[i < count ? i : 0];
    slice.own[i] = 3 * own;
    slice.at_end = slice.at_end || own == last;
    for (size_t c = 0; c < width; ++c) {
      const bool padding = i >= count || c >= rows[own].size();
      const RowSpring spring = padding ? RowSpring{own, 0, 0} : rows[own][c];
      slice.at_end = slice.at_end || spring.other == last;
      slices.neighbours[first + c].place[i] = 3 * spring.other;
      slices.columns[first + c].at_rest[i] = spring.stiffness * spring.rest_length;
      if (slices.common_stiffness == 0) slices.stiffness[first + c].k[i] = spring.stiffness;
    }
  }
  slices.slices.push_back({.first_column = static_cast<std::int64_t>(slices.columns.size())});
}

void AppendBlock(const Rows& rows, const std::vector<int>& block, SpringSlices& slices) {
  for (size_t i = 0; i < block.size(); i += kSliceRows) {
    AppendSlice(rows, &block[i], static_cast<int>(std::min<size_t>(kSliceRows, block.size() - i)), slices);
  }
}

}  // namespace

SpringRows::SpringRows(const std::vector<Spring>& springs, int vertices) : order_(OrderOf(springs, vertices)) {
  const Rows rows = ByPlace(springs, order_, vertices);
  if (!springs.empty() && Alike(springs)) slices_.common_stiffness = springs.front().stiffness;
  slices_.slices.emplace_back();
  for (size_t first = 0; first < rows.size(); first += kVertexBlock) {
    first_slice_.push_back(static_cast<std::int64_t>(slices_.slices.size()) - 1);
    AppendBlock(rows, SortedBlock(rows, first), slices_);
  }
  first_slice_.push_back(static_cast<std::int64_t>(slices_.slices.size()) - 1);
}

void SpringRows::SetLoad(const Points& load) {
  slices_.load.assign(slices_.slices.size() - 1, {});
  for (size_t s = 0; s < slices_.load.size(); ++s) {
    for (int i = 0; i < slices_.slices[s].rows; ++i) {
      const int place = slices_.slices[s].own[i] / 3;
      const int vertex = order_.empty() ? place : order_[place];
      SliceLoad& slice = slices_.load[s];
      slice.x[i] = load(0, vertex), slice.y[i] = load(1, vertex), slice.z[i] = load(2, vertex);
    }
  }
}

void SpringRows::AddForce(double scale, const ConstPoints& x, MutablePoints f) const {
  const auto slices = static_cast<std::int64_t>(slices_.slices.size()) - 1;
  if (order_.empty()) return AddSlices(slices_, 0, slices, scale, x.data(), f.data());
  thread_local Points in_order, in_order_force;
  const auto count = static_cast<Eigen::Index>(order_.size());
  if (in_order.cols() < count) in_order.resize(3, count), in_order_force.resize(3, count);
  Points &ordered = in_order, &force = in_order_force;  // this thread's own, for all that help it
  ForEachBlock({0, count}, [&](const VertexRange& block) {
    for (Eigen::Index i = block.first; i < block.end; ++i) ordered.col(i) = x.col(order_[i]);
  });
  ForEachBlock({0, count}, [&](const VertexRange& block) {
    force.middleCols(block.first, block.end - block.first).setZero();
    AddSlices(slices_, FirstSlice(block.first), FirstSlice(block.end), scale, ordered.data(), force.data());
    for (Eigen::Index i = block.first; i < block.end; ++i) f.col(order_[i]) += force.col(i);
  });
}

void SpringRows::AddForce(const VertexRange& range, double scale, const ConstPoints& x, MutablePoints f) const {
  AddSlices(slices_, FirstSlice(range.first), FirstSlice(range.end), scale, x.data(), f.data());
}

}  // namespace phrenic
