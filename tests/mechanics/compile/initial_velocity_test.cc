// Initial velocities and offsets of bodies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "absl/strings/str_cat.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

// Two masses of 1 kg and 3 kg on a spring, nothing else. `more` is added to the body.
std::string Dumbbell(const std::string& more, const std::string& elements = "") {
  return absl::StrCat(R"(
    name: "dumbbell" title: "Dumbbell"
    bodies {
      name: "b" role: ROLE_DEFORMABLE mass: 2
      polyhedron { vertices { } vertices { x: 1 } edges { a: 0 b: 1 } })",
                      more, "} forces { springs { bodies: 'b' stiffness: 10 } } ", elements,
                      "parameters { time_step: 0.001 integrator: INTEGRATOR_VELOCITY_VERLET }");
}

std::string RefusalOfBody(const std::string& more) {
  const auto model = TryCompileText(Dumbbell(more));
  EXPECT_EQ(model.status().code(), absl::StatusCode::kInvalidArgument) << more;
  return std::string(model.status().message());
}

TEST(InitialVelocity, MovesAFreeBodyUniformly) {
  const auto model = CompileText(Dumbbell("initial_velocity { linear { x: 0.5 z: -2 } }"));
  const State state = RunTo(*model, 3, 0.001);
  EXPECT_LT((state.x - (model->rest.colwise() + Eigen::Vector3d(1.5, 0, -6))).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(InitialVelocity, SpinsABodyAboutItsCentreOfMass) {
  const auto model = CompileText(Dumbbell("initial_velocity { angular { z: 2 } }"));
  const State state = model->InitialState();
  EXPECT_LT((state.v.col(0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-15);
  EXPECT_LT((state.v.col(1) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((state.v * model->mass).norm(), 1e-15) << "no momentum";
}

TEST(InitialVelocity, OfSingleVerticesReplacesThatOfTheBody) {
  const auto model =
      CompileText(Dumbbell("initial_velocity { linear { x: 7 } vertices { vertex: 1 velocity { y: 3 } } }"));
  const State state = model->InitialState();
  EXPECT_EQ(state.v.col(0), Eigen::Vector3d(7, 0, 0));
  EXPECT_EQ(state.v.col(1), Eigen::Vector3d(0, 3, 0));
}

TEST(InitialVelocity, LeavesFixedVerticesAtRest) {
  const auto model = CompileText(Dumbbell("fixed_vertices: 0 initial_velocity { linear { x: 7 } }"));
  EXPECT_EQ(model->InitialState().v.col(0), Eigen::Vector3d::Zero());
  EXPECT_EQ(RunTo(*model, 0.1, 0.001).x.col(0), model->rest.col(0));
}

TEST(InitialVelocity, KeepsRigidLinks) {
  const auto model = CompileText(Dumbbell("initial_velocity { vertices { vertex: 1 velocity { x: 4 y: 1 } } }",
                                          "constraints { rigid_links { body: 'b' list { links { a: 0 b: 1 } } } }"));
  const State state = model->InitialState();
  EXPECT_LT((state.v.col(0) - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12) << "an inelastic pull along the link";
  EXPECT_LT((state.v.col(1) - Eigen::Vector3d(2, 1, 0)).norm(), 1e-12);
}

TEST(InitialVelocity, SaysWhatIsWrongWithIt) {
  EXPECT_THAT(RefusalOfBody("initial_velocity { linear { x: 1e5 } }"),
              HasSubstr("bodies[0].initial_velocity: vertex 0 moves at 100000 m/s; at most 10000 m/s"));
  EXPECT_THAT(RefusalOfBody("initial_velocity { linear { x: nan } }"), HasSubstr("initial_velocity"));
  EXPECT_THAT(RefusalOfBody("initial_velocity { angular { z: 1e300 } }"), HasSubstr("initial_velocity"));
  EXPECT_THAT(RefusalOfBody("initial_velocity { vertices { vertex: 2 velocity {} } }"),
              HasSubstr("vertices[0].vertex"));
  EXPECT_THAT(RefusalOfBody("initial_velocity { vertices { vertex: 1 } }"), HasSubstr("velocity: must be set"));
  EXPECT_THAT(RefusalOfBody("fixed_vertices: 1 initial_velocity { vertices { vertex: 1 velocity { x: 1 } } }"),
              HasSubstr("vertex 1 is fixed or driven"));
  const auto seen = TryCompileText(
      "name: 's' bodies { name: 'post' role: ROLE_AT_REST initial_velocity { linear { x: 1 } } "
      "polyhedron { vertices { } vertices { x: 1 } edges { a: 0 b: 1 } } }");
  EXPECT_THAT(std::string(seen.status().message()), HasSubstr("only a deformable body has an initial velocity"));
}

TEST(Offset, ShiftsTheShapeBeforeRegionsAreFound) {
  const auto model = CompileText(
      Dumbbell("offset { y: -0.135 } regions { name: 'low' low { x: -1 y: -0.2 z: -1 } high { x: 2 y: -0.1 z: 1 } }"));
  EXPECT_EQ(model->rest.col(1), Eigen::Vector3d(1, -0.135, 0));
  EXPECT_EQ(model->bodies[0].mesh.regions.at("low").size(), 2);
}

TEST(Offset, BeyondEveryLengthIsRefused) {
  EXPECT_THAT(RefusalOfBody("offset { x: 1e7 }"),
              HasSubstr("body \"b\": has a coordinate of 1e+07 m; at most 1e+06 m"));
  EXPECT_THAT(RefusalOfBody("offset { x: nan }"), HasSubstr("not a finite number"));
}

TEST(AbsurdShapes, AreRefusedByNameInPlaceOfAStepThatIsNoNumber) {
  for (const char* x : {"1e200", "-1e200", "1e7"}) {
    const auto model = TryCompileText(absl::StrCat(
        "name: 's' bodies { name: 'wire' role: ROLE_DEFORMABLE mass: 1 polyhedron { vertices { } vertices { x: ", x,
        " } edges { a: 0 b: 1 } } } forces { springs { bodies: 'wire' stiffness: 10 } }"));
    ASSERT_EQ(model.status().code(), absl::StatusCode::kInvalidArgument) << x;
    EXPECT_THAT(std::string(model.status().message()), HasSubstr("body \"wire\"")) << x;
  }
}

TEST(AbsurdShapes, WithAnEdgeFromAVertexToItselfAreRefused) {
  const auto model = TryCompileText(
      "name: 's' bodies { name: 'wire' role: ROLE_DEFORMABLE mass: 1 polyhedron { vertices { } vertices { x: 1 } "
      "edges { a: 0 b: 1 } edges { a: 1 b: 1 } } } forces { springs { bodies: 'wire' stiffness: 10 } }");
  EXPECT_THAT(std::string(model.status().message()), HasSubstr("edge 1 joins vertex 1 with itself"));
}

TEST(AbsurdShapes, OfTrianglesWithARepeatedCornerHaveNoSpringWithoutLength) {
  const auto model = CompileText(
      "name: 's' bodies { name: 'b' role: ROLE_DEFORMABLE mass: 1 polyhedron { vertices { } vertices { x: 1 } "
      "vertices { y: 1 } triangles { a: 0 b: 1 c: 2 } triangles { a: 1 b: 1 c: 2 } } } "
      "forces { springs { bodies: 'b' stiffness: 10 } }");
  EXPECT_EQ(model->report.springs(), 3);
}

}  // namespace
}  // namespace phrenic
