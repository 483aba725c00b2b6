#include "server/mechanics/forces/spring_rows.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <tuple>

#include "server/mechanics/forces/packed_points.h"
#include "server/mesh/locality.h"

namespace phrenic {
namespace {

// Of a block's vertices: with springs at more of them than this its sums are added vertex by vertex, not row by row.
constexpr double kNearlyAll = 0.75;

// One end of a spring as its row sees it; vertices by their places.
struct RowSpring {
  int other = 0;
  double stiffness = 0, rest_length = 0;
};
// Those of place i, by the places of their other ends: of[first[i]] to of[first[i + 1] - 1].
struct Rows {
  std::vector<int> first;
  LargeVector<RowSpring> of;

  int count() const { return static_cast<int>(first.size()) - 1; }
  int Size(int place) const { return first[place + 1] - first[place]; }
  const RowSpring& At(int place, int column) const { return of[first[place] + column]; }
};

// The order that the springs' vertices are to be taken in: none, as they come, which reads and writes them in one go,
// unless what a spring joins is too far apart for that.
std::vector<int> OrderOf(const std::vector<Spring>& springs, int vertices) {
  Edges edges(2, static_cast<Eigen::Index>(springs.size()));
  for (size_t s = 0; s < springs.size(); ++s) edges.col(static_cast<Eigen::Index>(s)) << springs[s].a, springs[s].b;
  return CuthillMcKeeIfScattered(edges, vertices);
}

Rows ByPlace(const std::vector<Spring>& springs, const std::vector<int>& order, int vertices) {
  std::vector<int> place(vertices);
  for (int i = 0; i < vertices; ++i) place[i] = i;
  for (size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
  Rows rows{std::vector<int>((order.empty() ? vertices : order.size()) + 1, 0),
            LargeVector<RowSpring>(2 * springs.size())};
  for (const Spring& spring : springs) ++rows.first[place[spring.a] + 1], ++rows.first[place[spring.b] + 1];
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  std::vector<int> next(rows.first.begin(), rows.first.end() - 1);
  for (const Spring& spring : springs) {
    const int a = place[spring.a], b = place[spring.b];
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

// A row of a block; of two that follow each other, as Fetching::kInPairs has it, either is `paired`.
struct Member {
  int row = 0;
  bool paired = false;
};

// Whether the row after this one does.
bool Follows(const Rows& rows, int row) {
  const int size = rows.Size(row);
  if (rows.Size(row + 1) != size) return false;
  return std::equal(&rows.At(row, 0), &rows.At(row, 0) + size, &rows.At(row + 1, 0),
                    [](const RowSpring& a, const RowSpring& b) { return a.other + 1 == b.other; });
}

// The block's rows that have springs, longest first, and of one length pairs first.
std::vector<Member> SortedBlock(const Rows& rows, int first) {
  std::vector<Member> block;
  block.reserve(kVertexBlock);
  const int end = std::min(first + static_cast<int>(kVertexBlock), rows.count());
  for (int row = first; row < end; ++row) {
    if (rows.Size(row) == 0) continue;
    const bool paired = row + 1 < end && Follows(rows, row);
    block.push_back({row, paired});
    if (paired) block.push_back({++row, paired});
  }
  std::stable_sort(block.begin(), block.end(), [&rows](const Member& a, const Member& b) {
    return std::pair(rows.Size(a.row), a.paired) > std::pair(rows.Size(b.row), b.paired);
  });
  return block;
}

// Where a whole slice's rows are all of pairs, puts them as Fetching::kInPairs has it.
bool PutInPairs(std::span<Member> members, size_t rows) {
  const auto paired = [](const Member& member) { return member.paired; };
  if (members.size() != rows || !std::all_of(members.begin(), members.end(), paired)) return false;
  for (size_t first = 0; first < rows; first += 8) {
    Member in_order[8];
    std::copy_n(members.begin() + first, 8, in_order);
    for (size_t i = 0; i < 8; ++i) members[first + i / 2 + i % 2 * 4] = in_order[i];
  }
  return true;
}

// Whether all springs of these rows have the stiffness of the first one's first.
bool Alike(const Rows& rows, std::span<const Member> members) {
  const double stiffness = rows.At(members.front().row, 0).stiffness;
  return std::all_of(members.begin(), members.end(), [&](const Member& member) {
    return std::all_of(&rows.At(member.row, 0), &rows.At(member.row, 0) + rows.Size(member.row),
                       [stiffness](const RowSpring& spring) { return spring.stiffness == stiffness; });
  });
}

// What reads beyond a point is not for the last.
Fetching FetchingOf(const Rows& rows, std::span<const Member> members, bool in_pairs) {
  const int last = rows.count() - 1;
  const bool at_end = std::any_of(members.begin(), members.end(), [&](const Member& member) {
    return member.row == last || rows.At(member.row, rows.Size(member.row) - 1).other == last;
  });
  if (at_end) return Fetching::kAtEnd;
  return in_pairs ? Fetching::kInPairs : Fetching::kOneByOne;
}

// Appends the slice of these rows, the first the longest. What they lack to a whole slice, and to the longest, is
// filled up with springs to themselves.
template <typename Number>
void AppendSlice(const Rows& rows, std::span<const Member> members, bool in_pairs, SpringSlices<Number>& slices) {
  SpringSlice<Number>& slice = slices.slices.back();
  slice.rows = static_cast<int>(members.size());
  slice.fetching = FetchingOf(rows, members, in_pairs);
  const size_t first = slices.at_rest.size(), first_place = slices.places.size();
  const int width = rows.Size(members.front().row), places = slice.places();
  slices.at_rest.resize(first + width);
  slices.places.resize(first_place + static_cast<size_t>((1 + width) * places));
  if (Alike(rows, members)) {
    slice.common_stiffness = static_cast<Number>(rows.At(members.front().row, 0).stiffness);
  } else {
    slice.first_stiffness = static_cast<std::int64_t>(slices.stiffness.size());
    slices.stiffness.resize(slices.stiffness.size() + width);
  }
  const bool paired = slice.fetching == Fetching::kInPairs;
  for (int i = 0; i < kSliceRows<Number>; ++i) {
    const int own = members[i < slice.rows ? i : 0].row;
    std::int32_t* const place = &slices.places[first_place + (paired ? PairOf(i) : i)];
    const int from = paired ? PointOfPair(i) : 0;
    place[0] = kPointStride<Number> * (own - from);
    for (int c = 0; c < width; ++c) {
      const bool padding = i >= slice.rows || c >= rows.Size(own);
      const RowSpring spring = padding ? RowSpring{own, 0, 0} : rows.At(own, c);
      place[(1 + c) * places] = kPointStride<Number> * (spring.other - from);
      slices.at_rest[first + c].row[i] = static_cast<Number>(spring.stiffness * spring.rest_length);
      if (slice.first_stiffness >= 0) {
        slices.stiffness[slice.first_stiffness + c].row[i] = static_cast<Number>(spring.stiffness);
      }
    }
  }
  slices.slices.push_back({.first_column = static_cast<std::int64_t>(slices.at_rest.size()),
                           .first_place = static_cast<std::int64_t>(slices.places.size())});
}

template <typename Number>
void AppendBlock(const Rows& rows, int first, SpringSlices<Number>& slices) {
  std::vector<Member> block = SortedBlock(rows, first);
  const int vertices = std::min(static_cast<int>(kVertexBlock), rows.count() - first);
  slices.blocks.back().whole = slices.order.empty() && static_cast<double>(block.size()) > kNearlyAll * vertices;
  constexpr size_t kRows = kSliceRows<Number>;
  for (size_t i = 0; i < block.size(); i += kRows) {
    const std::span<Member> members(&block[i], std::min(kRows, block.size() - i));
    const bool in_pairs = PutInPairs(members, kRows);
    AppendSlice<Number>(rows, members, in_pairs, slices);
    for (size_t row = 0; row < members.size(); ++row) {
      slices.slot[members[row].row] = static_cast<std::uint16_t>(SlotOf<Number>(i / kRows, static_cast<int>(row)));
    }
  }
  slices.blocks.push_back({.first_slice = static_cast<std::int64_t>(slices.slices.size()) - 1});
}

template <typename Number>
SpringSlices<Number> Lay(const std::vector<Spring>& springs, int vertices) {
  SpringSlices<Number> slices;
  slices.order = OrderOf(springs, vertices);
  const Rows rows = ByPlace(springs, slices.order, vertices);
  slices.slot.assign(rows.count(), kNoSlot<Number>);
  const size_t ends = rows.of.size() + rows.of.size() / 8;  // sorted rows need little padding
  slices.at_rest.reserve(ends / kSliceRows<Number>);
  slices.places.reserve(ends + rows.first.size() + rows.first.size() / 8);
  slices.blocks.emplace_back();
  slices.slices.emplace_back();
  for (int first = 0; first < rows.count(); first += kVertexBlock) AppendBlock(rows, first, slices);
  return slices;
}

template <typename Number>
void LayLoad(const Points& load, SpringSlices<Number>& slices) {
  slices.load.assign(slices.slices.size() - 1, {});
  for (size_t s = 0; s < slices.load.size(); ++s) {
    for (int i = 0; i < slices.slices[s].rows; ++i) {
      const int place = slices.VertexOf(static_cast<std::int64_t>(s), i);
      const Eigen::Vector3d force = load.col(slices.order.empty() ? place : slices.order[place]);
      SliceLoad<Number>& slice = slices.load[s];
      slice.x.row[i] = static_cast<Number>(force.x());
      slice.y.row[i] = static_cast<Number>(force.y());
      slice.z.row[i] = static_cast<Number>(force.z());
    }
  }
}

void PutInOrder(const SpringSlices<double>& slices, const VertexRange& block, const ConstPoints& x, int /*origin*/,
                double* ordered) {
  for (Eigen::Index i = block.first; i < block.end; ++i) {
    for (int c = 0; c < 3; ++c) ordered[3 * i + c] = x(c, slices.order[i]);
  }
}

void PutInOrder(const SpringSlices<float>& slices, const VertexRange& block, const ConstPoints& x, int origin,
                float* ordered) {
  for (Eigen::Index i = block.first; i < block.end; ++i) {
    for (int c = 0; c < 3; ++c) ordered[4 * i + c] = static_cast<float>(x(c, slices.order[i]) - x(c, origin));
  }
}

// Positions in the order of the slices.
template <typename Number>
struct OrderedPoints {
  AlignedNumbers<Number> numbers;
};

template <typename Number>
void AddInOrder(const SpringSlices<Number>& slices, int origin, double scale, const ConstPoints& x,
                const Scratch& scratch, double* f) {
  const auto places = static_cast<Eigen::Index>(slices.order.size());
  auto* const ordered = scratch.Get<OrderedPoints<Number>>().numbers.Fit(kPointStride<Number> * places);
  ForEachBlock({0, places}, [&](const VertexRange& block) { PutInOrder(slices, block, x, origin, ordered); });
  ForEachBlock({0, places}, [&](const VertexRange& range) {
    const std::int64_t block = range.first / kVertexBlock;
    AddSprings(slices, block, block + 1, scale, ordered, false, f);
  });
}

}  // namespace

SpringRows::SpringRows(const std::vector<Spring>& springs, int vertices, Precision precision) {
  if (precision == Precision::kSingle) {
    slices_ = Lay<float>(springs, vertices);
  } else {
    slices_ = Lay<double>(springs, vertices);
  }
  ordered_ = std::visit([](const auto& slices) { return !slices.order.empty(); }, slices_);
  if (!springs.empty()) origin_ = springs[springs.size() / 2].a;
}

void SpringRows::SetLoad(const Points& load) {
  std::visit([&load](auto& slices) { LayLoad(load, slices); }, slices_);
}

Precision SpringRows::precision() const {
  return std::holds_alternative<SpringSlices<float>>(slices_) ? Precision::kSingle : Precision::kDouble;
}

void SpringRows::AddForce(double scale, const ConstPoints& x, const Scratch& scratch, MutablePoints f) const {
  if (ordered_) {
    std::visit([&](const auto& slices) { AddInOrder(slices, origin_, scale, x, scratch, f.data()); }, slices_);
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
