// Verdicts of a credibility report, from evidence that the test makes up; and the command on a tiny scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/cli/study_inputs.h"
#include "client/credibility/command_text.h"
#include "client/credibility/context_file.h"
#include "client/credibility/report.h"
#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr char kStated[] = R"(
  title: "t" question: "Which way?" decision: "Show it." context_of_use: "In class."
  model_influence: RISK_LEVEL_LOW model_influence_reason: "beside a textbook"
  decision_consequence: RISK_LEVEL_LOW decision_consequence_reason: "none"
  outputs { measure: "height" statistic: STATISTIC_LAST }
)";

v1::CredibilityContext UseOf(const std::string& more) {
  const auto context = ParseCredibilityContext("use", kStated + more);
  EXPECT_TRUE(context.ok()) << context.status();
  return *context;
}

Evidence EvidenceOf(double value) {
  Evidence evidence;
  evidence.scene = "weight";
  evidence.scene_hash = "1a2b";
  v1::NumberRow& row = evidence.numbers.emplace_back();
  row.set_name("bench.mm");
  row.set_value(value);
  row.set_command("measure it");
  return evidence;
}

v1::CredibilityReport ReportOf(const std::string& more, const Evidence& evidence) {
  auto report = MakeCredibilityReport(UseOf(more), evidence, {});
  EXPECT_TRUE(report.ok()) << report.status();
  return *report;
}

v1::SectionVerdict VerdictOf(const v1::CredibilityReport& report, v1::CredibilitySection section) {
  return report.sections(section - 1).verdict();
}

constexpr char kBench[] = R"(
  criteria { section: CREDIBILITY_SECTION_BENCH number: "bench.mm" at_most: 2 }
)";

TEST(CredibilityReport, HasFifteenSectionsEachWithAVerdict) {
  const v1::CredibilityReport report = ReportOf(kBench, EvidenceOf(1));
  ASSERT_EQ(report.sections_size(), 15);
  for (int i = 0; i < 15; ++i) {
    EXPECT_EQ(report.sections(i).section(), i + 1);
    EXPECT_NE(report.sections(i).verdict(), v1::SECTION_VERDICT_UNSPECIFIED) << i;
    EXPECT_FALSE(report.sections(i).asked().empty());
    EXPECT_FALSE(report.sections(i).reason().empty());
  }
}

TEST(CredibilityReport, ASectionIsMetPartlyMetOrNotShownByItsCriteria) {
  const auto bench = [](const std::string& more, double value) {
    return VerdictOf(ReportOf(more, EvidenceOf(value)), v1::CREDIBILITY_SECTION_BENCH);
  };
  EXPECT_EQ(bench(kBench, 1), v1::SECTION_VERDICT_MET);
  EXPECT_EQ(bench(kBench, 3), v1::SECTION_VERDICT_NOT_SHOWN);
  const std::string two =
      std::string(kBench) + R"(criteria { section: CREDIBILITY_SECTION_BENCH number: "bench.mm" at_least: 2 })";
  EXPECT_EQ(bench(two, 3), v1::SECTION_VERDICT_PARTLY);
  EXPECT_EQ(bench(two, 2), v1::SECTION_VERDICT_MET);
  EXPECT_EQ(bench("", 1), v1::SECTION_VERDICT_NOT_SHOWN);
}

TEST(CredibilityReport, WithoutEvidenceACriterionDoesNotHoldAndIsMissing) {
  const v1::CredibilityReport report = ReportOf(
      R"(criteria { section: CREDIBILITY_SECTION_CODE_VERIFICATION number: "exact.passed_percent" at_least: 1 })",
      EvidenceOf(1));
  EXPECT_EQ(VerdictOf(report, v1::CREDIBILITY_SECTION_CODE_VERIFICATION), v1::SECTION_VERDICT_NOT_SHOWN);
  EXPECT_EQ(report.sections(3).criteria(0).verdict(), "no evidence");
  EXPECT_THAT(report.sections(3).missing(0), HasSubstr("exact.passed_percent must be at least 1: no evidence"));
}

TEST(CredibilityReport, RefusesACriterionOfANumberThatNoEvidenceHas) {
  const auto report = MakeCredibilityReport(
      UseOf(R"(criteria { section: CREDIBILITY_SECTION_BENCH number: "bench.m" at_most: 2 })"), EvidenceOf(1), {});
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("no number \"bench.m\"; did you mean bench.mm?"));
}

