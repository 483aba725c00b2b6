#include "server/mechanics/breathing/wall_kernel.h"

#include <algorithm>

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/breathing/wall_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using points::Tag, points::Vector, points::Vectors;
using Whole = hn::RebindToSigned<Tag>;
using Indices = hn::Vec<Whole>;
constexpr int kWallLanes = static_cast<int>(points::kLanes);
constexpr int kPacketSliders = 8;

HWY_INLINE Vector Constant(double value) { return hn::Set(Tag(), value); }

HWY_INLINE Vector Clamped(Vector v, double low, double high) {
  return hn::Min(hn::Max(v, Constant(low)), Constant(high));
}

// a + t (b - a).
HWY_INLINE Vector Between(Vector a, Vector b, Vector t) { return hn::Add(a, hn::Mul(t, hn::Sub(b, a))); }

// A quadratic's change from rest is the mean of its slopes at both ends.
template <bool kDeparts>
HWY_INLINE void Evaluate(const WallShape& shape, const CagePosition& k, WallTable& table) {
  const Tag d;
  const std::array<std::vector<double>, 5>& change = shape.change;
  const Vector half = Constant(0.5), two = Constant(2);
  Vector pump = Constant(k.pump), bucket = Constant(k.bucket);
  for (int row = 0; row < kWallHeights; ++row) {
    Vector least = Constant(1e300);
    for (int i = row * kWallTurns; i < (row + 1) * kWallTurns; i += kWallLanes) {
      if constexpr (kDeparts) {
        const Vector departure = hn::LoadU(d, &table.departure[i]);
        pump = hn::Add(Constant(k.pump), departure), bucket = hn::Add(Constant(k.bucket), departure);
      }
      const Vector p = hn::LoadU(d, &change[0][i]), b = hn::LoadU(d, &change[1][i]);
      const Vector pp = hn::LoadU(d, &change[2][i]), bb = hn::LoadU(d, &change[3][i]), pb = hn::LoadU(d, &change[4][i]);
      const Vector by_pump = hn::Add(hn::Add(p, hn::Mul(two, hn::Mul(pp, pump))), hn::Mul(pb, bucket));
      const Vector by_bucket = hn::Add(hn::Add(b, hn::Mul(two, hn::Mul(bb, bucket))), hn::Mul(pb, pump));
      const Vector moved = hn::Add(hn::Mul(pump, hn::Add(p, by_pump)), hn::Mul(bucket, hn::Add(b, by_bucket)));
      const Vector radius = hn::Add(hn::LoadU(d, &shape.radius[i]), hn::Mul(half, moved));
      hn::StoreU(radius, d, &table.radius[i]);
      hn::StoreU(by_pump, d, &table.by_pump[i]);
      hn::StoreU(by_bucket, d, &table.by_bucket[i]);
      least = hn::Min(least, radius);
    }
    table.least[row] = hn::GetLane(hn::MinOfLanes(d, least));
  }
  for (int row = 0; row + 1 < kWallHeights; ++row) table.least[row] = std::min(table.least[row], table.least[row + 1]);
}

void EvaluateHere(const WallShape& shape, const CagePosition& k, WallTable& table) {
  k.departs() ? Evaluate<true>(shape, k, table) : Evaluate<false>(shape, k, table);
}

// The point against the axis, and the rows of the table around it.
struct Height {
  Vector x, front, squared;  // [m], [m], [m^2]
  Vector part;               // of the way from the lower row to the upper
  Vector inside;             // 1 between the table's lower and upper border, 0 beyond
  Indices below;
};

HWY_INLINE Height HeightOf(const Vectors& point, const WallFrame& frame) {
  const Tag d;
  const Vector front = hn::Sub(Constant(frame.axis_y), point.y);
  const Vector height = hn::Div(hn::Sub(point.z, Constant(frame.bottom)), Constant(frame.height));
  const Vector row = Clamped(hn::Mul(height, Constant(kWallHeights - 1)), 0, kWallHeights - 1);
  const Vector below = hn::Min(hn::Floor(row), Constant(kWallHeights - 2));
  const auto inside = hn::And(hn::Gt(height, hn::Zero(d)), hn::Lt(height, Constant(1)));
  return {point.x,
          front,
          hn::Add(hn::Mul(point.x, point.x), hn::Mul(front, front)),
          hn::Sub(row, below),
          hn::IfThenElseZero(inside, Constant(1)),
          hn::ConvertTo(Whole(), below)};
}

