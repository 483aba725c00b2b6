#include "server/mechanics/forces/spring_rows.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <tuple>

#include "server/mechanics/forces/packed_points.h"
#include "server/mesh/locality.h"

namespace phrenic {
namespace {

// If more than this fraction of a block's vertices have springs, sums are added in vertex order, not in row order.
constexpr double kNearlyAll = 0.75;

// A spring in the row of one of its ends. `other` is the position of the other end in the order of the rows.
struct RowSpring {
  int other = 0;
  double stiffness = 0, rest_length = 0;
};
// Row i has the springs of[first[i]] to of[first[i + 1] - 1], sorted by the position of their other ends.
struct Rows {
  std::vector<int> first;
  LargeVector<RowSpring> of;

  int count() const { return static_cast<int>(first.size()) - 1; }
  int Size(int row) const { return first[row + 1] - first[row]; }
  const RowSpring& At(int row, int column) const { return of[first[row] + column]; }
};

// Returns the order of the rows. Empty, the order of the vertices, which needs no copies, unless springs connect
// vertices that are far apart in memory.
std::vector<int> OrderOf(const std::vector<Spring>& springs, int vertices) {
  Edges edges(2, static_cast<Eigen::Index>(springs.size()));
  for (size_t s = 0; s < springs.size(); ++s) edges.col(static_cast<Eigen::Index>(s)) << springs[s].a, springs[s].b;
  return CuthillMcKeeIfScattered(edges, vertices);
}

Rows MakeRows(const std::vector<Spring>& springs, const std::vector<int>& order, int vertices) {
  std::vector<int> position(vertices);
  for (int i = 0; i < vertices; ++i) position[i] = i;
  for (size_t i = 0; i < order.size(); ++i) position[order[i]] = static_cast<int>(i);
  Rows rows{std::vector<int>((order.empty() ? vertices : order.size()) + 1, 0),
            LargeVector<RowSpring>(2 * springs.size())};
  for (const Spring& spring : springs) ++rows.first[position[spring.a] + 1], ++rows.first[position[spring.b] + 1];
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  std::vector<int> next(rows.first.begin(), rows.first.end() - 1);
  for (const Spring& spring : springs) {
    const int a = position[spring.a], b = position[spring.b];
    rows.of[next[a]++] = {b, spring.stiffness, spring.rest_length};
    rows.of[next[b]++] = {a, spring.stiffness, spring.rest_length};
  }
  const auto key = [](const RowSpring& spring) {
    return std::tuple(spring.other, spring.stiffness, spring.rest_length);
  };
  for (int i = 0; i < rows.count(); ++i) {
    std::sort(rows.of.begin() + rows.first[i], rows.of.begin() + rows.first[i + 1],
              [key](const RowSpring& a, const RowSpring& b) { return key(a) < key(b); });
  }
  return rows;
}

// A row of a block. Both rows of a pair (GatherMode::kInPairs) are `paired`.
struct Member {
  int row = 0;
  bool paired = false;
};

// True if the next row has as many springs, whose other ends are the successors of this row's.
bool NextRowPairs(const Rows& rows, int row) {
  const int size = rows.Size(row);
  if (rows.Size(row + 1) != size) return false;
  return std::equal(&rows.At(row, 0), &rows.At(row, 0) + size, &rows.At(row + 1, 0),
                    [](const RowSpring& a, const RowSpring& b) { return a.other + 1 == b.other; });
}

// Returns the block's rows that have springs, sorted by descending length; pairs come first among equal lengths.
std::vector<Member> SortedBlock(const Rows& rows, int first) {
  std::vector<Member> block;
  block.reserve(kVertexBlock);
  const int end = std::min(first + static_cast<int>(kVertexBlock), rows.count());
  for (int row = first; row < end; ++row) {
    if (rows.Size(row) == 0) continue;
    const bool paired = row + 1 < end && NextRowPairs(rows, row);
    block.push_back({row, paired});
    if (paired) block.push_back({++row, paired});
  }
  std::stable_sort(block.begin(), block.end(), [&rows](const Member& a, const Member& b) {
    return std::pair(rows.Size(a.row), a.paired) > std::pair(rows.Size(b.row), b.paired);
  });
  return block;
}

// If all rows of a full slice are paired, reorders them for GatherMode::kInPairs and returns true.
bool OrderInPairs(std::span<Member> members, size_t rows) {
  const auto paired = [](const Member& member) { return member.paired; };
  if (members.size() != rows || !std::all_of(members.begin(), members.end(), paired)) return false;
  for (size_t first = 0; first < rows; first += 8) {
    Member consecutive[8];
    std::copy_n(members.begin() + first, 8, consecutive);
    for (size_t i = 0; i < 8; ++i) members[first + i / 2 + i % 2 * 4] = consecutive[i];
  }
  return true;
}

// True if all springs of these rows have the same stiffness.
bool IsUniform(const Rows& rows, std::span<const Member> members) {
  const double stiffness = rows.At(members.front().row, 0).stiffness;
  return std::all_of(members.begin(), members.end(), [&](const Member& member) {
    return std::all_of(&rows.At(member.row, 0), &rows.At(member.row, 0) + rows.Size(member.row),
                       [stiffness](const RowSpring& spring) { return spring.stiffness == stiffness; });
  });
}

// Loads that read beyond a point must not be used for the last point of x.
GatherMode GatherModeOf(const Rows& rows, std::span<const Member> members, bool in_pairs) {
  const int last = rows.count() - 1;
  const bool at_end = std::any_of(members.begin(), members.end(), [&](const Member& member) {
    return member.row == last || rows.At(member.row, rows.Size(member.row) - 1).other == last;
  });
  if (at_end) return GatherMode::kAtEnd;
  return in_pairs ? GatherMode::kInPairs : GatherMode::kOneByOne;
}

// Appends the slice of these rows. Requires: the first row is the longest. Missing rows and columns are padded with
// springs from a vertex to itself.
template <typename Number>
void AppendSlice(const Rows& rows, std::span<const Member> members, bool in_pairs, SpringSlices<Number>& slices) {
  SpringSlice<Number>& slice = slices.slices.back();
  slice.rows = static_cast<int>(members.size());
  slice.gather = GatherModeOf(rows, members, in_pairs);
  const size_t first = slices.at_rest.size(), first_offset = slices.offsets.size();
  const int width = rows.Size(members.front().row), offsets = slice.offsets();
  slices.at_rest.resize(first + width);
  slices.offsets.resize(first_offset + static_cast<size_t>((1 + width) * offsets));
  if (IsUniform(rows, members)) {
    slice.common_stiffness = static_cast<Number>(rows.At(members.front().row, 0).stiffness);
  } else {
    slice.first_stiffness = static_cast<std::int64_t>(slices.stiffness.size());
    slices.stiffness.resize(slices.stiffness.size() + width);
  }
  const bool paired = slice.gather == GatherMode::kInPairs;
  for (int i = 0; i < kSliceRows<Number>; ++i) {
    const int own = members[i < slice.rows ? i : 0].row;
    std::int32_t* const offset = &slices.offsets[first_offset + (paired ? PairOf(i) : i)];
    const int from = paired ? PointOfPair(i) : 0;
    offset[0] = kPointStride<Number> * (own - from);
    for (int c = 0; c < width; ++c) {
      const bool padding = i >= slice.rows || c >= rows.Size(own);
      const RowSpring spring = padding ? RowSpring{own, 0, 0} : rows.At(own, c);
      offset[(1 + c) * offsets] = kPointStride<Number> * (spring.other - from);
      slices.at_rest[first + c].row[i] = static_cast<Number>(spring.stiffness * spring.rest_length);
      if (slice.first_stiffness >= 0) {
        slices.stiffness[slice.first_stiffness + c].row[i] = static_cast<Number>(spring.stiffness);
      }
    }
  }
  slices.slices.push_back({.first_column = static_cast<std::int64_t>(slices.at_rest.size()),
                           .first_offset = static_cast<std::int64_t>(slices.offsets.size())});
}

template <typename Number>
void AppendBlock(const Rows& rows, int first, SpringSlices<Number>& slices) {
  std::vector<Member> block = SortedBlock(rows, first);
  const int vertices = std::min(static_cast<int>(kVertexBlock), rows.count() - first);
  slices.blocks.back().whole = slices.order.empty() && static_cast<double>(block.size()) > kNearlyAll * vertices;
  constexpr size_t kRows = kSliceRows<Number>;
  for (size_t i = 0; i < block.size(); i += kRows) {
    const std::span<Member> members(&block[i], std::min(kRows, block.size() - i));
    const bool in_pairs = OrderInPairs(members, kRows);
    AppendSlice<Number>(rows, members, in_pairs, slices);
    for (size_t row = 0; row < members.size(); ++row) {
      slices.slot[members[row].row] = static_cast<std::uint16_t>(SlotOf<Number>(i / kRows, static_cast<int>(row)));
    }
  }
  slices.blocks.push_back({.first_slice = static_cast<std::int64_t>(slices.slices.size()) - 1});
}

template <typename Number>
SpringSlices<Number> MakeSlices(const std::vector<Spring>& springs, int vertices) {
  SpringSlices<Number> slices;
  slices.order = OrderOf(springs, vertices);
  const Rows rows = MakeRows(springs, slices.order, vertices);
  slices.slot.assign(rows.count(), kNoSlot<Number>);
  const size_t ends = rows.of.size() + rows.of.size() / 8;  // sorted rows need little padding
  slices.at_rest.reserve(ends / kSliceRows<Number>);
  slices.offsets.reserve(ends + rows.first.size() + rows.first.size() / 8);
  slices.blocks.emplace_back();
  slices.slices.emplace_back();
  for (int first = 0; first < rows.count(); first += kVertexBlock) AppendBlock(rows, first, slices);
  return slices;
}

template <typename Number>
void SetSliceLoads(const Points& load, SpringSlices<Number>& slices) {
  slices.load.assign(slices.slices.size() - 1, {});
  for (size_t s = 0; s < slices.load.size(); ++s) {
    for (int i = 0; i < slices.slices[s].rows; ++i) {
      const int position = slices.VertexOf(static_cast<std::int64_t>(s), i);
      const Eigen::Vector3d force = load.col(slices.order.empty() ? position : slices.order[position]);
      SliceLoad<Number>& slice = slices.load[s];
      slice.x.row[i] = static_cast<Number>(force.x());
      slice.y.row[i] = static_cast<Number>(force.y());
      slice.z.row[i] = static_cast<Number>(force.z());
    }
  }
}

void CopyReordered(const SpringSlices<double>& slices, const VertexRange& block, const ConstPoints& x, int /*origin*/,
                   double* ordered) {
  for (Eigen::Index i = block.first; i < block.end; ++i) {
    for (int c = 0; c < 3; ++c) ordered[3 * i + c] = x(c, slices.order[i]);
  }
}

void CopyReordered(const SpringSlices<float>& slices, const VertexRange& block, const ConstPoints& x, int origin,
                   float* ordered) {
  for (Eigen::Index i = block.first; i < block.end; ++i) {
    for (int c = 0; c < 3; ++c) ordered[4 * i + c] = static_cast<float>(x(c, slices.order[i]) - x(c, origin));
  }
}

// Scratch memory: positions in the slices' order.
template <typename Number>
struct OrderedPoints {
  AlignedNumbers<Number> numbers;
};

template <typename Number>
void AddReordered(const SpringSlices<Number>& slices, int origin, double scale, const ConstPoints& x,
                  const Scratch& scratch, double* f) {
  const auto count = static_cast<Eigen::Index>(slices.order.size());
  auto* const ordered = scratch.Get<OrderedPoints<Number>>().numbers.Fit(kPointStride<Number> * count);
  ForEachBlock({0, count}, [&](const VertexRange& block) { CopyReordered(slices, block, x, origin, ordered); });
  ForEachBlock({0, count}, [&](const VertexRange& range) {
    const std::int64_t block = range.first / kVertexBlock;
    AddSprings(slices, block, block + 1, scale, ordered, false, f);
  });
}

}  // namespace

SpringRows::SpringRows(const std::vector<Spring>& springs, int vertices, Precision precision) {
  if (precision == Precision::kSingle) {
    slices_ = MakeSlices<float>(springs, vertices);
  } else {
    slices_ = MakeSlices<double>(springs, vertices);
  }
  ordered_ = std::visit([](const auto& slices) { return !slices.order.empty(); }, slices_);
  if (!springs.empty()) origin_ = springs[springs.size() / 2].a;
}

void SpringRows::SetLoad(const Points& load) {
  std::visit([&load](auto& slices) { SetSliceLoads(load, slices); }, slices_);
}

Precision SpringRows::precision() const {
  return std::holds_alternative<SpringSlices<float>>(slices_) ? Precision::kSingle : Precision::kDouble;
}

void SpringRows::AddForce(double scale, const ConstPoints& x, const Scratch& scratch, MutablePoints f) const {
  if (ordered_) {
    std::visit([&](const auto& slices) { AddReordered(slices, origin_, scale, x, scratch, f.data()); }, slices_);
  } else {
    const float* const packed = precision() == Precision::kSingle ? PackAll(x, origin_, scratch) : nullptr;
    AddForce({0, x.cols()}, scale, x, packed, false, f);
  }
}

void SpringRows::AddForce(const VertexRange& range, double scale, const ConstPoints& x, const float* packed, bool fresh,
                          MutablePoints f) const {
  const auto block = [](Eigen::Index vertex) { return (vertex + kVertexBlock - 1) / kVertexBlock; };
  const std::int64_t first = block(range.first), end = block(range.end);
  if (const auto* const singles = std::get_if<SpringSlices<float>>(&slices_)) {
    AddSprings(*singles, first, end, scale, packed, fresh, f.data());
  } else {
    AddSprings(std::get<SpringSlices<double>>(slices_), first, end, scale, x.data(), fresh, f.data());
  }
}

}  // namespace phrenic
