// `phrenic register`, `fit` and `study motion`, on coarse lungs and points of a synthetic person.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;

// Two egg-shaped lungs with a heart's dent in the left one; the tissue moves down, more at the base. In mm, LPS.
std::string EggPerson(int count) {
  std::string text = "exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z\n";
  for (int i = 0; i < count; ++i) {
    const auto part = [&](double step) { return std::fmod(step * (i + 1), 1.0); };
    const double z = part(0.6180339887), angle = 2 * M_PI * part(0.7548776662), radius = std::sqrt(part(0.5698402910));
    const double side = i % 2 == 0 ? -1 : 1, width = 30 + 25 * (1 - z),
                 x = side * 75 + radius * width * std::cos(angle),
                 y = 30 * z + radius * (40 + 25 * (1 - z)) * std::sin(angle);
    if (side > 0 && z < 0.5 && y < -10 && x < 80) continue;  // the heart
    const double down = 2 + 9 * (1 - z) * (1 + y / 150);
    char line[200];
    std::snprintf(line, sizeof line, "%.2f,%.2f,%.2f,%.2f,%.2f,%.2f\n", x, y, 200 * z, x, y - 0.5, 200 * z - down);
    text += line;
  }
  return text;
}

Outcome FitCommand(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"fit", "thorax", "--resolution", "12"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Phrenic(arguments);
}

TEST(Fit, ReportsHeldOutErrorsBaselinesAndParameters) {
  const std::string pairs = WriteScratch("pairs.csv", EggPerson(700)), left = Scratch("left.csv");
  const Outcome fit = FitCommand({"--landmarks", pairs, "--residuals", left, "-o", "json"});
  ASSERT_EQ(fit.code, 0) << fit.err;
  const auto json = fit.json();
  EXPECT_EQ(json["parameters"].size(), 8u);
  EXPECT_EQ(json["parameters"][0]["unit"], "mm");
  EXPECT_GT(json["parameters"][0]["standard_error"], 0);
  EXPECT_EQ(json["baselines"].size(), 5u);
  EXPECT_LT(json["held_out_mean_mm"], json["baselines"][1]["mean_mm"]);
  EXPECT_GE(json["held_out_p95_mm"], json["held_out_mean_mm"]);
  EXPECT_THAT(ReadAll(left), HasSubstr("residual_x,residual_y,residual_z,held_out\n"));
  const Outcome again = FitCommand({"--landmarks", pairs, "-o", "json"});
  EXPECT_EQ(again.out, fit.out);
}

TEST(Fit, OfOneNumberExpectsAMotionWithItsSpread) {
  const std::string points = WriteScratch("exhale.csv", EggPerson(500));
  const Outcome expected = FitCommand({"--exhale", points, "--descent", "13", "-o", "json"});
  ASSERT_EQ(expected.code, 0) << expected.err;
  const auto json = expected.json();
  EXPECT_NEAR(json["descent_mm"], 13, 1e-9);
  EXPECT_GT(json["tidal_volume_l"], 0.05);
  EXPECT_GT(json["regions"][0]["spread_mm"], 0);
  const std::string volume = json["tidal_volume_l"].dump();
  const Outcome inverse = FitCommand({"--exhale", points, "--tidal-volume", volume, "-o", "json"});
  ASSERT_EQ(inverse.code, 0) << inverse.err;
  EXPECT_NEAR(inverse.json()["descent_mm"], 13, 0.05);
}

