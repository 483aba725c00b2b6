// What is worked out range by range gives the bits of the whole, on every instruction set that this machine has and on
// any number of threads.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <random>
#include <set>
#include <thread>

#include "server/mechanics/advance.h"
#include "server/mechanics/forces/spring_rows.h"
#include "server/mechanics/share_out.h"
#include "server/mechanics/vertex_kernel.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// More than two blocks of vertices, the last one no whole number of vectors; springs of two kinds, held at a side.
const char kMixedSheet[] = R"(
  name: "ranges"
  bodies { name: "sheet" role: ROLE_DEFORMABLE mass: 2 grid { columns: 40 rows: 30 u { x: 0.01 } v { y: 0.01 } }
           regions { name: "left" low {} high { x: 0.201 y: 1 z: 1 } } }
  bodies { name: "bone" role: ROLE_AT_REST polyhedron { vertices {} vertices { y: 0.3 } } }
  forces { springs { bodies: "sheet" region: "left" stiffness: 10 rest_length_ratio: 0.9 balanced_at_rest: true } }
  forces { springs { bodies: "sheet" exclude_region: "left" material { youngs_modulus: 5000 thickness: 0.003 } } }
  forces { friction { bodies: "sheet" rate: 3 } }
  forces { attachment { bodies: "sheet" carriers: "bone" radius: 0.05 stiffness: 40 } }
  forces { action_line { bodies: "sheet" origin {} direction { z: -1 } radius: 0.3 force: 2 } }
)";

TEST(Ranges, GiveEachForceTheBitsOfTheWhole) {
  const auto model = CompileText(kMixedSheet);
  ASSERT_NE(model, nullptr);
  State state = model->InitialState();
  ASSERT_GT(state.x.cols(), 2 * kVertexBlock);
  state.phase = 0.3;
  state.x += 0.002 * Points::Random(3, state.x.cols());
  state.v = Points::Random(3, state.x.cols());
  const Instant at = MakeInstant(*model, model->parameters, state);
  for (const auto& force : model->forces) {
    ASSERT_TRUE(force->by_range()) << force->name();
    Points whole = Points::Zero(3, state.x.cols()), parts = whole;
    force->AddForce(at, whole);
    ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
      const Points before = parts;
      force->AddForceIn(block, at, parts);
      Points others = parts - before;
      others.middleCols(block.first, block.end - block.first).setZero();
      EXPECT_EQ(others.norm(), 0) << force->name() << " reaches beyond its range";
    });
    EXPECT_EQ(parts, whole) << force->name();
    EXPECT_GT(whole.norm(), 0) << force->name();
  }
}

TEST(Ranges, KickAndDriftAsVertexByVertexOnEveryInstructionSet) {
  const Eigen::Index vertices = 45;
  const VertexRange range{8, vertices};
  const Points f = Points::Random(3, vertices), x = Points::Random(3, vertices), v = Points::Random(3, vertices);
  Eigen::VectorXd w = Eigen::VectorXd::Random(vertices).cwiseMax(0);  // about half of them fixed
  Points v_plain = v, x_plain = x;
  for (Eigen::Index i = range.first; i < range.end; ++i) {
    if (w[i] == 0) continue;
    v_plain.col(i) += 0.3 * w[i] * f.col(i);
    x_plain.col(i) += 0.7 * v_plain.col(i);
  }
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    Points v_here = v, x_here = x;
    KickAndDrift(range, w, 0.3, 0.7, f, x, v_here, x_here);
    EXPECT_EQ(v_here, v_plain);
    EXPECT_EQ(x_here, x_plain);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// Gives a process of tests its one thread back.
struct OneThreadAgain {
  ~OneThreadAgain() { SetStepThreads(1); }
};

TEST(Ranges, AnyNumberOfThreadsGivesTheSameBits) {
  const OneThreadAgain again;
  std::string large = kMixedSheet;
  large.replace(large.find("columns: 40 rows: 30"), 20, "columns: 120 rows: 90");
  const auto model = CompileText(large);
  ASSERT_NE(model, nullptr);
  std::set<std::uint64_t> hashes;
  for (const int threads : {1, 2, 5}) {
    SetStepThreads(threads);
    hashes.insert(StateHash(RunTo(*model, 0.02, 1e-4)));
  }
  EXPECT_EQ(hashes.size(), 1);
}

TEST(Ranges, OfSpringsInAnOrderOfTheirOwnTooAreSharedOut) {
  const OneThreadAgain again;
  const int vertices = 60 * kVertexBlock + 3;
  std::mt19937 random(2);
  std::uniform_int_distribution<int> vertex(0, vertices - 1);
  std::vector<Spring> springs;
  for (int i = 0; i < 3 * vertices; ++i) springs.push_back({i % vertices, vertex(random), 20, 0.4});
  std::erase_if(springs, [](const Spring& spring) { return spring.a == spring.b; });
  const SpringRows rows(springs, vertices);
  ASSERT_FALSE(rows.InRanges());
  const Points x = Points::Random(3, vertices);
  Points alone = Points::Zero(3, vertices), shared = alone;
  rows.AddForce(1, x, alone);
  SetStepThreads(4);
  rows.AddForce(1, x, shared);
  EXPECT_EQ(alone, shared);
  EXPECT_GT(alone.norm(), 0);
}

TEST(ShareOut, CallsOnceForEachPartFromManyCallersAtOnce) {
  const OneThreadAgain again;
  SetStepThreads(3);
  std::vector<std::thread> callers;
  for (int c = 0; c < 4; ++c) {
    callers.emplace_back([] {
      for (int round = 0; round < 200; ++round) {
        std::vector<int> calls(100);
        ShareOut(100, [&calls](std::int64_t part) { ++calls[static_cast<size_t>(part)]; });
        ASSERT_EQ(calls, std::vector<int>(100, 1));
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
}

}  // namespace
}  // namespace phrenic
