// Times what a step is made of on the generated diaphragm, beside the plain loop over its springs in the same run, so
// that ratios hold whatever else the machine does: build/bench. Google Benchmark's options apply
// (--benchmark_repetitions=30). Exit code 1 where a step fails.
#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <cstdio>
#include <functional>
#include <memory>

#include "server/mechanics/compile.h"
#include "server/mechanics/step.h"
#include "server/mesh/topology.h"
#include "server/schema/schema.h"
#include "server/session/meshes.h"
#include "server/session/scene_catalogue.h"
#include "tests/bench/plain_springs.h"
#include "tests/bench/table.h"

namespace phrenic::bench {
namespace {

const char kSpringsAlone[] = R"(
  name: "springs"
  bodies { name: "diaphragm" role: ROLE_DEFORMABLE mass: 3 fixed_regions: "rim"
           anatomy { structure: STRUCTURE_DIAPHRAGM } generated {} }
  forces { springs { bodies: "diaphragm" stiffness: 40 rest_length_ratio: 0.9 balanced_at_rest: true } }
)";

std::shared_ptr<const Model> Compiled(const absl::StatusOr<v1::Scene>& scene) {
  if (!scene.ok()) return nullptr;
  auto model = Compile(*scene, session::MakeMeshSource(""));
  if (!model.ok()) std::fprintf(stderr, "%s\n", std::string(model.status().message()).c_str());
  return model.ok() ? *model : nullptr;
}

// A session that is stepped: it goes on from one repetition to the next.
struct Run {
  std::shared_ptr<const Model> model;
  State state;
  Workspace work;
  absl::Status status;  // of the step that failed, if one did

  explicit Run(std::shared_ptr<const Model> of)
      : model(std::move(of)), state(model->InitialState()), work(model->MakeWorkspace()) {}
  void Step() { status.Update(phrenic::Step(*model, model->parameters, model->parameters.time_step(), state, work)); }
};

std::vector<Spring> SpringsOf(const Model& model) {
  std::vector<Spring> springs;
  const Edges edges = SpringEdges(model.bodies.front().mesh);
  for (const auto& edge : edges.colwise()) {
    const double length = (model.rest.col(edge[1]) - model.rest.col(edge[0])).norm();
    springs.push_back({edge[0], edge[1], 40, 0.9 * length});
  }
  return springs;
}

void Register(const char* name, double springs, int against, std::function<void()> work) {
  benchmark::RegisterBenchmark(name, [=](benchmark::State& state) {
    for (auto _ : state) work();
    state.counters["springs"] = springs;
    state.counters["against"] = against;
  })->Unit(benchmark::kMicrosecond);
}

}  // namespace
}  // namespace phrenic::bench

int main(int argc, char** argv) {
  using namespace phrenic;
  using namespace phrenic::bench;
  std::vector<char*> arguments(argv, argv + argc);
  char repetitions[] = "--benchmark_repetitions=15", interleaving[] = "--benchmark_enable_random_interleaving=true";
  char least[] = "--benchmark_min_time=0.05";
  arguments.insert(arguments.begin() + 1, {repetitions, interleaving, least});
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;

  const auto alone = Compiled(schema::ParseScene("springs", kSpringsAlone));
  const auto thorax = Compiled(session::SceneCatalogue({PHRENIC_SCENES_DIR}).Find("thorax"));
  if (alone == nullptr || thorax == nullptr) return 1;
  const std::vector<Spring> springs = SpringsOf(*alone);
  const SpringRows rows(springs, static_cast<int>(alone->rest.cols()));
  const Points x = alone->rest * 1.05;
  Points f = Points::Zero(3, x.cols());
  Run springs_run(alone), thorax_run(thorax);
  const auto many = static_cast<double>(springs.size());
  Register("1 springs, plain loop with scatter", many, -1, [&] { AddPlainSprings(springs, 1, x, f); });
  Register("2 springs", many, 0, [&] { rows.AddForce(1, x, f); });
  Register("3 springs and Euler's step", many, 0, [&] { springs_run.Step(); });
  Register("4 thorax, the whole step", thorax->report.springs(), 2, [&] { thorax_run.Step(); });
  std::printf("%td vertices, %zu springs; %s\n", x.cols(), springs.size(),
              hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets()));
  Table table;
  benchmark::RunSpecifiedBenchmarks(&table);
  for (const Run* run : {&springs_run, &thorax_run}) {
    if (run->status.ok()) continue;
    std::fprintf(stderr, "%s\n", std::string(run->status.message()).c_str());
    return 1;
  }
  return 0;
}