TEST(CredibilityReport, IsAdequateIfEveryRequiredSectionIsMet) {
  const std::string required = "required_sections: [CREDIBILITY_SECTION_QUESTION, CREDIBILITY_SECTION_BENCH]";
  EXPECT_TRUE(ReportOf(kBench + required, EvidenceOf(1)).adequate());
  EXPECT_FALSE(ReportOf(kBench + required, EvidenceOf(3)).adequate());
  // Without a list the risk decides: in vivo validation is not asked for at low risk, and nothing is met here.
  EXPECT_FALSE(ReportOf(kBench, EvidenceOf(1)).adequate());
}

TEST(CredibilityReport, SaysOfWhichSceneItsEvidenceIsAndWhatCannotBeRepeated) {
  Evidence evidence = EvidenceOf(1);
  EXPECT_EQ(VerdictOf(ReportOf("", evidence), v1::CREDIBILITY_SECTION_REPEATABILITY), v1::SECTION_VERDICT_MET);
  evidence.of_other_scenes = {"uncertainty, of scene 3c4d"};
  EXPECT_EQ(VerdictOf(ReportOf("", evidence), v1::CREDIBILITY_SECTION_REPEATABILITY), v1::SECTION_VERDICT_PARTLY);
  evidence.of_other_scenes.clear();
  evidence.numbers[0].clear_command();
  EXPECT_EQ(VerdictOf(ReportOf("", evidence), v1::CREDIBILITY_SECTION_REPEATABILITY), v1::SECTION_VERDICT_PARTLY);
}

TEST(ModelRisk, IsByTheSumOfInfluenceAndConsequence) {
  const auto risk = [](v1::RiskLevel influence, v1::RiskLevel consequence) {
    v1::CredibilityContext context;
    context.set_model_influence(influence);
    context.set_decision_consequence(consequence);
    return ModelRiskOf(context);
  };
  EXPECT_EQ(risk(v1::RISK_LEVEL_LOW, v1::RISK_LEVEL_MEDIUM), v1::RISK_LEVEL_LOW);
  EXPECT_EQ(risk(v1::RISK_LEVEL_HIGH, v1::RISK_LEVEL_LOW), v1::RISK_LEVEL_MEDIUM);
  EXPECT_EQ(risk(v1::RISK_LEVEL_MEDIUM, v1::RISK_LEVEL_HIGH), v1::RISK_LEVEL_HIGH);
  EXPECT_EQ(risk(v1::RISK_LEVEL_UNSPECIFIED, v1::RISK_LEVEL_HIGH), v1::RISK_LEVEL_UNSPECIFIED);
  EXPECT_THAT(RequiredAt(v1::RISK_LEVEL_HIGH), SizeIs(14));
  EXPECT_THAT(RequiredAt(v1::RISK_LEVEL_LOW), testing::Not(Contains(v1::CREDIBILITY_SECTION_IN_VIVO)));
  EXPECT_THAT(RequiredAt(v1::RISK_LEVEL_MEDIUM), Contains(v1::CREDIBILITY_SECTION_IN_VIVO));
}

TEST(CredibilityContext, NamesFileAndFieldOfWhatIsWrong) {
  const auto error = [](const std::string& more) {
    return std::string(ParseCredibilityContext("use.textproto", kStated + more).status().message());
  };
  EXPECT_THAT(error("criteria { number: \"a\" at_most: 1 }"),
              HasSubstr("use.textproto: criteria[0].section: must be set"));
  EXPECT_THAT(error("criteria { section: CREDIBILITY_SECTION_BENCH number: \"a\" }"), HasSubstr("needs at_least or"));
  EXPECT_THAT(error("criteria { section: CREDIBILITY_SECTION_BENCH number: \"a\" at_least: 2 at_most: 1 }"),
              HasSubstr("no number meets it"));
  EXPECT_THAT(error("evidence { name: \"a\" what: \"w\" source: \"s\" }"), HasSubstr("needs a value, or a file"));
  EXPECT_THAT(error("uncertainty { }"), HasSubstr("inputs: sensitivity and uncertainty need at least one"));
  EXPECT_THAT(error("criterium { }"), HasSubstr("use.textproto:"));
  EXPECT_THAT(std::string(ParseCredibilityContext("u", "title: \"t\"").status().message()), HasSubstr("question"));
}

