// Elastic energy counts what deforms, and potential energy what is named.
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic {
namespace {

double Read(const Model& model, size_t measure, const State& state) {
  return model.measures[measure]->Value(MakeEvalContext(model, model.parameters, state));
}

TEST(ElasticEnergy, LeavesOutGravityContactAndLoads) {
  const auto model = CompileText(Triangle(R"(
    bodies { name: "floor" role: ROLE_AT_REST polyhedron { vertices { x: -9 y: -9 } vertices { x: 9 y: -9 } vertices { y: 9 }
             triangles { a: 0 b: 1 c: 2 } } }
    forces { name: "touch" contact { bodies: "sheet" surfaces: "floor" depth: 0.01 load: 1 } }
    forces { name: "push" point_load { body: "sheet" vertices: 1 force { z: 1 } } }
    measures { name: "all" elastic_energy {} }
    measures { name: "springs" elastic_energy { forces: "weave" } }
    measures { name: "gravity" elastic_energy { forces: "gravity:sheet" } }
    measures { name: "touch" elastic_energy { forces: "touch" } })"));
  State state = model->InitialState();
  state.x.row(2).array() -= 0.005;
  state.x.col(1)[0] += 0.5;
  EXPECT_GT(Read(*model, 1, state), 0);
  EXPECT_EQ(Read(*model, 0, state), Read(*model, 1, state));
  EXPECT_NE(Read(*model, 2, state), 0) << "a named force counts, whatever its kind";
  EXPECT_NE(Read(*model, 3, state), 0);
}

TEST(ActionLine, SkipsVerticesThatAnEarlierLinePulls) {
  const auto scene = [](const char* overlap) {
    const auto line = [&](const char* name, double x) {
      return absl::StrCat("forces { name: '", name, "' action_line { bodies: 'sheet' origin { x: ", x,
                          " } direction { z: 1 } radius: 1.5 force: 6 overlap: ", overlap, " } }");
    };
    return Triangle(line("first", 1) + line("second", 0));
  };
  const auto force = [](const Model& model, const char* name) {
    Points f = Points::Zero(3, model.rest.cols());
    State state = model.InitialState();
    EvalContext at = MakeEvalContext(model, model.parameters, state);
    at.breath = 1;
    for (const auto& each : model.forces) {
      if (each->name() == name) each->AddForce(at, f);
    }
    return f;
  };
  // The first line reaches vertices 1 and 2, the second all; vertex 0 is fixed.
  const auto sum = CompileText(scene("OVERLAP_SUM"));
  EXPECT_GT(force(*sum, "first")(2, 1), 0);
  EXPECT_GT(force(*sum, "second")(2, 1), 0);
  const auto skip = CompileText(scene("OVERLAP_SKIP_PULLED"));
  EXPECT_EQ(force(*skip, "first"), force(*sum, "first")) << "the first line is as before";
  for (const v1::LeftOut& row : skip->report.left_out()) {
    if (row.what() != "second") continue;
    EXPECT_EQ(row.why(), "no free vertex that no earlier line pulls is within its reach");
  }
  EXPECT_EQ(force(*skip, "second").norm(), 0);
}

TEST(ActionLine, SharesItsForceAmongTheVerticesThatRemain) {
  const auto model = CompileText(Triangle(
      "forces { name: 'first' action_line { bodies: 'sheet' origin { x: 1 } direction { z: 1 } radius: 1 force: 6 } }"
      "forces { name: 'second' action_line { bodies: 'sheet' origin { x: 0.5 y: 0.5 } direction { z: 1 } radius: 2 "
      "force: 6 overlap: OVERLAP_SKIP_PULLED } }"));
  Points f = Points::Zero(3, 3);
  const State state = model->InitialState();
  EvalContext at = MakeEvalContext(*model, model->parameters, state);
  at.breath = 1;
  for (const auto& each : model->forces) {
    if (each->name() == "second") each->AddForce(at, f);
  }
  EXPECT_NEAR(f(2, 2), 6, 1e-12) << "vertex 2 has the whole pull";
  EXPECT_EQ(f(2, 1), 0) << "vertex 1 is the first line's";
}

}  // namespace
}  // namespace phrenic
