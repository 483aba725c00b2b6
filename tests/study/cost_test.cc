// The cost study: every part has its rows, parts that are left out are not compiled, and stages sum to the step. Times
// are compared only with other times of the same run, with wide tolerances.
#include "server/study/cost.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "server/study/cost_parts.h"
#include "server/study/cost_sizes.h"
#include "server/study/cost_trials.h"
#include "server/study/queue/run.h"
#include "server/study/thesis_tables.h"
#include "server/study/timed_model.h"
#include "tests/compile_text.h"
#include "tests/mechanics/breathing/free_cage.h"
#include "tests/study/run_on.h"

namespace phrenic::study {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;
using testing::Not;
using testing::StartsWith;

// A sheet with many kinds of elements, attached to a fixed post. The compile step cannot leave out its contact.
const char kSheet[] = R"(
  name: "sheet" title: "Sheet"
  bodies {
    name: "post" role: ROLE_AT_REST
    polyhedron { vertices { x: -0.05 } vertices { x: 0.95 } edges { a: 0 b: 1 } }
  }
  bodies {
    name: "floor" role: ROLE_AT_REST
    polyhedron {
      vertices { x: -9 y: -9 z: -0.2 } vertices { x: 9 y: -9 z: -0.2 } vertices { y: 9 z: -0.2 }
      triangles { a: 0 b: 1 c: 2 }
    }
  }
  bodies {
    name: "sheet" role: ROLE_DEFORMABLE mass_lumping: MASS_LUMPING_BY_STIFFNESS
    grid { columns: 10 rows: 10 u { x: 0.1 } v { y: 0.1 } }
    material { density: 1030 thickness: 0.003 }
  }
  motions { oscillation { body: "sheet" vertices: [90, 99] amplitude { z: 0.02 } period: 2 } }
  forces { springs { bodies: "sheet" stiffness: 50 } }
  forces { membrane { bodies: "sheet" } }
  forces { bending { bodies: "sheet" } }
  forces { cables { body: "sheet" } }
  forces { friction { bodies: "sheet" rate: 3 } }
  forces { gravity { bodies: "sheet" acceleration { z: -1 } } }
  forces { attachment { bodies: "sheet" anchors: "post" radius: 0.15 stiffness: 20 } }
  forces { action_line { bodies: "sheet" origin { x: 0.5 y: 0.5 } direction { z: 1 } radius: 0.3 force: 1 air_load: 0.5 } }
  forces { contact { bodies: "sheet" surfaces: "floor" depth: 0.01 load: 1 } }
  constraints { rigid_links { body: "sheet" list { links { a: 44 b: 46 } links { a: 64 b: 66 } } } }
  constraints { length_limits { body: "sheet" at_most_ratio: 1.5 } }
)";

v1::CreateStudyRequest CostRequest(int steps, int trials) {
  v1::CreateStudyRequest request;
  request.mutable_cost()->set_steps(steps);
  request.mutable_cost()->set_trials(trials);
  return request;
}