HWY_INLINE bool AllFarInside(const Height& at, const WallTable& table, double margin) {
  const Tag d;
  const Vector bound = hn::Sub(hn::GatherIndex(d, table.least.data(), at.below), Constant(margin));
  return hn::AllTrue(d, hn::And(hn::Gt(bound, hn::Zero(d)), hn::Lt(at.squared, hn::Mul(bound, bound))));
}

// The turn of a point (inner_wall.h) and its derivatives by x and y.
struct Turn {
  Vector value, by_x, by_y;
};

HWY_INLINE Turn TurnOf(const Height& at) {
  const Tag d;
  const Vector zero = hn::Zero(d), four = Constant(4);
  const Vector size = hn::Max(hn::Add(hn::Abs(at.x), hn::Abs(at.front)), Constant(kLeastWallRadius));
  const Vector ratio = hn::Div(at.x, size), squared = hn::Mul(size, size);
  const Vector before = hn::IfThenElse(hn::Lt(at.x, zero), hn::Add(four, ratio), ratio);
  const Vector value = hn::IfThenElse(hn::Lt(at.front, zero), hn::Sub(Constant(2), ratio), before);
  return {hn::IfThenElseZero(hn::Lt(value, four), value), hn::Div(at.front, squared), hn::Div(at.x, squared)};
}

// The four entries around a point, and where it lies between them.
struct Cell {
  Indices low_left, low_right;
  Vector u, v;
};

HWY_INLINE Cell CellOf(const Height& at, const Turn& turn) {
  const Whole whole;
  const Vector column = hn::Mul(turn.value, Constant(kWallQuarter));
  const Vector left = Clamped(hn::Floor(column), 0, kWallTurns - 1);  // also of points that are no numbers
  const Vector next = hn::Add(left, Constant(1));
  const Vector right = hn::IfThenElseZero(hn::Lt(next, Constant(kWallTurns)), next);
  const Indices row = hn::ConvertTo(whole, hn::Mul(hn::ConvertTo(Tag(), at.below), Constant(kWallTurns)));
  return {hn::Add(row, hn::ConvertTo(whole, left)), hn::Add(row, hn::ConvertTo(whole, right)), hn::Sub(column, left),
          at.part};
}

// The entries of one table around a point: low left, low right, high left, high right.
struct Corners {
  Vector a, b, c, d;
  HWY_INLINE Vector At(const Cell& cell) const { return Between(Between(a, b, cell.u), Between(c, d, cell.u), cell.v); }
};

HWY_INLINE Corners Around(const Cell& cell, const double* table) {
  const Tag d;
  const double* const high = table + kWallTurns;
  return {hn::GatherIndex(d, table, cell.low_left), hn::GatherIndex(d, table, cell.low_right),
          hn::GatherIndex(d, high, cell.low_left), hn::GatherIndex(d, high, cell.low_right)};
}

// Reactions to the coordinates, pump, bucket and parts, of eight lanes each.
using LaneSums = double[2 + kCageParts][kPacketSliders];

HWY_INLINE void AddReaction(Vector push, const Cell& cell, const std::vector<double>& by, double* lanes) {
  hn::StoreU(hn::Add(hn::LoadU(Tag(), lanes), hn::Mul(push, Around(cell, by.data()).At(cell))), Tag(), lanes);
}

