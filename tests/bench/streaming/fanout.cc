#include <cstdio>

#include "absl/strings/str_cat.h"
#include "server/stream/codecs/codec.h"
#include "tests/bench/streaming/gateway_viewers.h"
#include "tests/bench/streaming/parts.h"

namespace phrenic::bench {
namespace {

// From so many viewers on the cost of a frame itself is shared by enough of them.
constexpr int kMany = 100;
constexpr double kAimCpu = 50;          // [us] a viewer and frame
constexpr double kAimWorstAge = 0.050;  // [s], of 99 of 100 frames
constexpr double kAimBytes = 20e3;      // a frame for which the aims are meant, its numbers included
constexpr double kBound = 0.1;          // [mm]

struct Way {
  const char* name;
  bool gateway;
  int window;
};

std::string AimOf(const Wanted& wanted, double bytes, double cpu, double age) {
  if (wanted.viewers < kMany) return "";
  if (bytes > kAimBytes) return "aims are for less than 20 kB";
  const std::string age_aim = wanted.viewers == kMany ? "; " + Verdict(age <= kAimWorstAge, "p99 <= 50 ms") : "";
  return Verdict(cpu <= kAimCpu, "<= 50 us") + age_aim;
}

bool Row(Bench& bench, const char* codec, const Way& way, const Wanted& wanted) {
  const auto viewers = way.gateway ? WatchOverGateway(bench.server().web_port(), wanted)
                                   : WatchOverGrpc(bench.server().address(), wanted);
  if (!viewers->WaitForAll(absl::Seconds(30))) std::printf("not all viewers got a frame within 30 s:\n");
  bench.Sleep(0.25 * bench.settings().seconds);
  Cost cost;
  const Sight sight = Watch(bench, *viewers, bench.settings().seconds, &cost);
  const double frames = static_cast<double>(sight.frames);
  if (frames == 0) return std::printf("%7d  %-9s %-8s no frame came\n", wanted.viewers, codec, way.name) < 0;
  const double cpu = 1e6 * cost.sending / frames, bytes = static_cast<double>(sight.bytes) / frames;
  std::printf("%7d  %-9s %-8s %6.1f %8.1f %8.1f %9.1f %7.2f %7.0f %9.0f  %s\n", wanted.viewers, codec, way.name,
              frames / wanted.viewers / cost.wall, 1e3 * sight.Age(0.5), 1e3 * sight.Age(0.99), cpu,
              cost.sending / cost.wall, 1e-6 * static_cast<double>(bench.server().Memory()), bytes,
              AimOf(wanted, bytes, cpu, sight.Age(0.99)).c_str());
  std::fflush(stdout);
  return true;
}

}  // namespace

bool FanOut(Bench& bench) {
  std::printf("%s, 30 frames a second wanted, within 0.1 mm\n%7s  %-9s %-8s %6s %8s %8s %9s %7s %7s %9s\n",
              bench.settings().scene.c_str(), "viewers", "codec", "way", "fps", "p50 ms", "p99 ms", "CPU us", "cores",
              "MB", "bytes");
  bool complete = true;
  for (const int viewers : bench.settings().viewers) {
    complete = Row(bench, "predicted", {"web", true, 6}, {.viewers = viewers, .bound_mm = kBound}) && complete;
  }
  if (bench.settings().web_alone) return complete;
  for (const stream::CodecRow& each : stream::Codecs()) {
    for (const int viewers : bench.settings().viewers) {
      const Wanted wanted{.viewers = viewers, .codec = each.codec, .bound_mm = kBound};
      complete = Row(bench, std::string(each.name).c_str(), {"gRPC", false, wanted.window}, wanted) && complete;
    }
  }
  for (const int viewers : bench.settings().viewers) {
    if (viewers < kMany) continue;
    complete = Row(bench, "predicted", {"no acks", false, 0}, {.viewers = viewers, .bound_mm = kBound, .window = 0}) &&
               complete;
  }
  return complete;
}

}  // namespace phrenic::bench