std::string FileText(const std::string& name) {
  std::ifstream file(std::string(PHRENIC_SOURCE_DIR) + "/server/scenes/" + name + ".textproto");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

v1::Scene SceneFile(const std::string& name) { return *schema::ParseScene(name, FileText(name)); }

std::map<std::string, v1::CostRow> RowsOf(const v1::CostTable& table) {
  std::map<std::string, v1::CostRow> rows;
  for (const v1::CostRow& row : table.rows()) rows[row.variant()] = row;
  return rows;
}

// The study of the small sheet, run once.
const v1::CostTable& SheetTable() {
  static const auto* const table = new v1::CostTable(RunOn(kSheet, CostRequest(20, 3))->cost());
  return *table;
}

TEST(CostStudy, HasARowForEveryPartOfTheScene) {
  const auto rows = RowsOf(SheetTable());
  for (const std::string part : {"springs", "membrane", "bending", "cables", "friction", "gravity", "attachments",
                                 "muscles", "contact", "links", "length limits", "oscillation"}) {
    EXPECT_TRUE(rows.contains("without " + part)) << part;
  }
  EXPECT_TRUE(rows.contains("full, repeated"));
  EXPECT_TRUE(rows.contains("links switched off"));
  EXPECT_TRUE(rows.contains("muscles switched off"));
  EXPECT_FALSE(rows.contains("without ribs"));
  EXPECT_FALSE(rows.contains("contact left out"));
}

TEST(CostStudy, CountsElements) {
  auto rows = RowsOf(SheetTable());
  EXPECT_EQ(rows["full"].links(), 2);
  EXPECT_GT(rows["full"].springs(), 0);
  EXPECT_EQ(rows["without links"].links(), 0);
  EXPECT_EQ(rows["links left out"].links(), 0);
  EXPECT_EQ(rows["links switched off"].links(), 2);
  EXPECT_EQ(rows["without springs"].springs(), 0);
  EXPECT_EQ(rows["springs left out"].springs(), 0);
  for (const auto& [name, row] : rows) EXPECT_EQ(row.vertices(), 100) << name;
}

TEST(CostStudy, DoesNotCompileEmptyParts) {
  int left_out = 0;
  for (const v1::CostRow& row : SheetTable().rows()) {
    EXPECT_THAT(row.note(), Not(HasSubstr("NOT leave it out"))) << row.variant();
    left_out += row.variant().ends_with(" left out");
  }
  EXPECT_EQ(left_out, 10);  // all but contact and oscillation
  auto rows = RowsOf(SheetTable());
  EXPECT_THAT(rows["friction left out"].note(), HasSubstr("its rate is 0"));
  EXPECT_THAT(rows["gravity left out"].note(), HasSubstr("its acceleration is 0"));
}

TEST(CostStudy, TimesArePositiveAndAgreeWithEachOther) {
  for (const v1::CostRow& row : SheetTable().rows()) {
    EXPECT_GT(row.cpu_us_per_step(), 0) << row.variant();
    EXPECT_NEAR(row.steps_per_s() * row.cpu_us_per_step(), 1e6, 1) << row.variant();
    EXPECT_NEAR(row.ns_per_vertex_step() * 100, 1e3 * row.cpu_us_per_step(), 1e-3 * row.cpu_us_per_step());
    EXPECT_GE(row.spread(), 0);
    EXPECT_GT(row.share(), 0);
    const bool compared = row.variant().ends_with(" left out") || row.variant().ends_with(" switched off") ||
                          row.variant() == "full, repeated";
    EXPECT_EQ(row.has_over_never_had(), compared) << row.variant();
  }
  EXPECT_EQ(SheetTable().rows(0).variant(), "full");
  EXPECT_EQ(SheetTable().rows(0).share(), 1);
}

// Fraction of the step that an element takes, by clocks inside.
double InsideFraction(const v1::CostTable& table, const std::string& element) {
  double whole = 0, part = 0;
  for (const v1::StageRow& row : table.stages()) {
    if (row.stage() == "step") whole = row.us_per_step();
    if (row.element().find(element) != std::string::npos) part += row.us_per_step();
  }
  return part / whole;
}

// Leaving a part out and clocks inside agree within the noise of the machine.
TEST(CostStudy, MeasuresTheMostExpensivePart) {
  const double inside = InsideFraction(SheetTable(), "bending");
  EXPECT_GT(inside, 0.2);
  EXPECT_NEAR(1 - RowsOf(SheetTable())["without bending"].share(), inside, 0.2);
}

TEST(CostStudy, StagesSumToTheStep) {
  double sum = 0, whole = 0;
  int joint = 0;
  std::map<std::string, int> stages;
  for (const v1::StageRow& row : SheetTable().stages()) {
    ++stages[row.stage()];
    joint += row.element().find("friction") != std::string::npos && row.element().find("gravity") != std::string::npos;
    (row.stage() == "step" ? whole : sum) += row.us_per_step();
    EXPECT_TRUE(row.us_per_step() >= 0 || row.stage() == "integrator") << row.element();
  }
  EXPECT_NEAR(sum, whole, 1e-9 * whole);
  EXPECT_GT(whole, 0);
  EXPECT_EQ(stages["force"], 7);
  EXPECT_EQ(joint, 1);  // friction, gravity and action line are one batch
  EXPECT_EQ(stages["motion"], 1);
  EXPECT_EQ(stages["constraint"], 2);
  EXPECT_EQ(stages["integrator"], 1);
  EXPECT_EQ(stages["stiffness"], 0);  // an explicit integrator needs none
}

TEST(CostStudy, StagesCountTheIntegratorsCalls) {
  v1::CreateStudyRequest request = CostRequest(20, 1);
  request.mutable_parameters()->set_integrator(v1::INTEGRATOR_RUNGE_KUTTA_4);
  const auto result = RunOn(kSheet, request);
  ASSERT_TRUE(result.ok()) << result.status();
  for (const v1::StageRow& row : result->cost().stages()) {
    EXPECT_TRUE(row.stage() != "force" || row.calls_per_step() == 4) << row.element();
  }
}

// A second study of the small sheet, and the progress that it reported.
struct Repeated {
  absl::StatusOr<v1::StudyResult> result;
  std::vector<double> progress;
};

const Repeated& RepeatedStudy() {
  static const Repeated* const repeated = [] {
    auto* made = new Repeated;
    made->result = RunOn(kSheet, CostRequest(20, 3), [made](double done, std::string_view) {
      made->progress.push_back(done);
      return true;
    });
    return made;
  }();
  return *repeated;
}

TEST(CostStudy, RepeatsExactlyExceptForTimes) {
  const absl::StatusOr<v1::StudyResult>& again = RepeatedStudy().result;
  ASSERT_TRUE(again.ok()) << again.status();
  const v1::CostTable &a = SheetTable(), &b = again->cost();
  ASSERT_EQ(a.rows_size(), b.rows_size());
  for (int i = 0; i < a.rows_size(); ++i) {
    EXPECT_EQ(a.rows(i).variant(), b.rows(i).variant());
    EXPECT_EQ(a.rows(i).note(), b.rows(i).note());
    EXPECT_EQ(a.rows(i).springs(), b.rows(i).springs());
  }
  ASSERT_EQ(a.stages_size(), b.stages_size());
  for (int i = 0; i < a.stages_size(); ++i) {
    EXPECT_EQ(a.stages(i).element(), b.stages(i).element());
    EXPECT_EQ(a.stages(i).calls_per_step(), b.stages(i).calls_per_step());
  }
}

TEST(CostStudy, GrowsInProportionToTheVertices) {
  v1::CreateStudyRequest request = CostRequest(20, 3);
  request.mutable_cost()->set_largest_sheet(8000);
  const auto result = RunOn(kSheet, request);
  ASSERT_TRUE(result.ok()) << result.status();
  const v1::CostTable& table = result->cost();
  ASSERT_EQ(table.growth_size(), 4);
  EXPECT_NEAR(static_cast<double>(table.growth(0).vertices()), 1000, 20);
  EXPECT_NEAR(static_cast<double>(table.growth(3).vertices()), 8000, 50);
  EXPECT_NEAR(table.growth_exponent(), 1, 0.35);
  EXPECT_FALSE(table.growth(0).has_exponent());
  EXPECT_TRUE(table.growth(3).has_exponent());
}

TEST(CostStudy, StopsWhenCancelled) {
  for (const double end : {0.0, 0.1, 0.3, 0.52, 0.85}) {
    v1::CreateStudyRequest request = CostRequest(10, 1);
    request.mutable_cost()->set_largest_sheet(100);
    double furthest = 0;
    const auto result = RunOn(kSheet, request, [&](double done, std::string_view) {
      furthest = done;
      return done < end;
    });
    EXPECT_TRUE(absl::IsCancelled(result.status())) << end;
    EXPECT_LT(furthest, end + 0.3);
  }
}

TEST(CostStudy, ProgressOnlyGrows) {
  const auto& [result, progress] = RepeatedStudy();
  EXPECT_TRUE(result.ok());
  EXPECT_FALSE(progress.empty());
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_THAT(progress, Each(AllOf(Ge(0), Le(1))));
}

TEST(CostStudy, ComparesTheCubesWithFigure510) {
  const auto result = RunOn(FileText("cube-tensegrity"), CostRequest(200, 1));
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->cost().sizes_size(), 1);
  const v1::SizeRow& row = result->cost().sizes(0);
  EXPECT_EQ(row.what(), "cube");
  EXPECT_EQ(row.links(), 4);
  EXPECT_NEAR(row.thesis_steps_per_s(), 100'000 / 4.2654, 1e-6);
  EXPECT_NEAR(row.thesis_steps_per_s_without_links(), 100'000 / 3.345, 1e-6);
  EXPECT_GT(row.steps_per_s(), row.thesis_steps_per_s());
  auto rows = RowsOf(result->cost());
  EXPECT_THAT(rows["full"].thesis(), HasSubstr("with rigid links"));
  EXPECT_THAT(rows["without links"].thesis(), HasSubstr("springs alone"));
  EXPECT_FALSE(rows["without gravity"].has_thesis_steps_per_s());
}

TEST(CostStudy, ShowsEveryTrialAndTheSpreadOfTheLinksCost) {
  const auto result = RunOn(FileText("cube-tensegrity"), CostRequest(200, 4));
  ASSERT_TRUE(result.ok()) << result.status();
  const v1::SizeRow& row = result->cost().sizes(0);
  EXPECT_LE(row.links_cost_least_percent(), row.links_cost_percent() + 1e-9);
  EXPECT_GE(row.links_cost_most_percent(), row.links_cost_percent() - 1e-9);
  std::map<std::string, int> trials;
  for (const v1::TrialRow& trial : result->cost().trials()) ++trials[trial.variant()];
  EXPECT_EQ(trials["full"], 4);
  EXPECT_EQ(trials["cube"], 4);
  EXPECT_EQ(trials["cube, without links"], 4);
}

TEST(CostStudy, KeepsItsBudgetAndSaysWhatItLeftOut) {
  v1::CreateStudyRequest request = CostRequest(1'000'000, 100);
  request.mutable_cost()->set_most_seconds(2);
  request.mutable_cost()->set_largest_sheet(100'000);
  const auto result = RunOn(kSheet, request);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_LT(result->took_s(), 60);
  ASSERT_GT(result->cost().notes_size(), 0);
  EXPECT_THAT(result->cost().notes(0),
              AllOf(HasSubstr("it takes about"), HasSubstr("most_seconds"),
                    AnyOf(HasSubstr("variants of the scene"), HasSubstr("the scene without"))));
}

// A dome that is inserted on a free cage: there is no scene without its ribs.
TEST(CostStudy, LeavesOutTheScenesThatNeedThePart) {
  const auto result =
      RunOn(FreeCage("forces { wall_contact { bodies: 'sheet' wall: 'wall' } }").c_str(), CostRequest(20, 1));
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_THAT(result->cost().notes(), Contains(AllOf(HasSubstr("without ribs"), HasSubstr("pump handle"))));
  EXPECT_TRUE(RowsOf(result->cost()).contains("without wall contact"));
}

TEST(CostParts, AreThoseOfTheScene) {
  const v1::Scene thorax = SceneFile("thorax-thesis");
  EXPECT_THAT(PartsOf(thorax), ElementsAre("ribs", "springs", "friction", "attachments", "muscles", "lungs", "links"));
  EXPECT_TRUE(PartsOf({}).empty());
  for (const std::string& part : PartsOf(thorax)) {
    EXPECT_THAT(PartsOf(Without(thorax, part)), Not(Contains(part)));
    EXPECT_EQ(PartsOf(Without(thorax, part)).size(), 6);
  }
}

TEST(CostParts, WithoutRibsNothingIsDriven) {
  const v1::Scene scene = Without(SceneFile("thorax-thesis"), "ribs");
  for (const v1::Body& body : scene.bodies()) EXPECT_NE(body.role(), v1::ROLE_DRIVEN) << body.name();
}

TEST(CostTrials, MediansAndSpreads) {
  EXPECT_EQ(Median({}), 0);
  EXPECT_EQ(Median({3, 1, 2}), 2);
  EXPECT_EQ(Median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(MiddleMean({1, 2}), 1.5);
  EXPECT_EQ(MiddleMean({100, 2, -7, 4}), 3);
  EXPECT_EQ(Spread({2}), 0);
  EXPECT_EQ(Spread({1, 2, 3}), 1);
  EXPECT_EQ(MedianRatio({.subject = {}, .again = {}, .steps = 1, .step_s = {}, .part_s = {2, 8, 9}, .problem = ""},
                        {.subject = {}, .again = {}, .steps = 1, .step_s = {}, .part_s = {1, 2, 9}, .problem = ""}),
            2);
}

TEST(CostGrowth, FitsPowersExactly) {
  EXPECT_NEAR(FitExponent({10, 100, 1000}, {3, 3 * std::pow(10, 1.5), 3000}), 1.5, 1e-12);
  EXPECT_NEAR(FitExponent({1, 2, 4, 8}, {5, 10, 20, 40}), 1, 1e-12);
  EXPECT_EQ(FitExponent({7}, {1}), 0);
}

TEST(CostGrowth, SheetsHaveTheirSize) {
  for (const int size : {4, 625, 5000, 1'000'000}) {
    const v1::Scene scene = SheetOf(size);
    const v1::Grid& grid = scene.bodies(0).grid();
    EXPECT_NEAR(grid.columns() * grid.rows(), size, 0.51 * grid.columns()) << size;
  }
}

// Clocks do not change the motion: a timed model steps to the same bits.
TEST(TimedModel, StepsToTheSameState) {
  const auto model = CompileText(kSheet);
  Stages stages;
  const auto timed = Timed(*model, stages);
  for (const v1::Integrator integrator :
       {v1::INTEGRATOR_SEMI_IMPLICIT_EULER, v1::INTEGRATOR_VELOCITY_VERLET, v1::INTEGRATOR_TR_BDF2}) {
    v1::Parameters parameters = model->parameters;
    parameters.set_integrator(integrator);
    State a = model->InitialState(), b = a;
    Workspace work = model->MakeWorkspace(), timed_work = timed->MakeWorkspace();
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(Step(*model, parameters, parameters.time_step(), a, work).ok());
      ASSERT_TRUE(Step(*timed, parameters, parameters.time_step(), b, timed_work).ok());
    }
    EXPECT_EQ(StateHash(a), StateHash(b));
  }
}

TEST(ThesisTables, AreThoseOfTheCorrespondingModel) {
  const v1::Scene thorax = SceneFile("thorax-thesis"), cube = SceneFile("cube-springs"), sheet = SceneFile("sheet-2d");
  EXPECT_EQ(LikeThesisFigure(thorax, 20900, ThesisTrial::kFull)->steps_per_second, 8.13);
  EXPECT_EQ(LikeThesisFigure(thorax, 20900, ThesisTrial::kNoLinks)->steps_per_second, 8.56);
  EXPECT_EQ(LikeThesisFigure(thorax, 16000, ThesisTrial::kNoMuscles)->steps_per_second, 10.93);
  EXPECT_EQ(LikeThesisFigure(thorax, 20900, ThesisTrial::kNoRibs)->steps_per_second, 9.68);
  EXPECT_NEAR(LikeThesisFigure(thorax, 20900, ThesisTrial::kNoAttachments)->steps_per_second, 100 / 12.2994, 1e-9);
  EXPECT_THAT(LikeThesisFigure(SceneFile("thorax-patient-thesis"), 20740, ThesisTrial::kFull)->what,
              StartsWith("fig. 5.24, patient model, high"));
  EXPECT_NEAR(LikeThesisFigure(cube, 8, ThesisTrial::kNoLinks)->steps_per_second, 29895.4, 0.1);
  EXPECT_FALSE(LikeThesisFigure(cube, 8, ThesisTrial::kNoRibs).has_value());
  v1::Scene other = cube;
  other.mutable_bodies(0)->mutable_polyhedron()->mutable_vertices(6)->set_x(9);
  EXPECT_FALSE(LikeThesisFigure(other, 8, ThesisTrial::kNoLinks).has_value()) << "eight vertices, but no cube";
  EXPECT_FALSE(LikeThesisFigure(thorax, 2000, ThesisTrial::kFull).has_value());
  EXPECT_FALSE(LikeThesisFigure(sheet, 20900, ThesisTrial::kFull).has_value());
  EXPECT_EQ(LikeThesisSizes(thorax, 20900).size(), 3);
  EXPECT_TRUE(LikeThesisSizes(sheet, 54).empty());
}

}  // namespace
}  // namespace phrenic::study
