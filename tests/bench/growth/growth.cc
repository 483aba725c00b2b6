// How cost grows with size, and what a second thread gives: springs under gravity on square sheets from 5,000 vertices
// to over a million, all in one run: build/growth_bench [LARGEST] [THREADS]. Cores of a shared machine differ: one
// thread is timed on each of as many of them as there are threads, growth is the fastest's, and what threads give is
// counted over their mean speed. Exit code 1 where a step fails or threads change a bit.
#include <malloc.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/parallel/parallel_for.h"
#include "server/mechanics/step/step.h"
#include "server/schema/schema.h"

namespace phrenic::bench {
namespace {

constexpr int kSides[] = {71, 102, 145, 289, 576, 1145};
constexpr int kRepetitions = 9;
constexpr double kLeastTime = 0.03;  // of a repetition [s]

double Wall() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double Cpu() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double ResidentBytes() {
  malloc_trim(0);
  std::ifstream file("/proc/self/statm");
  double pages = 0, resident = 0;
  file >> pages >> resident;
  return 4096 * resident;
}

std::string Sheet(int side) {
  const double edge = 1.0 / side;
  return absl::StrCat(
      "name: 'sheet' bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 3 fixed_vertices: [0] grid { columns: ", side,
      " rows: ", side, " u { x: ", edge, " } v { y: ", edge,
      " } } } forces { springs { bodies: 'sheet' stiffness: 40 rest_length_ratio: 0.9 } } forces { friction { bodies: "
      "'sheet' rate: 2 } } forces { gravity { bodies: 'sheet' acceleration { z: -9.81 } } } parameters { time_step: ",
      1e-2 / side, " }");
}

// The machine's cores that the process may use, `most` of them at most.
std::vector<int> Cores(int most) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  std::vector<int> cores;
  for (int core = 0; core < CPU_SETSIZE && static_cast<int>(cores.size()) < most; ++core) {
    if (CPU_ISSET(core, &allowed)) cores.push_back(core);
  }
  return cores;
}

// The calling thread stays on one core while this lives.
class OnCore {
 public:
  explicit OnCore(int core) {
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    sched_setaffinity(0, sizeof one, &one);
  }
  OnCore(const OnCore&) = delete;
  OnCore& operator=(const OnCore&) = delete;
  ~OnCore() { sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_{};
};

struct Timed {
  double cpu = 0, wall = 0;  // of a step [s], medians
  std::uint64_t hash = 0;    // after as many steps as were asked
};

// Times steps in chunks of at least kLeastTime. `steps` of a chunk are found by the first call and kept.
std::optional<Timed> TimeSteps(const Model& model, int threads, int& steps) {
  SetStepThreads(threads);
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  const auto take = [&](int count) {
    for (int i = 0; i < count; ++i) {
      if (!Step(model, model.parameters, model.parameters.time_step(), state, work).ok()) return false;
    }
    return true;
  };
  if (steps == 0) {
    const double start = Cpu();
    if (!take(3)) return std::nullopt;
    steps = std::max(1, static_cast<int>(std::ceil(kLeastTime * 3 / (Cpu() - start))));
    state = model.InitialState();
  }
  std::vector<double> cpu, wall;
  for (int i = 0; i < kRepetitions; ++i) {
    const double cpu_start = Cpu(), wall_start = Wall();
    if (!take(steps)) return std::nullopt;
    cpu.push_back((Cpu() - cpu_start) / steps), wall.push_back((Wall() - wall_start) / steps);
  }
  return Timed{boost::math::statistics::median(cpu), boost::math::statistics::median(wall), StateHash(state)};
}

// A step on one thread, on each of the cores.
std::vector<Timed> TimeAlone(const Model& model, const std::vector<int>& cores, int& steps) {
  std::vector<Timed> each;
  for (const int core : cores) {
    const OnCore here(core);
    const auto timed = TimeSteps(model, 1, steps);
    if (!timed.has_value()) return {};
    each.push_back(*timed);
  }
  std::sort(each.begin(), each.end(), [](const Timed& a, const Timed& b) { return a.cpu < b.cpu; });
  return each;
}

// How much faster the threads are than one of the cores is on the mean.
double SpeedUp(const std::vector<Timed>& alone, const Timed& shared) {
  double speed = 0;
  for (const Timed& timed : alone) speed += 1 / timed.wall;
  return static_cast<double>(alone.size()) / (speed * shared.wall);
}

// One line of the table; the CPU time of a step on one thread of the fastest core [s], 0 where it failed.
double PrintSize(int side, int threads) {
  const auto scene = schema::ParseScene("sheet", Sheet(side));
  if (!scene.ok()) return 0;
  const double resident = ResidentBytes(), start = Cpu();
  const auto model = Compile(*scene, [](const v1::Body&) { return absl::NotFoundError("no files"); });
  if (!model.ok()) return 0;
  const double compiled = Cpu() - start;
  int steps = 0;
  const std::vector<Timed> alone = TimeAlone(**model, Cores(threads), steps);
  const double held = ResidentBytes() - resident;
  const auto shared = TimeSteps(**model, threads, steps);
  if (alone.empty() || !shared.has_value()) return 0;
  const bool same =
      std::all_of(alone.begin(), alone.end(), [&](const Timed& timed) { return timed.hash == shared->hash; });
  const auto vertices = static_cast<double>((*model)->rest.cols());
  std::printf("%9.0f %11.3f %11.0f %10.0f %10.1f %14.2f %10.0f %10.2f   %s\n", vertices, compiled, held / vertices,
              1e6 * alone.front().cpu, 1e9 * alone.front().cpu / vertices, alone.back().cpu / alone.front().cpu,
              1e6 * shared->wall, SpeedUp(alone, *shared), same ? "same bits" : "OTHER BITS");
  return same ? alone.front().cpu : 0;
}

struct Size {
  double vertices = 0, cpu = 0;  // of a step [s]
};

// The exponent over all sizes, and without the steepest step from one to the next, where the arrays outgrow a cache.
void PrintExponents(const std::vector<Size>& sizes) {
  double time = 0, size = 0, steepest_time = 0, steepest_size = 1;
  size_t steepest = 0;
  for (size_t i = 1; i < sizes.size(); ++i) {
    const double t = std::log(sizes[i].cpu / sizes[i - 1].cpu), n = std::log(sizes[i].vertices / sizes[i - 1].vertices);
    time += t, size += n;
    if (steepest > 0 && t / n <= steepest_time / steepest_size) continue;
    steepest = i, steepest_time = t, steepest_size = n;
  }
  if (steepest == 0) return;
  std::printf("CPU time grows as the number of vertices to the power of %.2f", time / size);
  if (sizes.size() > 2) {
    std::printf("; of %.2f but for the steepest step, from %.0f to %.0f",
                (time - steepest_time) / (size - steepest_size), sizes[steepest - 1].vertices,
                sizes[steepest].vertices);
  }
  std::printf("\n");
}

int Run(double largest, int threads) {
  std::printf("%9s %11s %11s %10s %10s %14s %10s %10s\n", "vertices", "compile s", "bytes each", "CPU us", "ns each",
              "slowest core", "wall us", "speed-up");
  std::printf("%9s %11s %11s %10s %10s %14s %6d thr %10s\n", "", "(CPU)", "", "1 thread", "", "to fastest", threads,
              "");
  std::vector<Size> sizes;
  for (const int side : kSides) {
    if (side * side > largest) break;
    sizes.push_back({static_cast<double>(side) * side, PrintSize(side, threads)});
    if (sizes.back().cpu == 0) return 1;
  }
  PrintExponents(sizes);
  return 0;
}

}  // namespace
}  // namespace phrenic::bench

int main(int argc, char** argv) {
  return phrenic::bench::Run(argc > 1 ? std::atof(argv[1]) : 2e6, argc > 2 ? std::atoi(argv[2]) : 2);
}
