#include "tests/bench/machine.h"

#include <benchmark/benchmark.h>

// Targets whose vectors have no size that the compiler knows: their machines take NEON and the portable path.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/machine.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::bench::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;

void TriadHere(const double* b, const double* c, double s, size_t count, double* a) {
  const Tag d;
  const auto by = hn::Set(d, s);
  for (size_t i = 0; i + 8 <= count; i += hn::MaxLanes(d)) {
    hn::StoreU(hn::MulAdd(by, hn::LoadU(d, c + i), hn::LoadU(d, b + i)), d, a + i);
  }
}

// Ten sums side by side, each from another start, as a compiler would take equal ones once: more than any machine's
// multiply-adds are long. Its flops.
double MultiplyAddsHere(int rounds, double* result) {
  const Tag d;
  const auto by = hn::Set(d, 0.999), plus = hn::Set(d, 1e-3);
  const auto from = [&](int start) { return hn::Set(d, *result + start); };
  auto a = from(0), b = from(1), c = from(2), e = from(3), f = from(4), g = from(5), h = from(6), i = from(7),
       j = from(8), k = from(9);
  for (int r = 0; r < rounds; ++r) {
    a = hn::MulAdd(a, by, plus), b = hn::MulAdd(b, by, plus), c = hn::MulAdd(c, by, plus);
    e = hn::MulAdd(e, by, plus), f = hn::MulAdd(f, by, plus), g = hn::MulAdd(g, by, plus);
    h = hn::MulAdd(h, by, plus), i = hn::MulAdd(i, by, plus), j = hn::MulAdd(j, by, plus);
    k = hn::MulAdd(k, by, plus);
  }
  const auto sum =
      hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), hn::Add(hn::Add(hn::Add(f, g), hn::Add(h, i)), hn::Add(j, k)));
  *result = hn::GetLane(sum);
  return 20.0 * rounds * static_cast<double>(hn::MaxLanes(d));
}

}  // namespace
}  // namespace phrenic::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic::bench {
namespace {

HWY_EXPORT(TriadHere);
HWY_EXPORT(MultiplyAddsHere);

constexpr int kRounds = 10'000;

double Flops(int rounds) {
  double result = 0;
  const double flops = HWY_DYNAMIC_DISPATCH(MultiplyAddsHere)(rounds, &result);
  benchmark::DoNotOptimize(result);
  return flops;
}

}  // namespace

Row Triad(const std::string& name, double megabytes) {
  const auto count = static_cast<size_t>(megabytes * 1e6 / 24) / 8 * 8;
  auto arrays = std::make_shared<std::vector<std::vector<double>>>(3, std::vector<double>(count, 1.0));
  const auto work = [arrays, count] {
    auto& all = *arrays;
    HWY_DYNAMIC_DISPATCH(TriadHere)(all[1].data(), all[2].data(), 0.5, count, all[0].data());
    benchmark::ClobberMemory();
  };
  return {.name = name,
          .work = work,
          .count = static_cast<double>(count),
          .unit = "place",
          .against = "",
          .bytes = 24.0 * static_cast<double>(count)};
}

Row MultiplyAdds(const std::string& name) {
  return {.name = name,
          .work = [] { Flops(kRounds); },
          .count = 0,
          .unit = "",
          .against = "",
          .bytes = 0,
          .flops = Flops(kRounds)};
}

}  // namespace phrenic::bench
#endif  // HWY_ONCE
