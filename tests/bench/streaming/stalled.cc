#include <cstdio>

#include "tests/bench/streaming/parts.h"
#include "tests/bench/streaming/thin_line.h"

namespace phrenic::bench {
namespace {

constexpr double kAimGrowth = 10;  // [MB]
constexpr double kAimGone = 15;    // [s]

// Twenty viewers of every frame, and how many of them were missed.
Sight Healthy(Bench& bench, Viewers& healthy, double seconds) {
  Cost cost;
  return Watch(bench, healthy, seconds, &cost);
}

// A peer whose line was cut says nothing: it is gone when the server counts one viewer less.
void DeadPeer(Bench& bench) {
  ThinLine line(bench.server().port(), 1e9);
  const auto viewer = WatchOverGrpc("127.0.0.1:" + std::to_string(line.port()), {});
  viewer->WaitForAll(absl::Seconds(10));
  const int before = bench.Session().viewers();
  line.Freeze();
  const absl::Time frozen = absl::Now();
  while (bench.Session().viewers() == before && absl::Now() < frozen + absl::Seconds(30)) bench.Sleep(0.1);
  const double seconds = absl::ToDoubleSeconds(absl::Now() - frozen);
  std::printf("a peer whose line is cut is gone after %.1f s  %s\n", seconds,
              Verdict(seconds <= kAimGone, "<= 15 s").c_str());
}

}  // namespace

bool Stalled(Bench& bench) {
  const double seconds = 2 * bench.settings().seconds;
  const auto healthy = WatchOverGrpc(bench.server().address(), {.viewers = 20, .max_fps = 0});
  healthy->WaitForAll(absl::Seconds(30));
  const Sight alone = Healthy(bench, *healthy, seconds);
  const std::int64_t before = bench.server().Memory();
  const auto stalled = WatchOverGrpc(
      bench.server().address(), {.viewers = 20, .codec = v1::CODEC_RAW, .max_fps = 0, .window = 0, .reads = false});
  const Sight beside = Healthy(bench, *healthy, seconds);
  const double growth = 1e-6 * static_cast<double>(bench.server().Memory() - before);  // [MB]
  std::printf(
      "\n20 viewers of every frame, alone: %lld of %lld frames missed; beside 20 that read nothing of raw frames: "
      "%lld of %lld  %s\nmemory grows by %.1f MB in %.0f s  %s\n",
      static_cast<long long>(alone.gaps), static_cast<long long>(alone.gaps + alone.frames),
      static_cast<long long>(beside.gaps), static_cast<long long>(beside.gaps + beside.frames),
      Verdict(beside.gaps == 0, "0 missed").c_str(), growth, seconds,
      Verdict(growth <= kAimGrowth, "<= 10 MB").c_str());
  DeadPeer(bench);
  return alone.frames > 0 && beside.frames > 0;
}

}  // namespace phrenic::bench
