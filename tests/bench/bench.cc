// Times what a step is made of on the generated diaphragm, beside the plain loop over its springs, another library and
// what the machine can do, all in the same run, so that ratios hold whatever else the machine does: build/bench.
// Google Benchmark's options apply (--benchmark_repetitions=30). Exit code 1 where a step fails.
#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <cmath>
#include <cstdio>

#include "absl/strings/str_cat.h"
#include "server/mechanics/measures/readings.h"
#include "server/physiology/live_lungs.h"
#include "tests/bench/bullet_body.h"
#include "tests/bench/frames.h"
#include "tests/bench/machine.h"
#include "tests/bench/plain_springs.h"
#include "tests/bench/subjects.h"
#include "tests/bench/table.h"

namespace phrenic::bench {
namespace {

const char kPlain[] = "springs, plain loop with scatter", kSprings[] = "springs";
const char kEuler[] = "springs and Euler's step", kEulerSingle[] = "springs and Euler's step, single";
const char kThorax[] = "thorax, the whole step", kThesis[] = "thorax-thesis, the whole step";
const char kMeasures[] = "thorax' measures, a frame", kLungs[] = "thorax' lung tissue, a reading";
const char kFew[] = "rigid links, few", kMany[] = "rigid links, ten times as many";
const char kCache[] = "triad, 12 MB", kMultiplyAdds[] = "multiply-adds";

double Doubles(double places) { return sizeof(double) * places; }
double Floats(double places) { return sizeof(float) * places; }

class Bench {
 public:
  explicit Bench(const Subjects& subjects)
      : subjects_(subjects),
        springs_(SpringsOf(*subjects.springs)),
        rows_(springs_, static_cast<int>(subjects.springs->rest.cols())),
        single_(springs_, static_cast<int>(subjects.springs->rest.cols()), Precision::kSingle),
        x_(subjects.springs->rest * 1.05),
        f_(Points::Zero(3, x_.cols())),
        renumbered_(springs_, x_),
        renumbered_single_(renumbered_.springs, static_cast<int>(x_.cols()), Precision::kSingle),
        solver_(subjects.springs) {
    unlinked_.parameters.set_apply_links(false);
    implicit_.parameters.set_integrator(v1::INTEGRATOR_LINEAR_IMPLICIT_EULER);
    implicit_.parameters.set_time_step(kFrame);
  }

  void Register(Table& table) {
    RegisterSprings(table);
    RegisterThorax(table);
    RegisterOthers(table);
    table.Register(Triad(kCache, 12));
    table.Register(Triad("triad, 400 MB", 400));
    table.Register(MultiplyAdds(kMultiplyAdds));
  }

  void PrintSums(const Table& table) const {
    const double step = table.Microseconds(kThorax);
    const double few = table.Microseconds(kFew), many = table.Microseconds(kMany);
    if (step > 0) {
      const double a_second = step / thorax_.parameters.time_step() + table.Microseconds(kMeasures) / kFrame;
      std::printf("thorax in real time at 60 frames a second: %.2f sessions a core\n", 1e6 / a_second);
    }
    if (few > 0 && many > 0) {
      const double exponent = std::log(many / few) / std::log(Links(many_) / Links(few_));
      std::printf("rigid links: the cost grows as their number to the power of %.2f\n", exponent);
    }
  }

  absl::Status status() const {
    absl::Status status;
    for (const Run* run : {&euler_, &euler_single_, &thorax_, &thesis_, &unlinked_, &implicit_, &few_, &many_})
      status.Update(run->status);
    return status;
  }
  void PrintHead() const {
    std::printf("%td vertices, %zu springs; %s\n", x_.cols(), springs_.size(),
                hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets()));
  }

 private:
  static double Links(const Run& run) { return static_cast<double>(run.model->rigid_links.cols()); }