TEST(Fit, WritesASceneThatRunsAndCanBeFittedAgain) {
  const std::string pairs = WriteScratch("pairs.csv", EggPerson(700)), scene = Scratch("anna.textproto");
  const Outcome fit = FitCommand({"--landmarks", pairs, "--out", scene, "--show-landmarks", "-o", "json"});
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(ReadAll(scene), HasSubstr("# Written by phrenic fit"));
  const Outcome run = Phrenic({"run", scene, "--preset", "bases-alone", "--seconds", "2", "-o", "json"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Outcome again = Phrenic({"fit", scene, "--landmarks", pairs, "-o", "json"});
  ASSERT_EQ(again.code, 0) << again.err;
  const double error = fit.json()["held_out_mean_mm"], error_again = again.json()["held_out_mean_mm"];
  EXPECT_NEAR(error_again, error, 0.1 * error) << "its lungs are near the person's already";
}

TEST(Fit, OfOneNumberWritesASceneToo) {
  const std::string points = WriteScratch("exhale.csv", EggPerson(500)), scene = Scratch("expected.textproto");
  const Outcome fit = FitCommand({"--exhale", points, "--tidal-volume", "0.4", "--out", scene});
  ASSERT_EQ(fit.code, 0) << fit.err;
  const Outcome run = Phrenic({"run", scene, "--seconds", "2", "-o", "json"});
  ASSERT_EQ(run.code, 0) << run.err;
  double gain = 0;
  const auto json = run.json();
  for (const auto& measure : json["measures"]) {
    if (measure["name"] == "lung volume") gain = measure["maximum"].get<double>() - measure["minimum"].get<double>();
  }
  EXPECT_NEAR(gain, 0.0004, 0.00005) << json["measures"];
}

TEST(Fit, WritesNoSceneThatWouldBeRefused) {
  const std::string points = WriteScratch("exhale.csv", EggPerson(500)), scene = Scratch("far.textproto");
  const Outcome fit = FitCommand({"--exhale", points, "--descent", "150", "--out", scene});
  EXPECT_NE(fit.code, 0);
  EXPECT_THAT(fit.err, HasSubstr("beyond that of a breath"));
  EXPECT_EQ(fit.err.find("wrote"), std::string::npos);
}

TEST(Fit, InvalidRequestsNameTheOptionOrTheRemedy) {
  const std::string points = WriteScratch("exhale.csv", EggPerson(500));
  const auto expect = [](std::vector<std::string> more, int code, const std::string& text) {
    const Outcome outcome = FitCommand(std::move(more));
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(text));
    EXPECT_EQ(outcome.out, "");
  };
  expect({}, 2, "give --landmarks with pairs");
  expect({"--exhale", points}, 2, "--exhale needs one number");
  expect({"--exhale", points, "--descent", "9", "--tidal-volume", "0.4"}, 2, "--exhale needs one number");
  expect({"--exhale", points, "--descent", "-3"}, 2, "--descent");
  expect({"--exhale", points, "--descent", "3", "--assimilate"}, 2, "belong to --landmarks");
  expect({"--landmarks", points, "--out", "x.stl"}, 2, ".textproto");
  expect({"--landmarks", points, "--out", ".textproto"}, 2, "NAME.textproto");
  expect({"--landmarks", points, "--source", "a\xff"}, 2, "--source");
  expect({"--landmarks", points, "--split", "-1"}, 2, "--split");
  expect({"--landmarks", points, "--show-landmarks"}, 2, "--show-landmarks");
  expect({"--landmarks", points, "--modes", "9"}, 2, "--modes");
  expect({"--landmarks", WriteScratch("bad.csv", "a,b\n1,2\n")}, 1, "bad.csv:1: the first line must name the columns");
  expect({"--landmarks", Scratch("none.csv")}, 1, "check the path");
  expect({"--landmarks", WriteScratch("few.csv", EggPerson(150))}, 1, "a fit needs 200");
}

TEST(Register, WritesTheLungsThatHoldThePoints) {
  const std::string points = WriteScratch("exhale.csv", EggPerson(500));
  const Outcome outcome = Phrenic(
      {"register", "thorax", "--resolution", "12", "--exhale", points, "--out", Scratch("lungs"), "-o", "json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["lungs"].size(), 2u);
  EXPECT_LT(outcome.json()["lungs"][0]["outside"], 0.1);
  EXPECT_TRUE(std::filesystem::exists(Scratch("lungs/lung-left.obj")));
  const Outcome lungless = Phrenic({"register", "cube-springs", "--exhale", points});
  EXPECT_EQ(lungless.code, 1);
  EXPECT_THAT(lungless.err, HasSubstr("has no right lung"));
}

TEST(StudyMotion, MakesATableAndAPage) {
  WriteScratch("cases.csv", "");
  std::filesystem::create_directories(Scratch("people"));
  WriteScratch("people/a.csv", EggPerson(500));
  WriteScratch("people/b.csv", EggPerson(600));
  const Outcome study = Phrenic({"study", "motion", "--cases", Scratch("people"), "--resolution", "12", "--page",
                                 Scratch("motion.html"), "-o", "csv"});
  ASSERT_EQ(study.code, 0) << study.err;
  EXPECT_THAT(study.out, HasSubstr("person,pairs,descent mm,no motion,rigid shift"));
  EXPECT_THAT(study.out, HasSubstr("\na,"));
  EXPECT_THAT(study.out, HasSubstr("\nmean,"));
  EXPECT_THAT(ReadAll(Scratch("motion.html")), HasSubstr("<h2>b</h2>"));
  const Outcome none = Phrenic({"study", "motion", "--cases", Scratch("nowhere")});
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, HasSubstr("cannot read the folder"));
}

}  // namespace
}  // namespace phrenic::client
