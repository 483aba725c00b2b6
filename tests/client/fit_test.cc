// `phrenic register`, `fit` and `study motion`, on coarse lungs and points of a synthetic person.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "absl/strings/str_cat.h"
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

// `resolution`: in mm; coarse, for speed.
Outcome FitCommand(std::vector<std::string> more, const std::string& resolution = "20") {
  std::vector<std::string> arguments = {"fit", "thorax", "--resolution", resolution};
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
  const Outcome fit = FitCommand({"--exhale", points, "--tidal-volume", "0.4", "--out", scene}, "12");
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
  expect({"--exhale", points, "--volume", points, "--descent", "9"}, 2, "belong to --exhale alone");
  expect({"--landmarks", points, "--error", "colour=1"}, 2, "a kind of landmarks, surface");
  expect({"--landmarks", points, "--error", "volume=1"}, 2, "no --volume is given");
  expect({"--exhale", points, "--volume", points}, 2, "the first line must name the columns time_s and volume_l");
  expect({"--exhale", points, "--m-mode", points + "@up"}, 2, "comes @right or @left");
  expect({"--exhale", points, "--surface", Scratch("none.stl") + "@inhale"}, 1, "cannot read the file of --surface");
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
  expect({"--landmarks", WriteScratch("bad.csv", "a,b\n1,2\n")}, 2, "bad.csv:1: the first line must name the columns");
  expect({"--landmarks", Scratch("none.csv")}, 1, "check the path");
  expect({"--landmarks", WriteScratch("few.csv", EggPerson(150))}, 2, "a fit needs 200");
}

// Quiet breaths of 4 s, of this depth.
std::string RecordedBreaths(const std::string& column, double depth) {
  std::string text = "time_s," + column + "\n";
  for (int i = 0; i < 600; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "%.2f,%.5f\n", 0.04 * i, depth * (1 - std::cos(2 * M_PI * 0.04 * i / 4)) / 2);
    text += line;
  }
  return text;
}

