// Every extreme case passes, or is stopped or refused with a reason.
#include "server/study/extremes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <ostream>

#include "server/study/energy_balance.h"
#include "tests/compile_text.h"
#include "tests/study/run_on.h"

namespace phrenic::study {

void PrintTo(const ExtremeCase& extreme, std::ostream* out) { *out << extreme.name; }

namespace {

using testing::HasSubstr;

v1::StabilityTable Judge(const ExtremeCase& extreme) {
  v1::StabilityStudy study;
  study.set_most_seconds_a_run(120);
  static const Baselines baselines = *BaselineErrors(study, kNeverCancel);
  v1::StabilityTable table;
  EXPECT_TRUE(AddExtreme(extreme, baselines, study, kNeverCancel, table).ok());
  return table;
}

// First letters of the verdicts (pass, stopped) of semi-implicit Euler, velocity Verlet, Runge-Kutta 4, linear-implicit
// Euler and BDF2, each without and with error control. None is FAILED.
const std::map<std::string, std::string> kVerdicts = {
    {"baseline", "pppppppppp"},
    {"zero rest length", "pppppppppp"},
    {"coincident vertices, connected", "pppppppppp"},
    {"all vertices in one point", "pppppppppp"},
    {"nothing acts", "pppppppppp"},
    {"no stiffness", "pppppppppp"},
    {"slivers", "spspsppppp"},
    {"a triangle without area", "pppppppppp"},
    {"inverted tetrahedra", "pppppppppp"},
    {"NaN in a position of the scene", "s"},
    {"NaN in a position of a run", "ssssssssss"},
    {"infinite force in the scene", "s"},
    {"infinite force in a run", "ssssssssss"},
    {"zero mass", "s"},
    {"mass ratio 1e6", "spspsppppp"},
    {"stiffness 1e9 on every fifth spring", "spspsppppp"},
    {"fibre ratio 1e6", "spspsppppp"},
    {"time step x 10", "spspsppppp"},
    {"friction rate 1e6", "spppsppppp"},
    {"force x 10", "pppppppppp"},
    {"force x 1000", "pppppppppp"},
    {"initial speed 100 m/s", "pppppppppp"},
    {"compressed threefold", "pppppppppp"},
    {"inverted dome", "pppppppppp"},
    {"conflicting links", "psssssssss"},
    {"everything on one vertex", "pppppppppp"},
};

class Extremes : public testing::TestWithParam<ExtremeCase> {};

// Cases that solve many thousands of steps: half of the minute that all take under sanitizers.
[[maybe_unused]] bool TakesLong(const std::string& name) {
  for (const char* each :
       {"stiffness 1e9", "fibre ratio", "friction rate", "inverted dome", "inverted tetrahedra", "mass ratio"}) {
    if (name.starts_with(each)) return true;
  }
  return false;
}

TEST_P(Extremes, HaveTheExpectedVerdicts) {
#ifdef PHRENIC_SANITIZED
  if (TakesLong(GetParam().name)) GTEST_SKIP() << "the Release build runs it";
#endif
  const v1::StabilityTable table = Judge(GetParam());
  std::string verdicts, rows;
  for (const v1::ExtremeRow& row : table.extremes()) {
    verdicts += row.verdict()[0];
    rows += row.ShortDebugString() + "\n";
    EXPECT_NE(row.verdict() == "pass", !row.note().empty()) << row.DebugString();
    EXPECT_TRUE(row.verdict() != "pass" || row.finite());
  }
  ASSERT_TRUE(kVerdicts.contains(GetParam().name));
  EXPECT_EQ(verdicts, kVerdicts.at(GetParam().name)) << rows;
}

std::string TestName(const testing::TestParamInfo<ExtremeCase>& info) {
  std::string name = info.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Extremes, testing::ValuesIn(ExtremeCases()), TestName);

const char kPendulum[] = R"(
  name: "pendulum" title: "Pendulum"
  bodies {
    name: "b" role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0]
    polyhedron { vertices { } vertices { x: 1 } edges { a: 0 b: 1 } }
  }
  forces { gravity { bodies: "b" acceleration { z: -10 } } }
  constraints { rigid_links { body: "b" list { links { a: 0 b: 1 } } projection: PROJECTION_THESIS } }
  parameters { time_step: 0.01 }
)";

// The link keeps positions within bounds at any velocity.
TEST(Divergence, IsDetectedFromVelocitiesAlone) {
  const auto model = CompileText(kPendulum);
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  ASSERT_TRUE(Step(*model, model->parameters, 0.01, state, work).ok());
  state.v(1, 1) = 1e100;
  EXPECT_EQ(Step(*model, model->parameters, 0.01, state, work).code(), absl::StatusCode::kOutOfRange);
  state = model->InitialState();
  state.v(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Step(*model, model->parameters, 0.01, state, work).code(), absl::StatusCode::kOutOfRange);
}

TEST(EnergyBalance, IsTheRatioOfKineticEnergyToItsSources) {
  const auto model = CompileText(kPendulum);
  const Subject subject{.model = model, .parameters = model->parameters};
  EnergyBalance balance(subject);
  State state = model->InitialState();
  balance.Add(state);
  EXPECT_EQ(balance.ratio(), 0);
  state.x(2, 1) = -0.2;  // 1 kg falls 0.2 m under 10 m/s^2: 2 J
  state.v(2, 1) = -2;    // 2 J
  balance.Add(state);
  EXPECT_NEAR(balance.ratio(), 1, 1e-12);
  state.v(2, 1) = -4;
  balance.Add(state);
  EXPECT_NEAR(balance.ratio(), 4, 1e-12);
}

}  // namespace
}  // namespace phrenic::study
