// Laws of a rib cage that forces move, of the sheet inserted on it, and of the pressures between.
#include "tests/mechanics/breathing/free_cage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string_view>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/mechanics/step/step.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"
#include "tests/mechanics/every_target.h"

namespace phrenic {
namespace {

constexpr char kContact[] = "forces { wall_contact { bodies: 'sheet' wall: 'wall' stiffness: 1e6 largest_depth: 1 } } ";
constexpr char kChestWall[] = "forces { chest_wall { wall: 'wall' } } ";
constexpr char kPressures[] =
    "forces { thorax_pressures { body: 'sheet' wall: 'wall' lungs { room: 1e-3 } abdomen { compliance: 1e-6 weight { "
    "y: 4000 } } } } ";

constexpr char kParts[] = "sides {} segments { first_rib: 5 last_rib: 5 } ";
constexpr char kReleased[] =
    "parameters { flail_right: 1 flail_left: 0.5 right_intercostals: 0.4 cage_tilt: 0.1 left_cage_compliance: 0.5 } ";

// A position that no symmetry makes simple, with driven vertices where the coordinates have them.
State Disturbed(const Model& model, const Points& shift, double scale) {
  State state = model.InitialState();
  state.x += scale * shift;
  model.plan->DriveMotions(model.parameters, 0, {}, state);
  return state;
}

Points RandomShift(const Model& model, unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  return Points::NullaryExpr(3, model.rest.cols(), [&] { return uniform(random); });
}

double EnergyOf(const Model& model, const State& state) {
  double sum = 0;
  for (const auto& force : model.forces) sum += force->Energy(MakeEvalContext(model, model.parameters, state));
  return sum;
}

Points ForceOf(const Model& model, const State& state) {
  Points f(3, model.rest.cols());
  model.plan->SumForces(MakeEvalContext(model, model.parameters, state), f);
  return f;
}

// The work of the forces on a small displacement of free vertices and coordinates, in which inserted vertices follow,
// is the loss of energy: reactions at the insertion and contact forces reach the cage.
void ExpectVirtualWork(const std::string& forces, double tolerance, const std::string& parts = "") {
  const auto model = CompileText(FreeCage(forces, parts));
  ASSERT_NE(model, nullptr);
  const Points start = RandomShift(*model, 1, 4e-3);
  for (unsigned seed = 2; seed < 6; ++seed) {
    const Points direction = RandomShift(*model, seed, 1);
    const double h = 1e-6;
    const double loss = EnergyOf(*model, Disturbed(*model, start - h * direction, 1)) -
                        EnergyOf(*model, Disturbed(*model, start + h * direction, 1));
    Points free = direction;
    for (const int i : model->driven_vertices) free.col(i).setZero();
    const double work = 2 * h * Dot(ForceOf(*model, Disturbed(*model, start, 1)), free);
    EXPECT_NEAR(work, loss, tolerance * std::abs(loss)) << forces;
  }
}

TEST(FreeCage, ContactObeysVirtualWork) { ExpectVirtualWork(kContact, 1e-4); }
TEST(FreeCage, RecoilObeysVirtualWork) { ExpectVirtualWork(kChestWall, 1e-6); }
TEST(FreeCage, ContactWithPartsThatDepartObeysVirtualWork) {
  ExpectVirtualWork(std::string(kContact) + kReleased, 1e-4, kParts);
}
TEST(FreeCage, RecoilOfSidesAndSegmentsObeysVirtualWork) {
  ExpectVirtualWork(std::string(kChestWall) + kReleased, 1e-6, kParts);
}

TEST(FreeCage, PartsThatAreHeldChangeNothing) {
  const std::string forces =
      std::string(kContact) + kPressures + kChestWall + "parameters { intercostal_activation: 1 } ";
  const auto without = CompileText(FreeCage(forces)), with = CompileText(FreeCage(forces, kParts));
  ASSERT_NE(with, nullptr);
  const State one = RunTo(*without, 0.1, 1e-3), other = RunTo(*with, 0.1, 1e-3);
  const Eigen::Index vertices = without->coordinates.front().vertex;
  EXPECT_LT((one.x - other.x.leftCols(one.x.cols())).leftCols(vertices).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((one.x - without->rest).leftCols(vertices).norm(), 1e-4);
}

constexpr char kTissue[] =
    "forces { membrane { bodies: 'sheet' youngs_modulus: 1e6 poissons_ratio: 0.3 thickness: 0.003 } } "
    "forces { friction { bodies: 'sheet' rate: 20 } } ";

const Coordinate& Named(const Model& model, std::string_view name) {
  return *std::find_if(model.coordinates.begin(), model.coordinates.end(),
                       [name](const Coordinate& each) { return each.name == name; });
}

// A segment of broken ribs follows the pressure inside: a suction draws it in while the muscles raise the cage.
TEST(FreeCage, ABrokenSegmentMovesAgainstTheCage) {
  const std::string forces = std::string(kPressures) + kChestWall + kTissue;
  const auto after = [&](const std::string& changes) {
    const auto model =
        CompileText(FreeCage(forces + "parameters { intercostal_activation: 1 " + changes + "} ", kParts));
    const State state = RunTo(*model, 1, 2e-4);
    const auto value = [&](const char* name) { return Named(*model, name).Value(state.x); };
    return std::array{value("pump handle"), value("right segment"), value("left segment"), value("cage sides")};
  };
  const auto [raised, broken, whole, apart] = after("flail_right: 1 ");
  EXPECT_GT(raised, 0.02);
  EXPECT_LT(broken, -0.01);
  EXPECT_EQ(whole, 0);
  EXPECT_EQ(apart, 0);
  EXPECT_EQ(after("")[1], 0);
}

// The side whose muscles are cut stays behind; in the mirror the other one.
TEST(FreeCage, ASideWithoutMusclesStaysBehind) {
  const auto apart = [](const std::string& changes) {
    const auto model = CompileText(
        FreeCage(std::string(kChestWall) + "parameters { intercostal_activation: 1 " + changes + "} ", kParts));
    return Named(*model, "cage sides").Value(RunTo(*model, 1, 1e-3).x);
  };
  const double right = apart("right_intercostals: 0 "), left = apart("left_intercostals: 0 ");
  EXPECT_LT(right, -0.02);
  EXPECT_NEAR(right, -left, 1e-9 * left);
  EXPECT_LT(apart("right_cage_compliance: 0.2 "), -0.002);
}

// The cage comes to rest where their force ends.
TEST(FreeCage, TheRibsExpiratoryMusclesEndAtResidualVolume) {
  const auto lowest = [](double pressure) {
    const auto model = CompileText(FreeCage(absl::StrCat(
        "forces { chest_wall { wall: 'wall' expiratory_share: 0 expiratory_range: 0.2 expiratory_pressure: ", pressure,
        " } } parameters { expiratory_activation: 5 intercostal_activation: 0 } ")));
    return Named(*model, "pump handle").Value(RunTo(*model, 3, 2e-4).x);
  };
  EXPECT_EQ(lowest(0), 0);
  EXPECT_LT(lowest(1000), -0.1);
  EXPECT_GT(lowest(1000), -0.21);
  EXPECT_LT(lowest(20000), lowest(1000));
  EXPECT_GT(lowest(20000), -0.21);
}

TEST(FreeCage, SegmentsOfRibsThatTheSceneLacksAreRefused) {
  for (const char* bad : {"first_rib: 7 last_rib: 5", "first_rib: 5 last_rib: 13", "first_rib: 0 last_rib: 5"}) {
    const auto refused = TryCompileText(FreeCage(kChestWall, absl::StrCat("segments { ", bad, " } ")));
    EXPECT_NE(std::string(refused.status().message()).find("ribs.free.segments"), std::string::npos)
        << refused.status();
  }
  const auto none = TryCompileText(FreeCage(kChestWall, "segments { first_rib: 11 last_rib: 12 } "));
  EXPECT_NE(std::string(none.status().message()).find("does not grow with the right segment"), std::string::npos)
      << none.status();
}

// As above, along a direction that leaves the pressures of both sides alike, so that the cones' common face carries no
// force. A closed airway closed at `closed_at` [m^3].
void ExpectWorkOfPressures(const std::string& parameters, double closed_at = 0, const std::string& parts = "") {
  const auto model = CompileText(FreeCage(std::string(kPressures) + "parameters { " + parameters + " }", parts));
  ASSERT_NE(model, nullptr) << parameters;
  Points start = Points::Zero(3, model->rest.cols()), direction = start;
  for (Eigen::Index i = 0; i < start.cols(); ++i) {
    const Eigen::Vector3d x = model->rest.col(i);
    start.col(i) = Eigen::Vector3d(0, 0.1 * x.z(), -0.2 * x.z());
    direction.col(i) = Eigen::Vector3d(x.x() * x.z(), x.y() + x.z(), 0.3 + x.z());
  }
  const Coordinate pump = model->coordinates[0], bucket = model->coordinates[1];
  start(pump.axis, pump.vertex) = 0.3 * pump.scale, start(bucket.axis, bucket.vertex) = 0.5 * bucket.scale;
  direction(pump.axis, pump.vertex) = 0.2, direction(bucket.axis, bucket.vertex) = -0.3;
  direction(2, pump.vertex) = 0;
  for (const Coordinate& each : model->coordinates) {
    if (each.name.find("segment") == std::string::npos) continue;
    start(each.axis, each.vertex) = -0.2 * each.scale;
    direction(each.axis, each.vertex) = 0.4 * each.scale;
  }
  const auto at = [&](double step) {
    State state = Disturbed(*model, start + step * direction, 1);
    if (closed_at != 0) state.scalars.q.head(2) = Eigen::Vector2d(1, closed_at);
    return state;
  };
  const double h = 1e-6;
  const double loss = EnergyOf(*model, at(-h)) - EnergyOf(*model, at(h));
  Points free = direction;
  for (const int i : model->driven_vertices) free.col(i).setZero();
  EXPECT_NEAR(2 * h * Dot(ForceOf(*model, at(0)), free), loss, 2e-3 * std::abs(loss)) << parameters;
}

TEST(FreeCage, PressuresObeyVirtualWork) {
  for (const char* parameters :
       {"", "lung_compliance: 0.4", "abdominal_compliance: 0.3", "abdominal_load: 800", "airway_pressure: 900",
        "pneumothorax_right: 0.5 pneumothorax_left: 0.5", "pleural_fluid_right: 1e-4 pleural_fluid_left: 1e-4",
        "posture: POSTURE_UPRIGHT", "posture: POSTURE_PRONE"}) {
    ExpectWorkOfPressures(parameters);
  }
}

TEST(FreeCage, PressuresOnSegmentsObeyVirtualWork) {
  ExpectWorkOfPressures("flail_right: 1 flail_left: 1", 0, "segments { first_rib: 5 last_rib: 5 } ");
}

TEST(FreeCage, GasBehindAClosedAirwayObeysVirtualWork) { ExpectWorkOfPressures("airway_closed: true", 2e-4); }

// Contact, sums over the sheet and resistances.
TEST(FreeCage, StepsToTheSameBitsOnEveryInstructionSet) {
  const auto model = CompileText(FreeCage(std::string(kContact) + kPressures));
  ASSERT_NE(model, nullptr);
  const State start = Disturbed(*model, RandomShift(*model, 1, 4e-3), 1);
  std::vector<State> ends;
  OnEveryTarget([&] {
    State& state = ends.emplace_back(start);
    Workspace work = model->MakeWorkspace();
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-4, state, work).ok());
    EXPECT_EQ(state.x, ends.front().x);
    EXPECT_EQ(state.v, ends.front().v);
  });
  EXPECT_GT((ends.front().v - start.v).norm(), 0.1);
}

// A run that has diverged: no instruction set reads outside of the wall's table.
TEST(FreeCage, ContactOfPointsThatAreNoNumbersIsHarmless) {
  const auto model = CompileText(FreeCage(kContact));
  ASSERT_NE(model, nullptr);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      State state = model->InitialState();
      state.x.row(axis).setConstant(bad);
      OnEveryTarget([&] { ForceOf(*model, state); });
      EnergyOf(*model, state);
    }
  }
}