  void RegisterSprings(Table& table) {
    const auto many = static_cast<double>(springs_.size()), vertices = static_cast<double>(x_.cols());
    table.Register({kPlain, [this] { AddPlainSprings(springs_, 1, x_, f_); }, many, "spring", ""});
    // At each end stiffness times length and a place; a vertex' point, and its force read and written.
    const double ends = 2 * many * (Doubles(1) + sizeof(int)), single_ends = 2 * many * (Floats(1) + sizeof(int));
    const double points = vertices * Doubles(3 + 6), packed = vertices * Floats(4), flops = 2 * many * 19;
    table.Register(
        {kSprings, [this] { rows_.AddForce(1, x_, scratch_, f_); }, many, "spring", kPlain, ends + points, flops});
    table.Register({"springs, single precision", [this] { single_.AddForce(1, x_, scratch_, f_); }, many, "spring",
                    kPlain, single_ends + points + packed});
    table.Register({"the same, vertices numbered otherwise",
                    [this] { renumbered_single_.AddForce(1, renumbered_.x, scratch_, f_); }, many, "spring", kPlain});
    // Position and velocity, read and written, and the mass.
    table.Register({kEuler, [this] { euler_.Step(); }, many, "spring", kPlain, ends + vertices * Doubles(12 + 1)});
    table.Register({kEulerSingle, [this] { euler_single_.Step(); }, many, "spring", kPlain,
                    single_ends + packed + vertices * Doubles(12 + 1)});
#ifdef PHRENIC_BULLET
    table.Register({"Bullet's soft body, 1 iteration", [this] { once_.Step(1e-3); }, many, "spring", kEuler});
    table.Register({"Bullet's soft body, 4 iterations", [this] { often_.Step(1e-3); }, many, "spring", kEuler});
#else
    std::printf("two rows are missing: install libbullet-dev and run cmake again to see Bullet's soft body\n");
#endif
  }

  // Of conjugate gradients: at each end of a spring four numbers and a place; of a vertex what Multiply (diagonal, p,
  // q), Descend (q and r with the diagonal's factors) and Turn (z, y and p) read and write.
  double IterationBytes() const {
    const double ends = 2 * static_cast<double>(springs_.size()) * (Floats(4) + sizeof(int));
    return ends + static_cast<double>(x_.cols()) * Floats((6 + 4 + 3) + (6 + 6 + 6) + (3 + 6 + 8));
  }

  void CompileAgain(const Model& model) const { benchmark::DoNotOptimize(Compile(model.scene, subjects_.meshes)); }

  void RegisterThorax(Table& table) {
    const auto vertices = static_cast<double>(subjects_.thorax->rest.cols());
    table.Register({kThorax, [this] { thorax_.Step(); }, vertices, "vertex", kEulerSingle});
    const auto thesis = static_cast<double>(subjects_.thesis->rest.cols());
    table.Register({kThesis, [this] { thesis_.Step(); }, thesis, "vertex", kEulerSingle});
    table.Register({"thorax-thesis without its rigid links", [this] { unlinked_.Step(); }, thesis, "vertex", kThesis});
    const auto measure = [this] {
      const EvalContext at = MakeEvalContext(*subjects_.thorax, thorax_.parameters, thorax_.state, scratch_);
      benchmark::DoNotOptimize(ReadMeasures(*subjects_.thorax, at));
    };
    table.Register({kMeasures, measure, vertices, "vertex", kThorax});
    const auto lungs = [this] { benchmark::DoNotOptimize(lungs_.At(thorax_.state, thorax_.parameters)); };
    table.Register({kLungs, lungs, 0, "", kThorax});
    RegisterFrames(table);
    table.Register(
        {"thorax, compiled from its meshes", [this] { CompileAgain(*subjects_.thorax); }, vertices, "vertex", ""});
    table.Register(
        {"diaphragm of springs, compiled", [this] { CompileAgain(*subjects_.springs); }, vertices, "vertex", ""});
  }

