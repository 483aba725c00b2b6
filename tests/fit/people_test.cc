// The five people of ../shared/data/motion; skipped where they are absent.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "server/fit/motion_study.h"
#include "server/fit/read_landmarks.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/step/step.h"
#include "server/schema/schema.h"
#include "tests/fit/template_lungs.h"

namespace phrenic::fit {
namespace {

constexpr char kPeople[] = PHRENIC_SHARED_DIR "/data/motion/landmarks";

class FivePeople : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kPeople)) GTEST_SKIP() << kPeople << " is absent: the motion of five people";
  }

  static const std::vector<StudyCase>& Cases() {
    static const auto* const cases = new std::vector<StudyCase>(*ReadCases(kPeople));
    return *cases;
  }
  static MotionStudy Study(int numbers) {
    FitOptions options;
    options.numbers = numbers;
    return *StudyMotion(GeneratedLungs(), Cases(), options);
  }
  static const MotionStudy& EightNumbers() {
    static const auto* const study = new MotionStudy(Study(8));
    return *study;
  }

  static ErrorSummary Own(const MotionStudy& study) {
    std::vector<ErrorSummary> errors;
    for (const StudiedPerson& person : study.people) errors.push_back(person.fit.held_out);
    return MeanOf(errors);
  }
  static ErrorSummary Predicted(const MotionStudy& study) {
    std::vector<ErrorSummary> errors;
    for (const StudiedPerson& person : study.people) errors.push_back(*person.from_one_number);
    return MeanOf(errors);
  }
};

// The prototype, another program with bricks of another shape and another search (../shared/prototypes/motion, run on
// these five people), has 1.15, 1.66, 1.99, 2.64 and 2.14 mm, a mean of 1.91, and 2.57 mm from one number.
TEST_F(FivePeople, AreFittedByEightNumbersAsThePrototypeFitsThem) {
  const MotionStudy& study = EightNumbers();
  const double prototype[] = {1.15, 1.66, 1.99, 2.64, 2.14};
  ASSERT_EQ(study.people.size(), 5u);
  for (size_t i = 0; i < 5; ++i) {
    const MotionFit& fit = study.people[i].fit;
    std::printf("%s: %.2f mm, from one number %.2f\n", study.people[i].name.c_str(), 1e3 * fit.held_out.mean,
                1e3 * study.people[i].from_one_number->mean);
    EXPECT_NEAR(1e3 * fit.held_out.mean, prototype[i], 0.12) << study.people[i].name;
    for (const Baseline& plain : fit.baselines) {
      if (plain.numbers >= 8) continue;
      EXPECT_LT(fit.held_out.mean, plain.held_out.mean) << plain.name;
    }
  }
  std::printf("mean %.2f, from one number %.2f\n", 1e3 * Own(study).mean, 1e3 * Predicted(study).mean);
  EXPECT_LE(Own(study).mean, 0.0026);
  EXPECT_NEAR(1e3 * Own(study).mean, 1.91, 0.06);
  EXPECT_LE(Predicted(study).mean, 0.0037);
  EXPECT_NEAR(1e3 * Predicted(study).mean, 2.57, 0.1);
}

TEST_F(FivePeople, AreFittedBetterByTwelveNumbersThanByAnAffineMapOfTwelve) {
  const MotionStudy study = Study(12);
  EXPECT_NEAR(1e3 * Own(study).mean, 1.74, 0.06);
  for (const StudiedPerson& person : study.people) {
    EXPECT_LT(person.fit.held_out.mean, person.fit.baselines.back().held_out.mean) << person.name;
  }
}

TEST_F(FivePeople, ShowThatLungsSlide) {
  FitOptions glued;
  glued.elasticity.tangential = glued.elasticity.contact;
  const auto fit = FitMotion(GeneratedLungs(), Cases()[2].landmarks, glued);
  ASSERT_TRUE(fit.ok()) << fit.status();
  std::printf("glued %.2f mm\n", 1e3 * fit->held_out.mean);
  EXPECT_GT(fit->held_out.mean, 1.5 * 0.00199);
}

