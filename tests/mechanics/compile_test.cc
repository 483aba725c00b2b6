#include "server/mechanics/compile/compile.h"

#include <gmock/gmock.h>

#include "server/mechanics/stability/diagnosis.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const char kBody[] =
    "name: 'scene' bodies { name: 'sheet' layer: 'tissue' role: ROLE_DEFORMABLE mass: 1 grid { columns: 3 rows: 3 u { "
    "x: "
    "1 } v { y: 1 } } } ";

std::string ErrorOf(const std::string& rest, const std::string& body = kBody) {
  const auto model = TryCompileText(body + rest);
  if (model.ok()) return "it compiled";
  EXPECT_EQ(model.status().code(), absl::StatusCode::kInvalidArgument) << model.status();
  return std::string(model.status().message());
}

TEST(Compile, ErrorsNameTheFieldAndTheRemedy) {
  EXPECT_THAT(ErrorOf("forces { springs { bodies: 'lnug' } }"),
              AllOf(HasSubstr("forces[0].springs.bodies[0]"), HasSubstr("lnug"), HasSubstr("tissue")));
  EXPECT_THAT(ErrorOf("forces { springs { bodies: 'sheet' stiffness: -5 } }"),
              AllOf(HasSubstr("forces[0].springs.stiffness"), HasSubstr("-5"), HasSubstr("N/m")));
  EXPECT_THAT(ErrorOf("forces { springs { bodies: 'sheet' region: 'tendon' } }"), HasSubstr("no region \"tendon\""));
  EXPECT_THAT(ErrorOf("forces {}"), HasSubstr("forces[0]: says no kind"));
  EXPECT_THAT(ErrorOf("probes { name: 'p' body: 'sheet' vertex: 9 }"),
              AllOf(HasSubstr("probes[0].vertex"), HasSubstr("0 to 8")));
  EXPECT_THAT(ErrorOf("constraints { rigid_links { body: 'sheet' list { links { a: 0 b: 9 } } } }"),
              AllOf(HasSubstr("constraints[0].rigid_links.list.links[0]"), HasSubstr("0 to 8")));
  EXPECT_THAT(ErrorOf("constraints { rigid_links { body: 'sheet' list { links { a: 4 b: 4 } } } }"),
              HasSubstr("to itself"));
  EXPECT_THAT(ErrorOf("motions { ribs { bodies: 'sheet' end_states { number: 1 } } }"), HasSubstr("ROLE_DRIVEN"));
}

TEST(Compile, RefusesImpossibleBodies) {
  EXPECT_THAT(ErrorOf("",
                      "name: 's' bodies { name: 'b' role: ROLE_DEFORMABLE mass: -1 grid { columns: 2 rows: 2 u { x: "
                      "1 } v { y: 1 } } }"),
              AllOf(HasSubstr("bodies[0].mass"), HasSubstr("kg")));
  EXPECT_THAT(ErrorOf("", "name: 's' bodies { name: 'b' role: ROLE_DEFORMABLE }"), HasSubstr("no shape"));
  EXPECT_THAT(ErrorOf("", "name: 's' bodies { name: 'b' role: ROLE_SEEN polyhedron {} }"), HasSubstr("vertices"));
  EXPECT_THAT(ErrorOf("",
                      "name: 's' bodies { name: 'b' role: ROLE_SEEN polyhedron { vertices {} triangles { a: 0 b: 1 "
                      "c: 2 } } }"),
              AllOf(HasSubstr("body \"b\""), HasSubstr("triangle 0 names vertex 1")));
  EXPECT_THAT(ErrorOf("bodies { name: 'sheet' role: ROLE_SEEN polyhedron { vertices {} } }"), HasSubstr("two bodies"));
}

TEST(Compile, RegionsAreBoxesOfTheBodyAtRest) {
  const std::string body =
      "name: 'scene' bodies { name: 'sheet' role: ROLE_DEFORMABLE grid { columns: 3 rows: 3 u { x: 1 } v { y: 1 } } ";
  const auto model = CompileText(body +
                                 "regions { name: 'low' low {} high { x: 2 y: 1 } } regions { name: 'edge' low {} high "
                                 "{ y: 2 } } fixed_regions: 'edge' fixed_vertices: 3 } forces { membrane { bodies: "
                                 "'sheet' region: 'low' } } forces { membrane { bodies: 'sheet' exclude_region: 'low' "
                                 "} } forces { membrane { bodies: 'sheet' region: 'edge' } }");
  EXPECT_EQ(model->bodies[0].mesh.regions.at("low").size(), 6u);
  EXPECT_EQ(model->fixed_vertices.size(), 3u);
  ASSERT_EQ(model->forces.size(), 2u);
  EXPECT_THAT(model->report.DebugString(), HasSubstr("no triangle with area has all its vertices in the region"));
  EXPECT_THAT(ErrorOf("", body + "regions { name: 'far' low { x: 3 } high { x: 4 } } }"),
              AllOf(HasSubstr("bodies[0].regions[0]"), HasSubstr("no vertex")));
  EXPECT_THAT(ErrorOf("", body + "fixed_regions: 'rim' }"),
              AllOf(HasSubstr("bodies[0].fixed_regions[0]"), HasSubstr("no region \"rim\"")));
  EXPECT_THAT(ErrorOf("forces { membrane { bodies: 'sheet' exclude_region: 'rim' } }"),
              HasSubstr("forces[0].membrane.exclude_region"));
}