// Adds the forces of the vertices from `lane` on, and their reactions to `sums`.
HWY_INLINE void Push(const SliderPacket& packet, int lane, const WallFrame& frame, const WallTable& table,
                     double margin, double largest_depth, const double* x, double* f, LaneSums& sums) {
  const Tag d;
  const Height at = HeightOf(points::Transposed<true>(x, packet.offset + lane), frame);
  if (AllFarInside(at, table, margin)) return;
  const Turn turn = TurnOf(at);
  const Cell cell = CellOf(at, turn);
  const Corners radius = Around(cell, table.radius.data());
  const Vector distance = hn::Max(hn::Sqrt(at.squared), Constant(kLeastWallRadius));
  const Vector depth = hn::Sub(hn::Sub(distance, radius.At(cell)), hn::LoadU(d, packet.touching + lane));
  if (hn::AllTrue(d, hn::Le(depth, hn::Zero(d)))) return;
  const Vector push = hn::Mul(hn::LoadU(d, packet.stiffness + lane), Clamped(depth, 0, largest_depth));
  const Vector by_turn =
      hn::Mul(Constant(kWallQuarter), Between(hn::Sub(radius.b, radius.a), hn::Sub(radius.d, radius.c), cell.v));
  const Vector by_row = Between(hn::Sub(radius.c, radius.a), hn::Sub(radius.d, radius.b), cell.u);
  const Vector by_z = hn::Mul(hn::Mul(by_row, Constant((kWallHeights - 1) / frame.height)), at.inside);
  const Vectors force = {hn::Mul(push, hn::Sub(hn::Mul(by_turn, turn.by_x), hn::Div(at.x, distance))),
                         hn::Mul(push, hn::Add(hn::Mul(by_turn, turn.by_y), hn::Div(at.front, distance))),
                         hn::Mul(push, by_z)};
  points::AddRows(points::ToRows(force), packet.offset + lane, std::min(kWallLanes, packet.count - lane), f);
  AddReaction(push, cell, table.by_pump, sums[0] + lane);
  AddReaction(push, cell, table.by_bucket, sums[1] + lane);
  for (size_t i = 0; i < kCageParts; ++i) {
    if (!table.by_part[i].empty()) AddReaction(push, cell, table.by_part[i], sums[2 + i] + lane);
  }
}

WallReaction PushHere(const std::vector<SliderPacket>& packets, const WallFrame& frame, const WallTable& table,
                      double margin, double largest_depth, const double* x, double* f) {
  LaneSums sums = {};
  for (const SliderPacket& packet : packets) {
    for (int lane = 0; lane < packet.count; lane += kWallLanes) {
      Push(packet, lane, frame, table, margin, largest_depth, x, f, sums);
    }
  }
  WallReaction reaction;
  for (int lane = 0; lane < kPacketSliders; ++lane) {
    reaction.pump += sums[0][lane], reaction.bucket += sums[1][lane];
    for (size_t i = 0; i < kCageParts; ++i) reaction.parts[i] += sums[2 + i][lane];
  }
  return reaction;
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(EvaluateHere);
HWY_EXPORT(PushHere);

namespace {

void SetDepartures(const WallShape& shape, const CagePosition& k, std::vector<double>& departure) {
  departure.assign(shape.radius.size(), 0);
  for (size_t part = 0; part < kCageParts; ++part) {
    const double u = k.parts[part];
    if (u == 0) continue;
    for (size_t i = 0; i < departure.size(); ++i) departure[i] += shape.weight[part][i] * u;
  }
}

}  // namespace

void EvaluateWall(const WallShape& shape, const CagePosition& k, const MovingParts& moving, WallTable& table) {
  const size_t entries = shape.radius.size();
  for (auto* values : {&table.radius, &table.by_pump, &table.by_bucket}) values->resize(entries);
  table.least.resize(kWallHeights);
  if (k.departs()) SetDepartures(shape, k, table.departure);
  HWY_DYNAMIC_DISPATCH(EvaluateHere)(shape, k, table);
  for (size_t part = 0; part < kCageParts; ++part) {
    std::vector<double>& by = table.by_part[part];
    by.resize(moving[part] ? entries : 0);
    const std::vector<double>& weight = shape.weight[part];
    for (size_t i = 0; i < by.size(); ++i) by[i] = weight[i] * (table.by_pump[i] + table.by_bucket[i]);
  }
}

WallReaction PushFromWall(const std::vector<SliderPacket>& packets, const WallFrame& frame, const WallTable& table,
                          double margin, double largest_depth, const double* x, double* f) {
  return HWY_DYNAMIC_DISPATCH(PushHere)(packets, frame, table, margin, largest_depth, x, f);
}

}  // namespace phrenic
#endif  // HWY_ONCE