  void RegisterFrames(Table& table) {
    const auto frame = [this](v1::Codec codec, bool seen = false) {
      return [this, codec, seen] { frames_.Make(thorax_.state, thorax_.parameters, codec, seen); };
    };
    table.Register({"thorax, a frame for viewers, raw", frame(v1::CODEC_RAW), 0, "", kThorax});
    table.Register({"thorax, a frame for viewers, predicted", frame(v1::CODEC_PREDICTED), 0, "", kThorax});
    const auto seen = frame(v1::CODEC_PREDICTED, true);
    table.Register({"thorax, a frame for viewers, predicted, what a page shows at first", seen, 0, "", kThorax});
  }

  void RegisterOthers(Table& table) {
    const auto vertices = static_cast<double>(x_.cols());
    const auto triangles = static_cast<double>(subjects_.membrane->bodies.front().mesh.triangles.cols());
    const auto pull = [this] {
      const EvalContext at =
          MakeEvalContext(*subjects_.membrane, subjects_.membrane->parameters, membrane_.state, scratch_);
      subjects_.membrane->forces.front()->AddForce(at, f_);
    };
    table.Register({"finite elements", pull, triangles, "triangle", ""});
    const auto contract = [this] {
      const EvalContext at = MakeEvalContext(*subjects_.muscle, subjects_.muscle->parameters, muscle_.state, scratch_);
      subjects_.muscle->forces.front()->AddForce(at, muscle_force_);
    };
    table.Register({"muscle, single precision", contract,
                    static_cast<double>(subjects_.muscle->bodies.front().mesh.triangles.cols()), "triangle", ""});
    table.Register({absl::StrCat("stiffness and ", Solver::kIterations, " iterations"), [this] { solver_.Solve(); },
                    vertices, "vertex", "", Solver::kIterations * IterationBytes()});
    table.Register({"an implicit step of 16.7 ms", [this] { implicit_.Step(); }, vertices, "vertex", ""});
    table.Register({kFew, [this] { few_.Step(); }, Links(few_), "link", ""});
    table.Register({kMany, [this] { many_.Step(); }, Links(many_), "link", kFew});
  }

  const Subjects& subjects_;
  const std::vector<Spring> springs_;
  const SpringRows rows_, single_;
  const Points x_;
  Points f_;
  Scratch scratch_;
  const Renumbered renumbered_;
  const SpringRows renumbered_single_;
  Solver solver_;
  Run euler_{subjects_.springs}, euler_single_{subjects_.single_springs}, implicit_{subjects_.springs},
      membrane_{subjects_.membrane}, muscle_{subjects_.muscle};
  Points muscle_force_ = Points::Zero(3, subjects_.muscle->rest.cols());
  const physiology::LiveLungs lungs_ = *physiology::LiveLungs::Make(*subjects_.thorax);
  Run thorax_{subjects_.thorax}, thesis_{subjects_.thesis}, unlinked_{subjects_.thesis};
  Frames frames_{subjects_.thorax};
  Run few_{subjects_.few_links}, many_{subjects_.many_links};
#ifdef PHRENIC_BULLET
  BulletBody once_{subjects_.springs->rest, subjects_.springs->inverse_mass, springs_, 1};
  BulletBody often_{subjects_.springs->rest, subjects_.springs->inverse_mass, springs_, 4};
#endif
};

}  // namespace
}  // namespace phrenic::bench

int main(int argc, char** argv) {
  using namespace phrenic::bench;
  std::vector<char*> arguments(argv, argv + argc);
  char repetitions[] = "--benchmark_repetitions=15", interleaving[] = "--benchmark_enable_random_interleaving=true";
  char least[] = "--benchmark_min_time=0.05";
  arguments.insert(arguments.begin() + 1, {repetitions, interleaving, least});
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;

  const auto subjects = MakeSubjects();
  if (!subjects.ok()) {
    std::fprintf(stderr, "%s\n", std::string(subjects.status().message()).c_str());
    return 1;
  }
  Bench bench(*subjects);
  Table table;
  bench.Register(table);
  bench.PrintHead();
  benchmark::RunSpecifiedBenchmarks(&table);
  table.Print(kCache, kMultiplyAdds);
  bench.PrintSums(table);
  if (bench.status().ok()) return 0;
  std::fprintf(stderr, "%s\n", std::string(bench.status().message()).c_str());
  return 1;
}
