// Any number of threads gives the same bits. ThreadSanitizer runs these as well.
#include "server/mechanics/parallel/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <set>
#include <thread>

#include "absl/strings/str_cat.h"
#include "server/mechanics/block_constraint.h"
#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/forces/spring_rows.h"
#include "server/mechanics/parallel/compile_threads.h"
#include "tests/compile_text.h"
#include "tests/mechanics/mixed_sheet.h"

namespace phrenic {
namespace {

// Gives a process of tests its one thread back.
struct OneThreadAgain {
  ~OneThreadAgain() { SetStepThreads(1); }
};

std::string LargeSheet() {
  std::string large = kMixedSheet;
  return large.replace(large.find("columns: 40 rows: 30"), 20, "columns: 120 rows: 90");
}

// Without springs in double precision, which read others' places: a step is written over its start.
std::string LargeSheetInSingle() {
  std::string large = LargeSheet();
  return large.insert(large.find("balanced_at_rest"), "precision: PRECISION_SINGLE ");
}

// From each vertex of the sheet to one so many places on, so that none has two.
std::string LinksOfTwo(int vertices, int apart) {
  std::string links;
  for (int i = 0; i + apart < vertices; i += i % apart == apart - 1 ? apart + 1 : 1) {
    absl::StrAppend(&links, "links { a: ", i, " b: ", i + apart, " } ");
  }
  return absl::StrCat("constraints { rigid_links { body: \"sheet\" list { ", links, "} } }");
}

// Moves ends of links.
const char kDriven[] =
    " motions { oscillation { body: 'sheet' vertices: [5, 300] amplitude { z: 0.002 } period: 0.1 } }";

// Never acts; with another, both are worked out for all vertices at once.
const char kSlack[] =
    " constraints { length_limits { body: 'sheet' list { links { a: 0 b: 200 } } at_most_ratio: 9 } }";

// What the sheets move for [s]; sanitizers see all code in fewer steps.
#ifdef PHRENIC_SANITIZED
constexpr double kMovedFor = 0.003;
#else
constexpr double kMovedFor = 0.02;
#endif

void ExpectSameBits(const std::vector<std::string>& scenes) {
  const OneThreadAgain again;
  std::set<std::uint64_t> hashes;
  for (const std::string& scene : scenes) {
    const auto model = CompileText(scene);
    ASSERT_NE(model, nullptr);
    for (const int threads : {1, 2, 5}) {
      SetStepThreads(threads);
      const State end = RunTo(*model, kMovedFor, 1e-4);
      hashes.insert(StateHash(end));
      EXPECT_LT(LargestResidual(*model, end).metres, 1e-12);
    }
  }
  EXPECT_EQ(hashes.size(), 1);
}

TEST(ParallelFor, AnyNumberOfThreadsGivesTheSameBits) { ExpectSameBits({LargeSheet()}); }

// The last ones join blocks, some of them, or all. With a second constraint no step is written over its start.
void ExpectSameBitsWithLinks(const std::string& sheet) {
  for (const int apart : {1, 100, 300}) {
    const std::string scene = sheet + kDriven + LinksOfTwo(120 * 90, apart);
    const auto model = CompileText(scene);
    ASSERT_NE(model, nullptr);
    EXPECT_NE(dynamic_cast<const BlockConstraint*>(model->constraints.front().get()), nullptr)
        << "threads restore none of them";
    ExpectSameBits({scene, scene + kSlack});
  }
}

TEST(ParallelFor, RigidLinksToo) { ExpectSameBitsWithLinks(LargeSheet()); }

TEST(ParallelFor, StepsWrittenOverTheirStartToo) { ExpectSameBitsWithLinks(LargeSheetInSingle()); }

TEST(ParallelFor, SpringsInAnOrderOfTheirOwnToo) {
  const OneThreadAgain again;
  const int vertices = 120 * kVertexBlock + 3;
  std::mt19937 random(2);
  std::uniform_int_distribution<int> vertex(0, vertices - 1);
  std::vector<Spring> springs;
  for (int i = 0; i < 3 * vertices; ++i) springs.push_back({i % vertices, vertex(random), 20, 0.4});
  std::erase_if(springs, [](const Spring& spring) { return spring.a == spring.b; });
  const SpringRows rows(springs, vertices);
  ASSERT_FALSE(rows.InRanges());
  const Points x = Points::Random(3, vertices);
  Points alone = Points::Zero(3, vertices), shared = alone;
  rows.AddForce(1, x, Scratch(), alone);
  SetStepThreads(4);
  rows.AddForce(1, x, Scratch(), shared);
  EXPECT_EQ(alone, shared);
  EXPECT_GT(alone.norm(), 0);
}

TEST(ParallelFor, CallsOnceForEachPartFromManyCallersAtOnce) {
  const OneThreadAgain again;
  for (const int threads : {3, 20}) {
    SetStepThreads(threads);
    std::vector<std::thread> callers;
    for (int c = 0; c < 4; ++c) {
      callers.emplace_back([] {
        for (int round = 0; round < 200; ++round) {
          std::vector<int> calls(100);
          ParallelFor(100, [&calls](std::int64_t part) { ++calls[static_cast<size_t>(part)]; });
          ASSERT_EQ(calls, std::vector<int>(100, 1));
        }
      });
    }
    for (std::thread& caller : callers) caller.join();
  }
}

TEST(ForEachPart, CallsEachPartOnceOnAnyNumberOfThreads) {
  const int before = CompileThreads();
  for (const int threads : {1, 2, 5, 16}) {
    SetCompileThreads(threads);
    for (const int parts : {0, 1, 3, 700}) {
      std::vector<std::atomic<int>> calls(static_cast<size_t>(parts));
      ForEachPart(parts, [&](std::int64_t part) { ++calls[part]; });
      for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
    }
  }
  SetCompileThreads(before);
}

TEST(ForEachPart, LeavesOutWhatFollowsAStop) {
  const int before = CompileThreads();
  SetCompileThreads(1);
  int asked = 0, done = 0;
  ForEachPartUntil(
      1000, [&] { return ++asked > 3; }, [&](std::int64_t) { ++done; });
  EXPECT_EQ(done, 3);
  ForEachPartUntil(
      1000, [] { return false; }, [&](std::int64_t) { ++done; });
  EXPECT_EQ(done, 1003);
  SetCompileThreads(before);
}

}  // namespace
}  // namespace phrenic