TEST(ExactCases, AreReadFromGoogleTest) {
  const auto cases = ParseExactCases("exact.json", R"({"testsuites": [{"name": "Beam", "testsuite": [
    {"name": "Sags", "result": "COMPLETED"},
    {"name": "Twists", "result": "COMPLETED", "failures": [{}]},
    {"name": "Waits", "result": "SKIPPED"},
    {"name": "DISABLED_Sleeps", "result": "SUPPRESSED"},
    {"name": "SaysNothing"}]}]})");
  ASSERT_TRUE(cases.ok()) << cases.status();
  EXPECT_EQ((*cases)[0].verdict(), "pass");
  EXPECT_EQ((*cases)[1].verdict(), "FAILED");
  for (const size_t not_run : {2, 3, 4}) EXPECT_EQ((*cases)[not_run].verdict(), "skipped") << not_run;
  for (const char* bad : {"", "{", "[]", R"({"testsuites": 3})", R"({"testsuites": [{"testsuite": [{}]}]})",
                          R"({"testsuites": [3]})", R"({"testsuites": []})"}) {
    EXPECT_THAT(std::string(ParseExactCases("exact.json", bad).status().message()), HasSubstr("exact.json")) << bad;
  }
}

TEST(EvidenceInJson, IsTheNumberAtItsPointer) {
  const std::string text = R"({"a": [{"b": 2.5}], "c": "x"})";
  EXPECT_EQ(*NumberInJson("f.json", text, "/a/0/b"), 2.5);
  for (const char* bad : {"", "a", "/c", "/a/1/b", "/a/-/b", "/~", "/d"}) {
    EXPECT_FALSE(NumberInJson("f.json", text, bad).ok()) << bad;
  }
  EXPECT_THAT(std::string(NumberInJson("f.json", "{", "/a").status().message()), HasSubstr("f.json is not JSON"));
}

TEST(Orders, AreThoseOfTheSmallestStepThatConverged) {
  v1::ErrorTable table;
  for (const auto& [integrator, order, verdict] : {std::tuple{"velocity_verlet", 1.2, "ok"},
                                                   {"velocity_verlet", 1.95, "ok"},
                                                   {"velocity_verlet", 0.1, "out of time"},
                                                   {"bdf2", 1.5, "ok"},
                                                   {"thesis", 0.0, "ok"}}) {
    v1::ErrorRow& row = *table.add_rows();
    row.set_integrator(integrator);
    row.set_order(order);
    row.set_verdict(verdict);
  }
  const auto orders = OrdersOf(table);
  ASSERT_THAT(orders, SizeIs(2));
  EXPECT_EQ(orders[0].measured(), 1.95);
  EXPECT_EQ(orders[0].verdict(), "pass");
  EXPECT_EQ(orders[1].verdict(), "FAILED");
}

TEST(StudyCommand, IsWhatAPersonTypes) {
  v1::UncertaintyStudy study;
  *study.add_inputs() = *ReadUncertainInput("lung_compliance:normal:1:0.2");
  *study.add_outputs() = *ReadStudiedOutput("lung volume:amplitude");
  study.set_samples(8);
  v1::Parameters parameters;
  parameters.set_right_activation(0);
  EXPECT_EQ(
      StudyCommand("uncertainty", "thorax", "quiet", parameters, study),
      "phrenic study uncertainty thorax --preset quiet --set right_activation=0 --vary lung_compliance:normal:1:0.2 "
      "--measure 'lung volume:amplitude' --samples 8");
}

TEST(StudyInputs, AreReadAndBadOnesAreQuoted) {
  EXPECT_EQ(ReadUncertainInput("elasticity:0.5:2")->uniform().high(), 2);
  EXPECT_EQ(ReadUncertainInput("elasticity:triangular:0:1:2")->triangular().mode(), 1);
  EXPECT_EQ(ReadUncertainInput("elasticity:lognormal:1:1.5")->log_normal().factor(), 1.5);
  EXPECT_EQ(ReadUncertainInput("elasticity:uniform:1:2")->uniform().low(), 1);
  for (const char* bad :
       {"", "elasticity", "elasticity:1", "elasticity:a:b", "elasticity:normal:1", ":1:2", "a:b:1:2"}) {
    EXPECT_THAT(std::string(ReadUncertainInput(bad).status().message()), HasSubstr("is not of the form")) << bad;
  }
  EXPECT_EQ(ReadStudiedOutput("tidal-volume")->statistic(), v1::STATISTIC_UNSPECIFIED);
  EXPECT_THAT(std::string(ReadStudiedOutput("volume:most").status().message()), HasSubstr("there are mean, minimum"));
}

