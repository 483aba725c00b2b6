// The five people of ../shared/data/motion; skipped where they are absent.
#include <gtest/gtest.h>

#include <filesystem>

#include "server/fit/motion_study.h"
#include "tests/fit/template_lungs.h"

namespace phrenic::fit {
namespace {

constexpr char kPeople[] = PHRENIC_SHARED_DIR "/data/motion/landmarks";

class FivePeople : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kPeople)) GTEST_SKIP() << kPeople << " is absent: the motion of five people";
  }

  static void Print(const MotionStudy& study) {
    for (const StudiedPerson& person : study.people) {
      const MotionFit& fit = person.fit;
      std::printf("%s: %5.2f p95 %5.2f | one number %5.2f | descent %.2f volume %.0f ml |", person.name.c_str(),
                  1e3 * fit.held_out.mean, 1e3 * fit.held_out.p95, 1e3 * person.from_one_number->mean,
                  1e3 * fit.descent, 1e6 * fit.volume);
      for (const Baseline& baseline : fit.baselines) std::printf(" %.2f", 1e3 * baseline.held_out.mean);
      std::printf("\n   ");
      for (const FittedNumber& n : fit.parameters) {
        std::printf(" %s %.1f+-%.1f%s", n.name.c_str(), 1e3 * n.value, 1e3 * n.standard_error, n.determined ? "" : "?");
      }
      for (const Registration& r : fit.registered.lungs) {
        std::printf(" | s %.2f %.2f %.2f out %.3f %.1f", r.scale.x(), r.scale.y(), r.scale.z(), r.outside,
                    1e3 * r.farthest);
      }
      std::printf("\n");
    }
    for (Eigen::Index i = 0; i < study.together.mean.size(); ++i) {
      std::printf(" %.3f+-%.3f", study.together.mean[i], study.together.spread[i]);
    }
    std::printf("\n");
  }
};

TEST_F(FivePeople, AreFittedAsWellAsTheAimsSay) {
  const auto cases = ReadCases(kPeople);
  ASSERT_TRUE(cases.ok()) << cases.status();
  for (const int numbers : {8, 12}) {
    FitOptions options;
    options.numbers = numbers;
    options.assimilate = numbers == 8;
    const auto study = StudyMotion(GeneratedLungs(), *cases, options);
    ASSERT_TRUE(study.ok()) << study.status();
    Print(*study);
    std::vector<ErrorSummary> own, predicted, through;
    for (const StudiedPerson& person : study->people) {
      own.push_back(person.fit.held_out);
      predicted.push_back(*person.from_one_number);
      if (person.fit.assimilated) through.push_back(*person.fit.assimilated);
    }
    std::printf("mean %.3f p95 %.3f one number %.3f %.3f\n", 1e3 * MeanOf(own).mean, 1e3 * MeanOf(own).p95,
                1e3 * MeanOf(predicted).mean, 1e3 * MeanOf(predicted).p95);
    if (!through.empty()) std::printf("through %.3f p95 %.3f\n", 1e3 * MeanOf(through).mean, 1e3 * MeanOf(through).p95);
    EXPECT_LE(MeanOf(own).mean, 0.0026);
    EXPECT_LE(MeanOf(predicted).mean, 0.0037);
  }
}

}  // namespace
}  // namespace phrenic::fit
