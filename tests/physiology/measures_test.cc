// The measures of a breath cannot be fooled, and agree with a script that reads exported vertices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "server/physiology/physiology.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

using physiology::Subject;

constexpr char kPython[] = "/usr/bin/python3";  // Debian's

class Measures : public testing::Test {
 protected:
  static void SetUpTestSuite() { model_ = CompileShipped("thorax", 10); }
  static void TearDownTestSuite() { model_.reset(); }

  static Points RestingSheet(const Subject& subject) {
    return model_->bodies[static_cast<size_t>(subject.parts.sheet)].mesh.vertices;
  }

  inline static std::shared_ptr<const Model> model_;
};

TEST_F(Measures, AgreeWithAScriptThatReadsExportedVertices) {
  if (std::system((std::string(kPython) + " -c 'import numpy' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "numpy is not installed (python3-numpy)";
  }
  const std::string motion = testing::TempDir() + "phrenic_columns.msh", out = testing::TempDir() + "phrenic_columns";
  const std::string run = PHRENIC_BINARY_DIR
      "/phrenic run thorax --resolution 10 --preset quiet --seconds 8 --fps 10 --body diaphragm "
      "--body diaphragm-middle --body chest-wall --export ";
  ASSERT_EQ(std::system((run + motion + " >" + out + " 2>&1").c_str()), 0);
  const std::string script = std::string(kPython) + " " PHRENIC_SOURCE_DIR "/tests/physiology/columns_from_files.py ";
  ASSERT_EQ(std::system((script + motion + " 4 >" + out).c_str()), 0);
  const auto table =
      physiology::CheckPhysiology(*model_, std::vector<std::string>{"quiet"}, [](double) { return true; });
  ASSERT_TRUE(table.ok()) << table.status();
  std::ifstream numbers(out);
  for (const std::string what : {"right dome, descent at the apex", "right dome, descent 40 mm behind",
                                 "left dome, descent at the apex", "left dome, descent 40 mm behind", "tidal volume"}) {
    double value = NAN;
    ASSERT_TRUE(numbers >> value) << what;
    const auto row = std::find_if(table->rows().begin(), table->rows().end(),
                                  [&](const auto& each) { return each.breath() == "quiet" && each.what() == what; });
    ASSERT_NE(row, table->rows().end()) << what;
    EXPECT_NEAR(row->value(), value, what == "tidal volume" ? 0.02 * value : 0.5) << what;
  }
  std::remove(motion.c_str());
}

TEST_F(Measures, ADomeThatMovesForwardDescendsWhereItWas) {
  const auto subject = *Subject::Of(*model_);
  Points sheet = RestingSheet(*subject);
  const auto rest = subject->columns.Heights(sheet);
  sheet.row(1).array() -= 0.03;
  const auto moved = subject->columns.Heights(sheet);
  EXPECT_GT(rest[physiology::Columns::kRightBack] - moved[physiology::Columns::kRightBack], 0.003);
}

TEST_F(Measures, ADomeThatIsPunchedInIsHollow) {
  const auto subject = *Subject::Of(*model_);
  Points sheet = RestingSheet(*subject);
  EXPECT_LT(subject->columns.Hollow(sheet, v1::SIDE_RIGHT), 0.001);
  const Eigen::Vector2d apex = subject->columns.At(physiology::Columns::kRightApex);
  for (auto x : sheet.colwise()) x.z() -= 0.03 * std::exp(-(x.head<2>() - apex).squaredNorm() / (2 * 0.02 * 0.02));
  EXPECT_GT(subject->columns.Hollow(sheet, v1::SIDE_RIGHT), 0.003);
  EXPECT_LT(subject->columns.Hollow(sheet, v1::SIDE_LEFT), 0.003);
}

TEST_F(Measures, ASheetThatWidensIsPiercedByTheRibs) {
  const auto subject = *Subject::Of(*model_);
  State state = model_->InitialState();
  EXPECT_EQ(subject->flaws.At(state)[physiology::kPiercingRibs], 0);
  state.x.leftCols(model_->coordinates.front().vertex).row(0) *= 1.15;
  EXPECT_GT(subject->flaws.At(state)[physiology::kPiercingRibs], 10);
}

TEST_F(Measures, AShrunkenSheetIsShortInEveryDirection) {
  const auto subject = *Subject::Of(*model_);
  const Points& rest = model_->bodies[static_cast<size_t>(subject->parts.muscle)].mesh.vertices;
  const Points shrunk = 0.8 * rest;
  EXPECT_NEAR(subject->fibres.Shortening(rest, shrunk), 0.2, 1e-9);
  EXPECT_NEAR(subject->fibres.SectionShortening(0, -0.06, rest, shrunk), 0.2, 1e-9);
  EXPECT_NEAR(subject->fibres.SectionShortening(1, 0, rest, shrunk), 0.2, 1e-9);
  EXPECT_NEAR(subject->fibres.StrainAcross(0.5, rest, shrunk), 0.2, 1e-9);
  EXPECT_NEAR(subject->fibres.TendonAreaChange(rest, shrunk), 0.36, 1e-9);
}

TEST_F(Measures, AnUnknownPresetIsRefusedWithTheKnownOnes) {
  const auto table =
      physiology::CheckPhysiology(*model_, std::vector<std::string>{"snore"}, [](double) { return true; });
  EXPECT_EQ(table.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(std::string(table.status().message()).find("quiet"), std::string::npos);
}

TEST_F(Measures, MorePresetsThanATableTakesAreRefusedAtOnce) {
  const std::vector<std::string> many(100'000, "quiet");
  const auto table = physiology::CheckPhysiology(*model_, many, [](double) { return false; });
  EXPECT_EQ(table.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(std::string(table.status().message()).find("at most 256"), std::string::npos) << table.status();
}

}  // namespace
}  // namespace phrenic
