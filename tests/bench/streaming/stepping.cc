#include <cstdio>

#include "tests/bench/streaming/parts.h"

namespace phrenic::bench {
namespace {

constexpr double kAimRatio = 0.95;

struct Pace {
  double a_second = 0, a_cpu_second = 0;  // steps
};

Pace Measure(Bench& bench) {
  const double seconds = bench.settings().seconds;
  const std::int64_t tick = bench.Session().tick();
  const double cpu = bench.server().Cpu("stepping");
  const absl::Time start = absl::Now();
  bench.Sleep(seconds);
  const double used = bench.server().Cpu("stepping") - cpu;
  const auto steps = static_cast<double>(bench.Session().tick() - tick);
  return {steps / absl::ToDoubleSeconds(absl::Now() - start), steps / used};
}

}  // namespace

bool Stepping(Bench& bench) {
  bench.Play(0);
  bench.Sleep(0.5);
  const Pace before = Measure(bench);
  Pace watched;
  {
    const auto viewers = WatchOverGrpc(bench.server().address(), {.viewers = 200});
    viewers->WaitForAll(absl::Seconds(60));
    watched = Measure(bench);
  }
  const Pace after = Measure(bench);
  const double alone = (before.a_cpu_second + after.a_cpu_second) / 2;
  const double ratio = watched.a_cpu_second / alone;
  std::printf("\n%-12s %12s %22s\n%-12s %12.0f %22.0f\n%-12s %12.0f %22.0f\n%-12s %12.0f %22.0f\n", "viewers",
              "steps/s", "steps/s of own CPU", "none", before.a_second, before.a_cpu_second, "200", watched.a_second,
              watched.a_cpu_second, "none again", after.a_second, after.a_cpu_second);
  std::printf("ratio %.3f  %s\n", ratio,
              Verdict(ratio >= kAimRatio, ">= 0.95 of the stepping thread's own CPU time").c_str());
  return watched.a_second > 0;
}

}  // namespace phrenic::bench
