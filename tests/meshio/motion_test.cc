#include "server/meshio/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace phrenic::meshio {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kTriangle[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$Nodes\n3\n10 0 0 0\n7 1 0 0\n3000000000 1 1 0\n$EndNodes\n"
    "$Elements\n1\n1 2 2 1 1 10 7 3000000000\n$EndElements\n";

// Returns a time step. Its rows are in another order than the nodes.
std::string Step(const std::string& time, double z) {
  return absl::StrCat("$NodeData\n1\n\"displacement\"\n1\n", time, "\n3\n0\n3\n3\n7 0 0 ", z, "\n10 0 0 ", 2 * z,
                      "\n3000000000 0 0 ", 3 * z, "\n$EndNodeData\n");
}

TEST(Motion, StepsGiveTimesAndDisplacements) {
  const std::string other = "$NodeData\n1\n\"pressure\"\n1\n0\n3\n0\n1\n1\n7 5\n$EndNodeData\n";
  const auto motion = ParseMotion("a.msh", kTriangle + Step("0", 0) + other + Step("0.5", 10), 0.001);
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_TRUE(motion->moves());
  EXPECT_THAT(motion->times, ElementsAre(0, 0.5));
  ASSERT_EQ(motion->displacements.size(), 2U);
  EXPECT_EQ(motion->displacements[0], Points::Zero(3, 3));
  EXPECT_NEAR(motion->displacements[1](2, 0), 0.02, 1e-15) << "node 10 is vertex 0";
  EXPECT_NEAR(motion->displacements[1](2, 1), 0.01, 1e-15);
}

TEST(Motion, AFileWithoutDisplacementsHasNoTimes) {
  const auto msh = ParseMotion("a.msh", kTriangle, 0.001);
  ASSERT_TRUE(msh.ok()) << msh.status();
  EXPECT_FALSE(msh->moves());
  EXPECT_TRUE(msh->times.empty());
  const auto obj = ParseMotion("a.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1);
  ASSERT_TRUE(obj.ok()) << obj.status();
  EXPECT_FALSE(obj->moves());
}

TEST(Motion, StepsInOtherVersionsAreRejectedNotIgnored) {
  const std::string still =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
      "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n";
  const auto motion = ParseMotion("a.msh", still, 1);
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_FALSE(motion->moves());
  const auto moving = ParseMotion("a.msh", still + Step("0", 0), 1);
  EXPECT_EQ(moving.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(moving.status().message()), HasSubstr("MSH 2.2 in text"));
}

struct BadMotion {
  const char* from;
  const char* to;
  const char* words;
};

TEST(Motion, ErrorsNameTheLineAndTheProblem) {
  const BadMotion cases[] = {
      {"10 0 0 4\n", "", "a.msh:38: the step has rows for 2 of 3 nodes"},
      {"10 0 0 4\n", "7 0 0 4\n", "a.msh:37: node 7 is there twice"},
      {"10 0 0 4\n", "11 0 0 4\n", "a.msh:37: there is no node 11"},
      {"10 0 0 4\n", "10 0 nan 4\n", "a.msh:37: a row is written"},
      {"10 0 0 4\n", "10 0 0\n", "a.msh:37: a row is written"},
      {"1\n0.5\n", "1\n0\n", "not after that of the step before"},
      {"1\n0.5\n", "1\nsoon\n", "its time [s]"},
      {"1\n0.5\n", "0\n", "its time [s]"},
      {"1\n0.5\n3\n0\n3\n", "1\n0.5\n3\n0\n1\n", "three integer tags"},
      {"1\n0.5\n3\n", "1\n0.5\n-3\n", "the number of the view's integer tags"},
  };
  const std::string good = kTriangle + Step("0", 0) + Step("0.5", 2);
  for (const BadMotion& bad : cases) {
    const std::string text = absl::StrReplaceAll(good, {{bad.from, bad.to}});
    ASSERT_NE(text, good) << bad.from;
    const auto motion = ParseMotion("a.msh", text, 1);
    ASSERT_FALSE(motion.ok()) << bad.words;
    EXPECT_EQ(motion.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(motion.status().message()), HasSubstr(bad.words));
  }
}

}  // namespace
}  // namespace phrenic::meshio