TEST(Compile, MassFollowsFromTheSubstance) {
  const auto model = CompileText(
      "name: 's' bodies { name: 'b' role: ROLE_DEFORMABLE grid { columns: 3 rows: 5 u { x: 0.1 } v { y: 0.1 } } "
      "material { density: 500 thickness: 0.02 } }");
  EXPECT_NEAR(model->mass.sum(), 500 * 0.02 * 0.2 * 0.4, 1e-12);
  EXPECT_THAT(
      ErrorOf("", "name: 's' bodies { name: 'b' role: ROLE_DEFORMABLE polyhedron { vertices {} } material {} }"),
      AllOf(HasSubstr("bodies[0].material"), HasSubstr("neither area nor volume")));
}

TEST(Compile, FillsClosedSurfacesWithCellsThatFit) {
  const auto body = [](const std::string& filling) {
    return "name: 's' bodies { name: 'b' role: ROLE_DEFORMABLE filling { " + filling + " } }";
  };
  const std::string ball = "ellipsoid { radii { x: 1 y: 1 z: 1 } } ";
  const auto model = CompileText(body(ball + "cell: 0.2"));
  EXPECT_GT(model->bodies[0].mesh.tetrahedra.cols(), 1000);
  EXPECT_THAT(ErrorOf("", body("")), HasSubstr("fills no surface"));
  EXPECT_THAT(ErrorOf("", body(ball + "cell: 1e-4")), HasSubstr("make them larger"));
  EXPECT_THAT(ErrorOf("", body("ellipsoid { radii { x: 1 y: 1 z: 1 } upper_half: true }")),
              AllOf(HasSubstr("body \"b\""), HasSubstr("must be closed")));
}

TEST(Compile, LeavesOutWhatTheSceneDoesNotNeedAndSaysSo) {
  const auto model = CompileText(
      std::string(kBody) + "forces { springs { bodies: 'sheet' } } forces { friction { bodies: 'sheet' rate: 0 } }");
  EXPECT_EQ(model->forces.size(), 1u);
  EXPECT_TRUE(model->constraints.empty());
  EXPECT_TRUE(model->motions.empty());
  EXPECT_THAT(model->report.DebugString(), AllOf(HasSubstr("its rate is 0"), HasSubstr("no rigid links")));
  EXPECT_EQ(model->report.springs(), 16);
  EXPECT_EQ(model->report.simulated_vertices(), 9);
}

TEST(Compile, ChoosesAStepBelowTheLargestStableOne) {
  const auto model = CompileText(std::string(kBody) + "forces { springs { bodies: 'sheet' stiffness: 1e7 } }");
  const v1::StableStep& step = model->report.stable_step();
  EXPECT_GT(step.omega_max(), 0);
  EXPECT_LE(step.chosen_seconds(), 0.9 * step.seconds());
  EXPECT_GE(step.chosen_seconds(), 0.8 * step.seconds());
  EXPECT_THAT(step.reason(), AllOf(HasSubstr("springs:sheet"), HasSubstr("rad/s")));
}

// A corner of the sheet has a twelfth of its mass, and each step of the listing takes 0.02 kg.
TEST(Compile, SaysWhyTheThesisDampingIsStableAtNoStep) {
  const auto report = [](const std::string& forces, double mass) {
    std::string body = kBody;
    body.replace(body.find("mass: 1"), 7, "mass: " + std::to_string(mass));
    return CompileText(body + forces + "parameters { integrator: INTEGRATOR_THESIS }")->report.stable_step();
  };
  const std::string springs = "forces { springs { bodies: 'sheet' stiffness: 100 } }";
  EXPECT_GT(report(springs, 1).seconds(), 0);
  const v1::StableStep light = report(springs, 0.17);
  EXPECT_EQ(light.seconds(), 0);
  EXPECT_GT(light.chosen_seconds(), 0);
  EXPECT_THAT(light.reason(), AllOf(HasSubstr("stable at no step"), HasSubstr("lightest vertex 0.0142 kg")));
  EXPECT_GT(report("", 0.17).seconds(), 0) << "nothing turns round where nothing pulls";
  EXPECT_EQ(report("", 0.08).seconds(), 0);
  EXPECT_THAT(report("", 0.08).reason(), HasSubstr("stable at no step"));
}

TEST(Compile, ReportsTheHashThatItIsGiven) {
  const auto scene = schema::ParseScene("test", std::string(kBody));
  const auto none = [](const v1::Body&) { return absl::NotFoundError("no files"); };
  const auto hash = [](const Model& model) { return model.bodies.front().name + "'s"; };
  EXPECT_EQ((*Compile(*scene, none, {.hash = hash}))->report.scene_hash(), "sheet's");
  EXPECT_EQ((*Compile(*scene, none))->report.scene_hash(), "");
}

TEST(Step, DivergenceNamesVertexForceAndRemedy) {
  const auto model =
      CompileText(std::string(kBody) + "forces { springs { bodies: 'sheet' stiffness: 100 rest_length_ratio: 0.9 } }");
  State state = model->InitialState(), before = state;
  Workspace work = model->MakeWorkspace();
  v1::Parameters parameters = model->parameters;
  parameters.set_time_step(10 * model->report.stable_step().seconds());
  absl::Status status;
  for (int i = 0; i < 10'000 && status.ok(); ++i) {
    before = state;
    status = Step(*model, parameters, parameters.time_step(), state, work);
  }
  ASSERT_FALSE(status.ok());
  const v1::Divergence why = Diagnose(*model, parameters, absl::OutOfRangeError("diverged"), before, state);
  EXPECT_EQ(why.body(), "sheet");
  EXPECT_EQ(why.force(), "springs:sheet");
  EXPECT_GT(why.time(), 0);
  EXPECT_THAT(why.remedy(), AllOf(HasSubstr("time_step"), HasSubstr("reset")));
}

}  // namespace
}  // namespace phrenic