constexpr char kWeight[] = R"(
  name: "weight" title: "Weight"
  bodies {
    name: "weight" role: ROLE_DEFORMABLE mass: 0.2
    polyhedron { vertices { } vertices { z: -0.1 } edges { a: 0 b: 1 } }
    fixed_vertices: 0
  }
  forces { springs { bodies: "weight" stiffness: 50 } }
  forces { gravity { bodies: "weight" acceleration { z: -9.81 } } }
  measures { name: "height" highest { body: "weight" direction { z: -1 } point { z: -0.1 } } }
  parameters { integrator: INTEGRATOR_STATIC breath_length: 0.5 time_step: 0.01 }
)";

constexpr char kUse[] = R"(
  inputs { parameter: "elasticity" uniform { low: 0.8 high: 1.2 } }
  sensitivity { trajectories: 2 }
  uncertainty { samples: 16 }
  convergence { halvings: 1 }
  cases { name: "sag" what: "it hangs" output { measure: "height" statistic: STATISTIC_LAST } }
  cases { name: "stiff" what: "it hangs higher" parameters { elasticity: 2 } output { measure: "height" statistic: STATISTIC_LAST } }
  criteria { section: CREDIBILITY_SECTION_EMERGENT_BEHAVIOUR number: "case.sag" at_least: 0.0196 at_most: 0.01964 }
  criteria { section: CREDIBILITY_SECTION_EMERGENT_BEHAVIOUR number: "case.stiff" at_least: 0.0098 at_most: 0.00982 }
  criteria { section: CREDIBILITY_SECTION_CALCULATION_VERIFICATION number: "convergence.time_step_percent" at_most: 0.01 }
  criteria { section: CREDIBILITY_SECTION_UNCERTAINTY number: "uncertainty.height, last.p95" at_most: 0.0245 }
  criteria { section: CREDIBILITY_SECTION_UNCERTAINTY number: "sensitivity.least_predicted_percent" at_least: 99 }
  required_sections: [CREDIBILITY_SECTION_EMERGENT_BEHAVIOUR, CREDIBILITY_SECTION_CALCULATION_VERIFICATION,
                      CREDIBILITY_SECTION_UNCERTAINTY, CREDIBILITY_SECTION_REPEATABILITY]
)";

TEST(Credibility, OfATinySceneIsMadeFromItsRuns) {
  const std::string scene = WriteScratch("weight.textproto", kWeight);
  const std::string use = WriteScratch("use.textproto", std::string(kStated) + kUse);
  const Outcome made = Phrenic({"credibility", scene, "--use", use, "--check", "-o", "json"});
  ASSERT_EQ(made.code, 0) << made.err << made.out;
  EXPECT_EQ(made.json()["sections"].size(), 15u);
  EXPECT_EQ(made.json()["adequate"], true);
  const std::string worse =
      WriteScratch("worse.textproto",
                   std::string(kStated) + kUse +
                       "criteria { section: CREDIBILITY_SECTION_EMERGENT_BEHAVIOUR number: \"case.sag\" at_least: 1 }");
  EXPECT_EQ(Phrenic({"credibility", scene, "--use", worse, "--check"}).code, 4);
  const Outcome shown = Phrenic({"credibility", scene, "--use", worse, "--budget", "0"});
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("case.sag must be at least 1: no evidence"));
}

TEST(Credibility, NamesTheFileOfBadEvidence) {
  const std::string scene = WriteScratch("weight.textproto", kWeight);
  const std::string use = WriteScratch("use.textproto", std::string(kStated) + kUse);
  const std::string bad = WriteScratch("bad.json", "{}");
  for (const char* flag : {"--exact", "--uncertainty", "--physiology", "--orders"}) {
    const Outcome outcome = Phrenic({"credibility", scene, "--use", use, flag, bad});
    EXPECT_EQ(outcome.code, 2) << flag;
    EXPECT_THAT(outcome.err, HasSubstr("bad.json")) << flag;
  }
  EXPECT_THAT(Phrenic({"credibility", scene, "--use", "/nowhere"}).err, HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace phrenic::client
