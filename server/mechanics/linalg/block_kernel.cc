#include "server/mechanics/linalg/block_kernel.h"

#include <cstddef>

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/linalg/block_kernel.cc"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kSliceLanes>;
using Vector = hn::Vec<Tag>;
constexpr size_t kWidth = hn::MaxLanes(Tag());
static_assert(kSliceLanes % kWidth == 0);

constexpr float kLeastPivot = 1e-6F;        // of the mean diagonal: keeps the preconditioner positive definite
constexpr float kShortestSquared = 1e-36F;  // keeps 1/l^2 finite [m^2]
constexpr int kColumnsAhead = 12;
constexpr size_t kFlush = 32;  // slices whose products are summed in single precision

struct Vectors {
  Vector x, y, z, w;
};

HWY_INLINE Vector At(const Lanes& lanes, size_t first) { return hn::Load(Tag(), lanes.at + first); }
HWY_INLINE void Put(Vector v, size_t first, Lanes& lanes) { hn::Store(v, Tag(), lanes.at + first); }

#if HWY_TARGET != HWY_SCALAR
// The quadruples of floats at places 0, 4, 8 and 12, as many as the vector has room for.
template <class D, typename Place>
HWY_INLINE hn::Vec<D> EveryFourth(D d, const float* from, int first, const Place& place) {
  if constexpr (hn::MaxLanes(D()) <= 4) {
    return hn::Load(d, from + place(first));
  } else {
    const hn::Half<D> half;
    constexpr int kHalf = static_cast<int>(hn::MaxLanes(half));
    return hn::Combine(d, EveryFourth(half, from, first + kHalf, place), EveryFourth(half, from, first, place));
  }
}

#endif

// The quadruples at the places of kWidth lanes, transposed: all first floats, all second ones and so on.
template <typename Place>
HWY_INLINE Vectors Transposed(const float* from, const Place& place) {
  const Tag d;
#if HWY_TARGET == HWY_SCALAR
  const float* const at = from + place(0);
  return {hn::Load(d, at), hn::Load(d, at + 1), hn::Load(d, at + 2), hn::Load(d, at + 3)};
#else
  const hn::Repartition<double, Tag> pairs;
  const auto a = EveryFourth(d, from, 0, place), b = EveryFourth(d, from, 1, place);
  const auto c = EveryFourth(d, from, 2, place), e = EveryFourth(d, from, 3, place);
  const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
  const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
  const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
  const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
  return {hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23)),
          hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23))};
#endif
}

// The points of a slice's own rows.
HWY_INLINE Vectors OwnRows(const Quad* packed, size_t first) {
  Vectors own;
  hn::LoadInterleaved4(Tag(), packed[first].at, own.x, own.y, own.z, own.w);
  return own;
}

// The points of a column's neighbours.
HWY_INLINE Vectors Gathered(const Quad* packed, const LanePlaces& rows, size_t first) {
  const std::int32_t* const row = rows.at + first;
  return Transposed(packed->at, [row](int i) { return static_cast<std::ptrdiff_t>(row[i]); });
}