TEST(Fit, OfSeveralKindsTellsHowWellEachIsMet) {
  const std::string pairs = WriteScratch("pairs.csv", EggPerson(700)),
                    spiro = WriteScratch("spiro.csv", RecordedBreaths("volume_l", 0.4)),
                    m_mode = WriteScratch("mmode.csv", RecordedBreaths("displacement_mm", 9)),
                    scene = Scratch("anna.textproto");
  const Outcome fit = FitCommand({"--landmarks", pairs, "--volume", spiro, "--m-mode", m_mode + "@left", "--error",
                                  "m-mode=1.5", "--out", scene, "--residuals", Scratch("left.csv"), "-o", "json"});
  ASSERT_EQ(fit.code, 0) << fit.err;
  const auto json = fit.json();
  ASSERT_EQ(json["kinds"].size(), 5u);
  EXPECT_EQ(json["kinds"][0]["kind"], "landmarks");
  EXPECT_LT(json["kinds"][0]["rms_after"], json["kinds"][0]["rms_still"]);
  EXPECT_GT(json["kinds"][0]["held_out"], 300);
  EXPECT_EQ(json["kinds"][3]["error"], 1.5);
  EXPECT_EQ(json["fitted"][0]["unit"], "mm");
  EXPECT_LT(json["fitted"][0]["standard_error"], json["fitted"][0]["prior_sd"]);
  EXPECT_EQ(json["derived"][0]["name"], "tidal volume");
  EXPECT_EQ(json["baselines"].size(), 5u);
  EXPECT_LT(json["held_out_mean_mm"], json["baselines"][0]["mean_mm"]);
  const Outcome run = Phrenic({"run", scene, "--seconds", "2", "-o", "json"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(ReadAll(scene), HasSubstr("breath_length: 4"));
}

// Breaths of 2 s and 0.5 l, at 25 samples a second.
std::string Spirogram() {
  std::string text = "time_s,volume_l\n";
  for (int i = 0; i < 400; ++i) {
    absl::StrAppend(&text, 0.04 * i, ",", 0.25 - 0.25 * std::cos(std::numbers::pi * 0.04 * i), "\n");
  }
  return text;
}

TEST(Fit, FindsActivationsWhoseBreathIsThatOfARecording) {
  const std::string volume = WriteScratch("spiro.csv", Spirogram()), scene = Scratch("breather.textproto");
  const Outcome fit = Phrenic({"fit", "thorax", "--resolution", "20", "--volume", volume, "--parameters",
                               "diaphragm_activation:0.01:0.3", "--out", scene, "-o", "json"});
  ASSERT_EQ(fit.code, 0) << fit.err;
  const auto json = fit.json();
  EXPECT_EQ(json["fitted"][0]["name"], "diaphragm_activation");
  EXPECT_TRUE(json["fitted"][0]["determined"]);
  EXPECT_EQ(json["derived"][0]["name"], "tidal-volume");
  EXPECT_NEAR(json["derived"][0]["value"].get<double>(), 0.5, 0.07);
  EXPECT_LT(json["kinds"][0]["held_out_rms"], json["kinds"][0]["held_out_rms_still"]);
  EXPECT_THAT(json["preset"].get<std::string>(), HasSubstr("breath_length: 2 diaphragm_activation:"));
  const Outcome run = Phrenic({"run", scene, "--preset", "fitted", "--seconds", "0.2", "-o", "json"});
  EXPECT_EQ(run.code, 0) << run.err;
}

TEST(Fit, OfParametersSaysWhatIsMissing) {
  const std::string volume = WriteScratch("spiro.csv", Spirogram());
  const auto fit = [&](const std::string& parameters, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"fit", "thorax", "--parameters", parameters};
    words.insert(words.end(), more.begin(), more.end());
    return Phrenic(words);
  };
  EXPECT_THAT(fit("diaphragm_activation", {}).err, HasSubstr("--parameters needs data"));
  EXPECT_THAT(fit("diafragm", {"--volume", volume}).err, HasSubstr("diaphragm_activation"));
  EXPECT_THAT(fit("diaphragm_activation", {"--volume", volume, "--descent", "12"}).err, HasSubstr("leave --descent"));
  const Outcome lungs = Phrenic({"fit", "person-1", "--parameters", "lung_pump", "--preset", "", "--volume", volume});
  EXPECT_NE(lungs.code, 0);
}

TEST(Register, ToSurfacesTellsHowFarTheyAre) {
  const std::string points = WriteScratch("exhale.csv", EggPerson(500)), lungs = Scratch("lungs");
  ASSERT_EQ(Phrenic({"register", "thorax", "--resolution", "20", "--exhale", points, "--out", lungs}).code, 0);
  const std::string right = lungs + "/lung-right.obj", left = lungs + "/lung-left.obj";
  const Outcome outcome = Phrenic({"register", "thorax", "--resolution", "20", "--surface", "lung-right=" + right,
                                   "--surface", "lung-left=" + left, "-o", "json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(outcome.json()["structures"].size(), 2u);
  EXPECT_LT(outcome.json()["structures"][0]["mean_mm"], 4);
  EXPECT_LE(outcome.json()["structures"][0]["bent_mean_mm"], outcome.json()["structures"][0]["mean_mm"]);
  const Outcome swapped = Phrenic({"register", "thorax", "--resolution", "20", "--surface", "lung-right=" + left,
                                   "--surface", "lung-left=" + right});
  EXPECT_EQ(swapped.code, 2);
  EXPECT_THAT(swapped.err, HasSubstr("in LPS the left has the larger x"));
  EXPECT_EQ(Phrenic({"register", "thorax"}).code, 2);
  EXPECT_EQ(Phrenic({"register", "thorax", "--surface", "liver=" + left}).code, 2);
}

TEST(Register, WritesTheLungsThatHoldThePoints) {
  const std::string points = WriteScratch("exhale.csv", EggPerson(500));
  const Outcome outcome = Phrenic(
      {"register", "thorax", "--resolution", "20", "--exhale", points, "--out", Scratch("lungs"), "-o", "json"});
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
  const Outcome study = Phrenic({"study", "motion", "--cases", Scratch("people"), "--resolution", "20", "--page",
                                 Scratch("motion.html"), "-o", "csv"});
  ASSERT_EQ(study.code, 0) << study.err;
  EXPECT_THAT(study.out, HasSubstr("person,pairs,descent mm,no motion,rigid shift"));
  EXPECT_THAT(study.out, HasSubstr("\na,"));
  EXPECT_THAT(study.out, HasSubstr("\nmean,"));
  EXPECT_THAT(ReadAll(Scratch("motion.html")), HasSubstr("<h2>b</h2>"));
  const std::vector<std::string> keeping = {"study",        "motion", "--cases", Scratch("people"),
                                            "--resolution", "20",     "--keep",  Scratch("kept"),
                                            "--threads",    "1",      "-o",      "csv"};
  const Outcome first = Phrenic(keeping), second = Phrenic(keeping);
  EXPECT_EQ(first.out, study.out);
  EXPECT_EQ(second.out, study.out);
  EXPECT_EQ(first.err.find("kept from before"), std::string::npos);
  EXPECT_THAT(second.err, HasSubstr("kept from before: 2 of 2 people"));
  const Outcome none = Phrenic({"study", "motion", "--cases", Scratch("nowhere")});
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, HasSubstr("cannot read the folder"));
}

}  // namespace
}  // namespace phrenic::client