// Few points are not refused where axes are right; wrong axes are refused, or doubted.
TEST_F(FivePeople, HaveAxesThatFewPointsTell) {
  int refused = 0, doubted = 0, unseen = 0, wrong_refused = 0;
  const auto judge_wrong = [&](const Points& points) {
    const auto sides = FindSides(points);
    wrong_refused += sides.ok() ? 0 : 1;
    unseen += sides.ok() && sides->doubts.empty() ? 1 : 0;
  };
  for (const StudyCase& each : Cases()) {
    const int count = static_cast<int>(each.landmarks.size());
    for (int start = 0; start < 20; ++start) {
      std::vector<int> some;
      for (int i = 0; i < 200; ++i) some.push_back((start * 61 + 7919 * i) % count);
      const Points points = each.landmarks.exhale(Eigen::all, some);
      const auto sides = FindSides(points);
      refused += sides.ok() ? 0 : 1;
      doubted += sides.ok() && !sides->doubts.empty() ? 1 : 0;
      for (int axis = 0; axis < 3; ++axis) {
        Points reversed = points;
        reversed.row(axis) *= -1;
        judge_wrong(reversed);
      }
      judge_wrong(points({1, 0, 2}, Eigen::all));
    }
  }
  std::printf("of 100 samples of 200 points %d refused, %d doubted; of 400 with a wrong axis %d refused, %d unseen\n",
              refused, doubted, wrong_refused, unseen);
  EXPECT_EQ(refused, 0);
  EXPECT_LE(unseen, 4);
  EXPECT_GE(wrong_refused, 200);
}

TEST_F(FivePeople, AreNotDoubtedWithAllTheirPoints) {
  for (const StudyCase& each : Cases()) {
    const auto sides = FindSides(each.landmarks.exhale);
    ASSERT_TRUE(sides.ok()) << each.name << sides.status();
    EXPECT_TRUE(sides->doubts.empty()) << each.name << ": " << sides->doubts.front();
  }
}

// The numbers that ship are those of the scene's finer lungs.
TEST_F(FivePeople, GiveTheNumbersThatShip) {
  const PeopleMotion found = EightNumbers().together;
  const PeopleMotion& shipped = ShippedPeople(8);
  for (Eigen::Index i = 0; i < 8; ++i) {
    EXPECT_NEAR(found.mean[i], shipped.mean[i], 0.05) << i;
    EXPECT_NEAR(found.spread[i], shipped.spread[i], 0.05) << i;
  }
}

// The three people that ship as scenes, by the landmarks that their fits have not seen.
class ShippedPeople : public testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  // The scene with a body that has a vertex at each point, inside the lungs.
  static absl::StatusOr<std::shared_ptr<const Model>> CompileWith(const Points& points) {
    const std::string file = std::string(PHRENIC_SCENES_DIR) + "/" + GetParam().first + ".textproto";
    std::ifstream stream(file);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    auto scene = schema::ParseScene(file, text);
    if (!scene.ok()) return scene.status();
    v1::Body& body = *scene->add_bodies();
    body.set_name("points");
    body.set_role(v1::ROLE_DEFORMABLE);
    for (const auto& point : points.colwise()) {
      v1::Vector& vertex = *body.mutable_polyhedron()->add_vertices();
      vertex.set_x(point.x()), vertex.set_y(point.y()), vertex.set_z(point.z());
    }
    scene->mutable_motions(0)->mutable_lung_modes()->add_inside("body:points");
    return Compile(*scene, [](const v1::Body& lung) { return anatomy::Generate(lung.anatomy(), 6); });
  }
};

TEST_P(ShippedPeople, MoveAsTheirLandmarksDo) {
  const std::string file = std::string(kPeople) + "/" + GetParam().second + ".csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent: the motion of a person";
  const auto landmarks = ReadLandmarks({file});
  ASSERT_TRUE(landmarks.ok()) << landmarks.status();
  const Halves halves = SplitInHalves(static_cast<int>(landmarks->size()), 1);
  const Landmarks unseen = Select(*landmarks, halves.held_out);
  const auto model = CompileWith(unseen.exhale);
  ASSERT_TRUE(model.ok()) << model.status();
  State state = (*model)->InitialState();
  Workspace work = (*model)->MakeWorkspace();
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(Step(**model, (*model)->parameters, 0.01, state, work).ok());
  const Points moved = (state.x - (*model)->rest).rightCols(unseen.size());
  const double error = Summarise(unseen.motion - moved).mean, still = Summarise(unseen.motion).mean;
  std::printf("%s: %.2f mm, without motion %.2f mm\n", GetParam().first, 1e3 * error, 1e3 * still);
  EXPECT_LT(error, 0.0021);
  EXPECT_LT(error, 0.35 * still);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedPeople,
                         testing::Values(std::pair("person-1", "case1"), std::pair("person-2", "case3"),
                                         std::pair("person-3", "case5")),
                         [](const auto& person) { return std::string(person.param.second); });

}  // namespace
}  // namespace phrenic::fit