HWY_INLINE Vector Dot(const Vector& ax, const Vector& bx, const Vector& ay, const Vector& by, const Vector& az,
                      const Vector& bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

// The symmetric block times a vector, row by row.
HWY_INLINE Vectors Product(const Lanes* block, size_t first, const Vectors& v) {
  const Vector xy = At(block[1], first), xz = At(block[2], first), yz = At(block[4], first);
  return {Dot(At(block[0], first), v.x, xy, v.y, xz, v.z), Dot(xy, v.x, At(block[3], first), v.y, yz, v.z),
          Dot(xz, v.x, yz, v.y, At(block[5], first), v.z), v.w};
}

// The same of any block.
HWY_INLINE Vectors WholeProduct(const Lanes* block, size_t first, const Vectors& v) {
  const auto row = [block, first, &v](int r) HWY_ATTR {
    return Dot(At(block[3 * r], first), v.x, At(block[3 * r + 1], first), v.y, At(block[3 * r + 2], first), v.z);
  };
  return {row(0), row(1), row(2), v.w};
}

// A sum of many products that is the same on every target: by lane, flushed into a double now and then.
class Sum {
 public:
  HWY_INLINE void Add(Vector v, size_t first) { Put(hn::Add(At(lanes_, first), v), first, lanes_); }
  void EndSlice(size_t slice) {
    if (slice % kFlush == kFlush - 1) Flush();
  }
  double Total() {
    Flush();
    return total_;
  }

 private:
  void Flush() {
    for (float& lane : lanes_.at) total_ += static_cast<double>(lane), lane = 0;
  }
  Lanes lanes_;
  double total_ = 0;
};

// D and L of A = L D L^T, pivots kept positive.
HWY_INLINE void Factorise(const Lanes* a, size_t first, Lanes* factors) {
  const Tag d;
  const Vector one = hn::Set(d, 1), least = hn::Set(d, kLeastPivot);
  const Vector xy = At(a[1], first), xz = At(a[2], first);
  const Vector dx = hn::Div(one, hn::Max(At(a[0], first), least));
  const Vector yx = hn::Mul(xy, dx), zx = hn::Mul(xz, dx);
  const Vector dy = hn::Div(one, hn::Max(hn::Sub(At(a[3], first), hn::Mul(yx, xy)), least));
  const Vector left = hn::Sub(At(a[4], first), hn::Mul(zx, xy));  // D_y L_zy
  const Vector zy = hn::Mul(left, dy);
  const Vector rest = hn::Sub(hn::Sub(At(a[5], first), hn::Mul(zx, xz)), hn::Mul(zy, left));
  Put(yx, first, factors[0]), Put(zx, first, factors[1]), Put(zy, first, factors[2]);
  Put(dx, first, factors[3]), Put(dy, first, factors[4]);
  Put(hn::Div(one, hn::Max(rest, least)), first, factors[5]);
}

// (L D L^T)^-1 r.
HWY_INLINE Vectors Solved(const Lanes* factors, size_t first, const Vectors& r) {
  const Vector yx = At(factors[0], first), zx = At(factors[1], first), zy = At(factors[2], first);
  const Vector y = hn::Sub(r.y, hn::Mul(yx, r.x));
  const Vector z = hn::Sub(hn::Sub(r.z, hn::Mul(zx, r.x)), hn::Mul(zy, y));
  const Vector uz = hn::Mul(z, At(factors[5], first));
  const Vector uy = hn::Sub(hn::Mul(y, At(factors[4], first)), hn::Mul(zy, uz));
  const Vector ux = hn::Sub(hn::Sub(hn::Mul(r.x, At(factors[3], first)), hn::Mul(yx, uy)), hn::Mul(zx, uz));
  return {ux, uy, uz, r.w};
}

HWY_INLINE Vectors Loaded(const Lanes* vector, size_t first) {
  return {At(vector[0], first), At(vector[1], first), At(vector[2], first), hn::Zero(Tag())};
}
HWY_INLINE void Stored(const Vectors& v, size_t first, Lanes* vector) {
  Put(v.x, first, vector[0]), Put(v.y, first, vector[1]), Put(v.z, first, vector[2]);
}

HWY_INLINE void Packed(const Vectors& v, Quad* packed) { hn::StoreInterleaved4(v.x, v.y, v.z, v.w, Tag(), packed->at); }

// Rows of a slice, from row `first` on, where they are: differences are taken in double precision, and then rounded.
constexpr int kParts = kWidth / points::kLanes;
struct Places {
  points::Vectors part[kParts];
};

HWY_INLINE Places OwnPlaces(const Position* own) {
  Places places;
  for (size_t i = 0; i < kParts; ++i) {
    points::Vector nothing;
    points::Vectors& part = places.part[i];
    hn::LoadInterleaved4(points::Tag(), own[i * points::kLanes].at, part.x, part.y, part.z, nothing);
  }
  return places;
}

// From `from` to a column's neighbours, e, and what is left of l^2 - l0^2 where both are nearly the same.
HWY_INLINE Vectors Ways(const Position* positions, const std::int32_t* neighbours, const double* rest_length,
                        const Places& from) {
  const hn::Rebind<float, points::Tag> part;
  using Part = hn::Vec<decltype(part)>;
  Part x[kParts], y[kParts], z[kParts], excess[kParts];
  for (size_t i = 0; i < kParts; ++i) {
    const points::Vectors to = points::Transposed<false>(positions->at, neighbours + i * points::kLanes);
    const points::Vector ex = hn::Sub(to.x, from.part[i].x), ey = hn::Sub(to.y, from.part[i].y);
    const points::Vector ez = hn::Sub(to.z, from.part[i].z);
    const points::Vector rest = hn::Load(points::Tag(), rest_length + i * points::kLanes);
    const points::Vector squared = hn::Add(hn::Add(hn::Mul(ex, ex), hn::Mul(ey, ey)), hn::Mul(ez, ez));
    x[i] = hn::DemoteTo(part, ex), y[i] = hn::DemoteTo(part, ey), z[i] = hn::DemoteTo(part, ez);
    excess[i] = hn::DemoteTo(part, hn::Sub(squared, hn::Mul(rest, rest)));
  }
#if HWY_TARGET == HWY_SCALAR
  return {x[0], y[0], z[0], excess[0]};
#else
  static_assert(kParts == 2);
  const Tag d;
  return {hn::Combine(d, x[1], x[0]), hn::Combine(d, y[1], y[0]), hn::Combine(d, z[1], z[0]),
          hn::Combine(d, excess[1], excess[0])};
#endif
}

// v and t of springs: t = max(k (l - l0)/l, 0) and v v^T + t e e^T/l^2 = k e e^T/l^2. Both are zero where
// l is: so is e, and l - l0 is not positive.
HWY_INLINE Vectors SpringBlock(const Vectors& way, const Vector& stiffness, const Vector& rest_length) {
  const Tag d;
  const Vector length = hn::Sqrt(Dot(way.x, way.x, way.y, way.y, way.z, way.z));
  const Vector sum = hn::Add(length, rest_length);
  const Vector inverse = hn::Div(hn::Set(d, 1), hn::Max(hn::Mul(length, sum), hn::Set(d, kShortestSquared)));
  const Vector t = hn::Max(hn::Mul(hn::Mul(stiffness, way.w), inverse), hn::Zero(d));
  const Vector root = hn::Mul(hn::Sqrt(hn::Max(hn::Sub(stiffness, t), hn::Zero(d))), hn::Mul(sum, inverse));
  return {hn::Mul(way.x, root), hn::Mul(way.y, root), hn::Mul(way.z, root), t};
}

HWY_INLINE void StoredBlock(const Vectors& v, size_t first, Lanes* block) {
  Stored(v, first, block);
  Put(v.w, first, block[3]);
}

// Springs' blocks to their columns; k, six numbers a row, += v v^T + t I of all its springs.
HWY_INLINE void AddSprings(const Position* positions, float elasticity, BlockSlices& slices, size_t s, size_t first,
                           Vector* k) {
  const Places own = OwnPlaces(positions + s * kSliceLanes + first);
  const Vector factor = hn::Set(Tag(), elasticity);
  for (std::int64_t c = slices.springs.first[s]; c < slices.springs.first[s + 1]; ++c) {
    const Vectors way =
        Ways(positions, slices.springs.neighbours[c].at + first, slices.spring_rest[c].exact + first, own);
    const Vector stiffness = hn::Mul(factor, At(slices.spring_stiffness[c], first));
    const Vectors v = SpringBlock(way, stiffness, At(slices.spring_rest[c].rounded, first));
    StoredBlock(v, first, slices.springs.blocks.data() + kSpringValues * c);
    k[0] = hn::Add(k[0], hn::Add(hn::Mul(v.x, v.x), v.w));
    k[1] = hn::Add(k[1], hn::Mul(v.x, v.y));
    k[2] = hn::Add(k[2], hn::Mul(v.x, v.z));
    k[3] = hn::Add(k[3], hn::Add(hn::Mul(v.y, v.y), v.w));
    k[4] = hn::Add(k[4], hn::Mul(v.y, v.z));
    k[5] = hn::Add(k[5], hn::Add(hn::Mul(v.z, v.z), v.w));
  }
}

// K's diagonal blocks as forces have handed them over.
HWY_INLINE void LoadDiagonal(const Quad* entries, Vector* k) {
  const auto place = [](int i) { return 8 * i; };
  const Vectors a = Transposed(entries->at, place), b = Transposed(entries->at + 4, place);
  k[0] = a.x, k[1] = a.y, k[2] = a.z, k[3] = a.w, k[4] = b.x, k[5] = b.y;
}

void FillDiagonalHere(const Quad* entries, const Position* positions, float elasticity, const Lanes* inertia,
                      float weight, BlockSlices& slices, Quad* packed) {
  const Tag d;
  for (size_t s = 0; s < slices.size(); ++s) {
    Lanes* const stiffness = slices.stiffness.data() + 6 * s;
    Lanes* const diagonal = slices.diagonal.data() + 6 * s;
    for (size_t first = 0; first < kSliceLanes; first += kWidth) {
      const Vector mass = At(inertia[s], first), by = hn::Set(d, weight), none = hn::Zero(d);
      Vector k[6] = {none, none, none, none, none, none};
      if (entries != nullptr) LoadDiagonal(entries + 2 * (s * kSliceLanes + first), k);
      AddSprings(positions, elasticity, slices, s, first, k);
      const Vector trace = hn::Add(hn::Mul(hn::Add(hn::Add(k[0], k[3]), k[5]), by), hn::Mul(mass, hn::Set(d, 3)));
      const Vector squared = hn::IfThenElse(hn::Gt(trace, none), hn::Div(hn::Set(d, 3), trace), none);
      const Vector scale = hn::Sqrt(squared);
      for (int i = 0; i < 6; ++i) {
        const Vector value = hn::Mul(hn::Mul(k[i], by), squared);
        Put(value, first, stiffness[i]);
        Put(i == 0 || i == 3 || i == 5 ? hn::Add(value, hn::Mul(mass, squared)) : value, first, diagonal[i]);
      }
      Put(scale, first, slices.scale[s]);
      Packed({scale, hn::Sqrt(scale), none, none}, packed + s * kSliceLanes + first);
      Factorise(diagonal, first, slices.factors.data() + 6 * s);
    }
  }
}

// A column of springs, scaled by the square of `root`.
HWY_INLINE void ScaleSprings(const Vector& root, size_t first, Lanes* block) {
  for (int i = 0; i < kAxes; ++i) Put(hn::Mul(At(block[i], first), root), first, block[i]);
  Put(hn::Mul(At(block[3], first), hn::Mul(root, root)), first, block[3]);
}

// A column of any blocks, scaled: an entry's symmetric part, and what turns, with the sign of the side it is seen from.
HWY_INLINE void FillWhole(const Quad* entries, const std::int32_t* entry, const Vector& by, size_t first,
                          Lanes* block) {
  const auto place = [entry](int i) { return 4 * static_cast<std::ptrdiff_t>(entry[i] / 2); };
  const Vectors a = Transposed(entries[0].at, place), b = Transposed(entries[1].at, place);
  Lanes sides;
  for (size_t i = 0; i < kWidth; ++i) sides.at[first + i] = entry[i] % 2 == 0 ? 1.0F : -1.0F;
  const Vector side = At(sides, first);
  const Vector tx = hn::Mul(b.z, side), ty = hn::Mul(b.w, side);
  const Vector tz = hn::Mul(Transposed(entries[2].at, place).x, side);
  const Vector k[9] = {a.x, hn::Sub(a.y, tz), hn::Add(a.z, ty), hn::Add(a.y, tz),
                       a.w, hn::Sub(b.x, tx), hn::Sub(a.z, ty), hn::Add(b.x, tx),
                       b.y};
  for (int i = 0; i < 9; ++i) Put(hn::Mul(k[i], by), first, block[i]);
}

void FillBlocksHere(const Quad* entries, float weight, const Quad* packed, BlockSlices& slices) {
  const Vector by = hn::Set(Tag(), weight), root = hn::Sqrt(by);
  for (size_t s = 0; s < slices.size(); ++s) {
    for (size_t first = 0; first < kSliceLanes; first += kWidth) {
      const Vector own = hn::Mul(by, At(slices.scale[s], first));
      const Vector own_root = hn::Mul(root, hn::Sqrt(At(slices.scale[s], first)));
      for (std::int64_t c = slices.springs.first[s]; c < slices.springs.first[s + 1]; ++c) {
        const Vectors other = Gathered(packed, slices.springs.neighbours[c], first);  // its scale and the root of it
        ScaleSprings(hn::Mul(own_root, other.y), first, slices.springs.blocks.data() + kSpringValues * c);
      }
      for (std::int64_t c = slices.whole.first[s]; c < slices.whole.first[s + 1]; ++c) {
        const Vectors other = Gathered(packed, slices.whole.neighbours[c], first);
        FillWhole(entries, slices.entries[c].at + first, hn::Mul(own, other.x), first,
                  slices.whole.blocks.data() + kWholeValues * c);
      }
    }
  }
}

// Of a column of springs: (v v^T + t I) x.
HWY_INLINE Vectors SpringProduct(const Lanes* block, size_t first, const Vectors& x) {
  const Vectors v = Loaded(block, first);
  const Vector t = At(block[3], first), along = Dot(v.x, x.x, v.y, x.y, v.z, x.z);
  return {hn::Add(hn::Mul(v.x, along), hn::Mul(t, x.x)), hn::Add(hn::Mul(v.y, along), hn::Mul(t, x.y)),
          hn::Add(hn::Mul(v.z, along), hn::Mul(t, x.z)), x.w};
}

// What comes some columns later, on its way from a farther cache.
template <int kValues>
HWY_INLINE void Prefetched(const Lanes* block, const LanePlaces* rows) {
  for (int i = 0; i < kValues; ++i) hwy::Prefetch(block + kColumnsAhead * kValues + i);
  hwy::Prefetch(rows + kColumnsAhead);
}

template <int kValues>
HWY_INLINE Vectors RowSums(const BlockColumns& columns, size_t s, size_t first, const Quad* packed, Vectors sum) {
  const Lanes* block = columns.blocks.data() + kValues * columns.first[s];
  for (std::int64_t c = columns.first[s]; c < columns.first[s + 1]; ++c, block += kValues) {
    if (first == 0) Prefetched<kValues>(block, columns.neighbours.data() + c);
    const Vectors other = Gathered(packed, columns.neighbours[c], first);
    if constexpr (kValues == kSpringValues) {
      const Vectors part = SpringProduct(block, first, other);
      sum = {hn::Sub(sum.x, part.x), hn::Sub(sum.y, part.y), hn::Sub(sum.z, part.z), sum.w};
    } else {
      const Vectors part = WholeProduct(block, first, other);
      sum = {hn::Add(sum.x, part.x), hn::Add(sum.y, part.y), hn::Add(sum.z, part.z), sum.w};
    }
  }
  return sum;
}

double MultiplyHere(const BlockSlices& slices, const Lanes* diagonal, const Quad* p, Lanes* q) {
  Sum sum;
  for (size_t s = 0; s < slices.size(); ++s) {
    for (size_t first = 0; first < kSliceLanes; first += kWidth) {
      const Vectors own = OwnRows(p + s * kSliceLanes, first);
      Vectors row = Product(diagonal + 6 * s, first, own);
      row = RowSums<kSpringValues>(slices.springs, s, first, p, row);
      row = RowSums<kWholeValues>(slices.whole, s, first, p, row);
      Stored(row, first, q + kAxes * s);
      sum.Add(Dot(own.x, row.x, own.y, row.y, own.z, row.z), first);
    }
    sum.EndSlice(s);
  }
  return sum.Total();
}

double DescendHere(const BlockSlices& slices, float along, Lanes* q, Lanes* r) {
  const Vector by = hn::Set(Tag(), along);
  Sum sum;
  for (size_t s = 0; s < slices.size(); ++s, q += kAxes, r += kAxes) {
    for (size_t first = 0; first < kSliceLanes; first += kWidth) {
      for (int k = 0; k < kAxes; ++k) {
        Put(hn::Sub(At(r[k], first), hn::Mul(by, At(q[k], first))), first, r[k]);
      }
      const Vectors left = Loaded(r, first);
      const Vectors z = Solved(slices.factors.data() + 6 * s, first, left);
      Stored(z, first, q);
      sum.Add(Dot(left.x, z.x, left.y, z.y, left.z, z.z), first);
    }
    sum.EndSlice(s);
  }
  return sum.Total();
}

void PackHere(const Lanes* z, Quad* p, size_t slices) {
  for (size_t s = 0; s < slices; ++s, z += kAxes, p += kSliceLanes) {
    for (size_t first = 0; first < kSliceLanes; first += kWidth) Packed(Loaded(z, first), p + first);
  }
}

HWY_INLINE Vectors Sum3(const Vectors& a, const Vector& by, const Vectors& b) {
  return {hn::Add(a.x, hn::Mul(by, b.x)), hn::Add(a.y, hn::Mul(by, b.y)), hn::Add(a.z, hn::Mul(by, b.z)), a.w};
}

void TurnHere(float along, float keep, const Lanes* z, Lanes* y, Quad* p, size_t slices) {
  const Vector forward = hn::Set(Tag(), along), kept = hn::Set(Tag(), keep);
  for (size_t s = 0; s < slices; ++s, z += kAxes, y += kAxes, p += kSliceLanes) {
    for (size_t first = 0; first < kSliceLanes; first += kWidth) {
      const Vectors last = OwnRows(p, first);
      Stored(Sum3(Loaded(y, first), forward, last), first, y);
      Packed(Sum3(Loaded(z, first), kept, last), p + first);
    }
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(FillDiagonalHere);
HWY_EXPORT(FillBlocksHere);
HWY_EXPORT(PackHere);
HWY_EXPORT(MultiplyHere);
HWY_EXPORT(DescendHere);
HWY_EXPORT(TurnHere);

void FillDiagonal(const BlockEntries& diagonal, const std::vector<Position>& positions, float elasticity,
                  const std::vector<Lanes>& inertia, float weight, BlockSlices& slices, Quad* packed) {
  HWY_DYNAMIC_DISPATCH(FillDiagonalHere)
  (diagonal.empty() ? nullptr : diagonal.data(), positions.data(), elasticity, inertia.data(), weight, slices, packed);
}

void FillBlocks(const BlockEntries& entries, float weight, const Quad* packed, BlockSlices& slices) {
  HWY_DYNAMIC_DISPATCH(FillBlocksHere)(entries.data(), weight, packed, slices);
}

void Pack(const RowVector& z, Quad* p) { HWY_DYNAMIC_DISPATCH(PackHere)(z.data(), p, z.size() / kAxes); }

double Multiply(const BlockSlices& slices, const std::vector<Lanes>& diagonal, const Quad* p, RowVector& q) {
  return HWY_DYNAMIC_DISPATCH(MultiplyHere)(slices, diagonal.data(), p, q.data());
}

double Descend(const BlockSlices& slices, float along, RowVector& q, RowVector& r) {
  return HWY_DYNAMIC_DISPATCH(DescendHere)(slices, along, q.data(), r.data());
}

void Turn(float along, float keep, const RowVector& z, RowVector& y, Quad* p) {
  HWY_DYNAMIC_DISPATCH(TurnHere)(along, keep, z.data(), y.data(), p, z.size() / kAxes);
}

}  // namespace phrenic
#endif  // HWY_ONCE
