// Batches of runs: the bits of a run do not depend on what runs beside it, nor on where it began.
#include "server/study/batch/batch.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <thread>

#include "server/stream/codecs/wire.h"
#include "server/study/batch/run_all.h"
#include "server/study/batch/run_pool.h"
#include "tests/study/run_on.h"

namespace phrenic::study {
namespace {

using testing::HasSubstr;

constexpr char kBatchScene[] =
    "name: 'row' bodies { name: 'row' role: ROLE_DEFORMABLE mass: 1 fixed_vertices: 0 polyhedron { vertices {} "
    "vertices { x: 0.1 } vertices { x: 0.2 } edges { a: 0 b: 1 } edges { a: 1 b: 2 } } } "
    "forces { springs { bodies: 'row' stiffness: 500 } } forces { gravity { bodies: 'row' acceleration { z: -9.81 } } "
    "} "
    "motions { oscillation { body: 'row' vertices: 2 amplitude { x: 0.01 } period: 1 scaled_by_breath_force: true } } "
    "measures { name: 'height' highest { body: 'row' direction { z: -1 } } } parameters { time_step: 0.002 } ";

const Compiler kCompileRow = [](const v1::SceneSource&) -> absl::StatusOr<std::shared_ptr<const Model>> {
  static const auto model = CompileText(kBatchScene);
  return model;
};

const std::function<bool()> kGoOn = [] { return false; };

v1::RunBatchRequest Runs(int count) {
  v1::RunBatchRequest request;
  request.mutable_source()->set_name("row");
  request.set_seconds(0.5);
  for (int i = 0; i < count; ++i) request.add_runs()->mutable_parameters()->set_breath_force(0.5 + 0.3 * i);
  return request;
}

// Returns each run's hash, by its index.
std::map<int, std::string> HashesOf(const v1::RunBatchRequest& request) {
  const auto batch = Batch::Make(request, kCompileRow, kGoOn);
  if (!batch.ok()) throw std::runtime_error(std::string(batch.status().message()));
  std::map<int, std::string> hashes;
  const absl::Status status = RunAll(
      *batch, [&](v1::BatchResult result) { return hashes.emplace(result.run(), result.state_hash()).second; }, kGoOn);
  EXPECT_TRUE(status.ok()) << status;
  return hashes;
}

std::string BatchFault(const v1::RunBatchRequest& request) {
  return std::string(Batch::Make(request, kCompileRow, kGoOn).status().message());
}

TEST(Batch, HasTheBitsOfSingleRunsAtAnyNumberOfThreads) {
  v1::RunBatchRequest request = Runs(9);
  request.set_threads(1);
  const auto alone = HashesOf(request);
  ASSERT_EQ(alone.size(), 9u);
  request.set_threads(4);
  EXPECT_EQ(HashesOf(request), alone);
  std::set<std::string> different;
  for (const auto& [run, hash] : alone) {
    different.insert(hash);
    v1::RunBatchRequest single = Runs(0);
    *single.add_runs() = request.runs(run);
    EXPECT_EQ(HashesOf(single).at(0), hash);
  }
  EXPECT_EQ(different.size(), 9u);
}

TEST(Batch, SamplesMeasuresAtTheNearestSteps) {
  v1::RunBatchRequest request = Runs(1);
  request.set_frames_per_second(7);
  request.add_read(v1::STATE_PART_POSITIONS);
  const auto batch = Batch::Make(request, kCompileRow, kGoOn);
  ASSERT_TRUE(batch.ok()) << batch.status();
  EXPECT_EQ(batch->Header().measures(0), "height");
  EXPECT_EQ(batch->Header().layout().bodies(0).name(), "row");
  const auto result = batch->Run(0, kGoOn);
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->times_size(), 4);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(result->times(i), (i + 1) / 7.0, 0.001);
  Points x(3, 3);
  ASSERT_EQ(result->state().positions().size(), sizeof(double) * 9);
  std::memcpy(x.data(), result->state().positions().data(), sizeof(double) * 9);
  EXPECT_EQ(result->measures(3), -x.row(2).minCoeff());
  EXPECT_EQ(result->time_step(), 0.002);
}

TEST(Batch, SummarisesWhatSamplesSayAndEndsWithTheStepThatReachesTheTime) {
  v1::RunBatchRequest request = Runs(1);
  request.set_seconds(0.5);
  request.set_frames_per_second(500);  // every step
  const auto sampled = Batch::Make(request, kCompileRow, kGoOn)->Run(0, kGoOn);
  request.set_summary(true);
  request.set_seconds(0.4999);
  const auto batch = Batch::Make(request, kCompileRow, kGoOn);
  ASSERT_TRUE(batch.ok()) << batch.status();
  const auto result = batch->Run(0, kGoOn);
  ASSERT_TRUE(sampled.ok() && result.ok());
  EXPECT_EQ(result->state_hash(), sampled->state_hash());
  EXPECT_EQ(result->times_size() + result->measures_size(), 0);
  const v1::BatchSummary& summary = result->summary();
  const auto [least, greatest] = std::minmax_element(sampled->measures().begin(), sampled->measures().end());
  EXPECT_EQ(summary.steps(), 250);
  EXPECT_EQ(summary.simulated_seconds(), sampled->times(249));
  EXPECT_EQ(summary.least(0), *least);
  EXPECT_EQ(summary.greatest(0), *greatest);
  EXPECT_EQ(summary.last(0), sampled->measures(249));
  EXPECT_FALSE(summary.has_constraint_residual());
  request.set_seconds(3600);  // numbers of a summary do not grow with the run
  request.set_frames_per_second(10000);
  EXPECT_EQ(BatchFault(request), "");
}

TEST(Batch, GoesOnFromAStateAsIfItHadNotStopped) {
  v1::RunBatchRequest whole = Runs(1), first = Runs(1), second = Runs(1);
  first.set_seconds(0.2);
  for (const int part : {v1::STATE_PART_POSITIONS, v1::STATE_PART_VELOCITIES, v1::STATE_PART_SCALARS})
    first.add_read(static_cast<v1::StatePart>(part));
  const auto begun = Batch::Make(first, kCompileRow, kGoOn)->Run(0, kGoOn);
  ASSERT_TRUE(begun.ok()) << begun.status();
  second.set_seconds(0.3);
  *second.mutable_runs(0)->mutable_start() = begun->state();
  EXPECT_EQ(HashesOf(second), HashesOf(whole));
  v1::StateArrays& start = *second.mutable_runs(0)->mutable_start();
  start.mutable_positions()->pop_back();
  EXPECT_THAT(BatchFault(second), HasSubstr("runs[0].start.positions: has 71 bytes; a state of the scene has 72"));
  start.set_positions(stream::DoublesOf(Points::Constant(3, 3, std::nan(""))));
  EXPECT_THAT(BatchFault(second), HasSubstr("runs[0].start.positions: a number is not finite"));
  start.set_positions(stream::DoublesOf(Points::Constant(3, 3, 1e6)));
  EXPECT_THAT(BatchFault(second), HasSubstr("runs[0].start.positions"));
  start.set_positions(stream::DoublesOf(Points::Zero(3, 3)));
  start.set_time(-1);
  EXPECT_THAT(BatchFault(second), HasSubstr("runs[0].start.time"));
}

TEST(Batch, ResumesWithTheRunsThatAreMissing) {
  v1::RunBatchRequest request = Runs(7);
  auto expected = HashesOf(request);
  for (const int run : {5, 0, 2, 2}) {
    request.add_finished(run);
    expected.erase(run);
  }
  EXPECT_EQ(HashesOf(request), expected);
  for (int run = 0; run < 7; ++run) request.add_finished(run);
  EXPECT_TRUE(HashesOf(request).empty());
  request.add_finished(7);
  EXPECT_THAT(BatchFault(request), HasSubstr("finished[11]: 7 is not the index of a run: there are 7"));
  request.set_finished(11, -1);
  EXPECT_THAT(BatchFault(request), HasSubstr("finished[11]: -1"));
}

TEST(Batch, RefusesBadRunsBeforeAnyBegins) {
  v1::RunBatchRequest request = Runs(3);
  request.mutable_runs(2)->mutable_parameters()->set_breath_force(1000);
  EXPECT_THAT(BatchFault(request), testing::AllOf(HasSubstr("runs[2]"), HasSubstr("breath_force: 1000")));
  request = Runs(1);
  request.set_preset("snore");
  EXPECT_THAT(BatchFault(request), HasSubstr("snore"));
  request = Runs(1);
  request.set_seconds(3600);
  request.set_frames_per_second(10000);
  EXPECT_THAT(BatchFault(request), HasSubstr("frames_per_second"));
  request = Runs(1);
  request.add_read(v1::STATE_PART_UNSPECIFIED);
  EXPECT_THAT(BatchFault(request), HasSubstr("read"));
}

TEST(Batch, SaysWhyARunEndedEarlyAndGoesOnWithTheOthers) {
  v1::RunBatchRequest request = Runs(3);
  request.set_seconds(20);
  v1::Parameters& bad = *request.mutable_runs(1)->mutable_parameters();
  bad.set_integrator(v1::INTEGRATOR_EXPLICIT_EULER);
  bad.set_time_step(0.1);
  const auto batch = Batch::Make(request, kCompileRow, kGoOn);
  ASSERT_TRUE(batch.ok()) << batch.status();
  std::map<int, v1::BatchResult> results;
  const auto keep = [&](v1::BatchResult result) { return results.emplace(result.run(), std::move(result)).second; };
  ASSERT_TRUE(RunAll(*batch, keep, kGoOn).ok());
  ASSERT_EQ(results.size(), 3u);
  EXPECT_THAT(results[1].problem(), testing::AllOf(HasSubstr("diverged at"), HasSubstr("row")));
  EXPECT_EQ(results[1].measures_size(), results[1].times_size());
  EXPECT_LT(results[1].times_size(), 400);
  EXPECT_EQ(results[0].problem() + results[2].problem(), "");
  EXPECT_EQ(results[0].times_size(), 400);
}

TEST(Batch, EndsWhenItIsCancelledOrNotTaken) {
  v1::RunBatchRequest request = Runs(50);
  request.set_seconds(600);
  request.set_frames_per_second(1);
  const auto batch = Batch::Make(request, kCompileRow, kGoOn);
  ASSERT_TRUE(batch.ok()) << batch.status();
  const auto take_all = [](v1::BatchResult) { return true; };
  EXPECT_EQ(RunAll(*batch, take_all, [] { return true; }).code(), absl::StatusCode::kCancelled);
  int taken = 0;
  const auto take_two = [&](v1::BatchResult) { return ++taken < 2; };
  request.set_seconds(0.1);
  const auto shorter = Batch::Make(request, kCompileRow, kGoOn);
  EXPECT_EQ(RunAll(*shorter, take_two, kGoOn).code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(taken, 2);
}

// An exception reaches the caller and ends the runs, though most of them wait for room by then.
TEST(Batch, EndsWhenTheCallerThrows) {
  const MakeResult<int> make = [](std::size_t run, const std::function<bool()>&) { return static_cast<int>(run); };
  const auto take_two = [](int run) { return run < 2 ? true : throw std::runtime_error("the disk is full"); };
  EXPECT_THROW(RunOnThreads<int>(1000, 3, make, take_two, kGoOn).IgnoreError(), std::runtime_error);
  const MakeResult<int> endless = [](std::size_t, const std::function<bool()>& ended) -> absl::StatusOr<int> {
    while (!ended()) std::this_thread::yield();
    return absl::CancelledError("ended");
  };
  const auto interrupt = []() -> bool { throw std::runtime_error("interrupted"); };
  EXPECT_THROW(RunOnThreads<int>(
                   9, 2, endless, [](int) { return true; }, interrupt)
                   .IgnoreError(),
               std::runtime_error);
}

}  // namespace
}  // namespace phrenic::study