TEST(FreeCage, PressuresOnAnotherBodyThanTheInsertedOneAreRefused) {
  const auto refused = TryCompileText(FreeCage(
      "bodies { name: 'other' role: ROLE_DEFORMABLE mass: 1 grid { columns: 2 rows: 2 u { x: 0.1 } v { y: 0.1 } } } "
      "forces { thorax_pressures { body: 'other' wall: 'wall' lungs {} abdomen {} } }"));
  EXPECT_NE(std::string(refused.status().message()).find("forces[0].thorax_pressures.body"), std::string::npos)
      << refused.status();
}

TEST(FreeCage, InsertedVerticesMoveWithTheWall) {
  const auto model = CompileText(FreeCage(kChestWall));
  ASSERT_NE(model, nullptr);
  State state = model->InitialState();
  const Coordinate pump = model->coordinates[0];
  state.x(pump.axis, pump.vertex) = pump.scale;
  state.v(pump.axis, pump.vertex) = pump.scale;
  const double h = 1e-6;
  State later = state;
  later.x(pump.axis, pump.vertex) += h * pump.scale;
  model->plan->DriveMotions(model->parameters, 0, {}, state);
  model->plan->DriveMotions(model->parameters, 0, {}, later);
  double largest = 0;
  for (const int i : model->driven_vertices) {
    largest = std::max(largest, (state.x.col(i) - model->rest.col(i)).norm());
    EXPECT_LT(((later.x.col(i) - state.x.col(i)) / h - state.v.col(i)).norm(), 1e-6);
  }
  EXPECT_GT(largest, 3e-3);
}

// Activation raises the ribs; without it the cage stays.
TEST(FreeCage, MovesByItsMuscles) {
  const auto model = CompileText(FreeCage(std::string(kChestWall) + "parameters { intercostal_activation: 0.5 }"));
  ASSERT_NE(model, nullptr);
  const auto height = [](const State& state) { return state.x(0, state.x.cols() - 1); };
  EXPECT_GT(height(RunTo(*model, 2, 1e-3)) / model->coordinates[0].scale, 0.1);
  const auto still = CompileText(FreeCage(std::string(kChestWall) + "parameters { intercostal_activation: 0 }"));
  EXPECT_EQ(height(RunTo(*still, 2, 1e-3)), 0);
}

}  // namespace
}  // namespace phrenic
