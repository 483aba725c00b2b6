// Muscle: the laws of its element, held against closed forms.
#include "server/mechanics/forces/muscle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "absl/strings/str_format.h"
#include "server/mechanics/breathing/muscle_prestress.h"
#include "server/mechanics/parallel/parallel_for.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"
#include "tests/mechanics/every_target.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

// A strip 0.1 m long that begins at x = 0.05; its last column is tendon. Wide or narrow: in a narrow one the ends
// matter near the ends only.
struct StripShape {
  int columns = 11, rows = 5;
  double width = 0.04, mass = 0.01;
};
constexpr StripShape kNarrow{.columns = 26, .rows = 2, .width = 0.001, .mass = 1e-4};

std::string MuscleStrip(const std::string& muscle, const StripShape& shape = {}, const std::string& more = "") {
  return absl::StrFormat(
      "name: 'strip' bodies { name: 'strip' role: ROLE_DEFORMABLE mass: %g fixed_regions: 'from' grid { columns: %d "
      "rows: %d origin { x: 0.05 } u { x: %.17g } v { y: %.17g } } regions { name: 'from' low { x: 0.05 } high { x: "
      "0.05 "
      "y: 1 } } regions { name: 'tendon' low { x: 0.1499 } high { x: 0.1501 y: 1 } } } breath { waveform: "
      "WAVEFORM_SINE } "
      "parameters { diaphragm_activation: 1 breath_length: 30 } forces { muscle { body: 'strip' from_region: 'from' "
      "tendon_region: 'tendon' precision: PRECISION_DOUBLE %s } } %s",
      shape.mass, shape.columns, shape.rows, 0.1 / (shape.columns - 1), shape.width / (shape.rows - 1), muscle, more);
}

// Half an ellipsoid with its tendon at the top.
std::string MuscleDome(const std::string& muscle, const std::string& more, int divisions = 8) {
  return absl::StrFormat(
      "name: 'dome' bodies { name: 'dome' role: ROLE_DEFORMABLE mass: 0.5 ellipsoid { radii { x: 0.12 y: 0.09 z: 0.09 "
      "} "
      "divisions: %d upper_half: true } regions { name: 'tendon' low { x: -1 y: -1 z: 0.07 } high { x: 1 y: 1 z: 1 } } "
      "fixed_regions: 'rim' } breath { waveform: WAVEFORM_RAISED_COSINE } forces { muscle { body: 'dome' from_region: "
      "'rim' tendon_region: 'tendon' %s } } %s",
      divisions, muscle, more);
}

const char kDomePressure[] = "forces { pressure { surface { bodies: 'dome' } pressure: 700 } } ";
const char kDomeFriction[] = "forces { friction { bodies: 'dome' rate: 8 } } ";

const Muscle& TheMuscle(const Model& model) { return dynamic_cast<const Muscle&>(*model.forces.front()); }

State AtPeakSignal(const Model& model) {
  State state = model.InitialState();
  state.phase = 0.25;  // of a sine
  return state;
}

void Shake(double size, State& state) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-size, size);
  for (double& value : state.x.reshaped()) value += shift(random);
  for (double& value : state.v.reshaped()) value = shift(random);
}

Points MuscleForceAt(const Model& model, const State& state) {
  Points f = Points::Zero(3, state.x.cols());
  model.forces.front()->AddForce(MakeEvalContext(model, model.parameters, state), f);
  return f;
}

// Returns the stretch at which muscle has this tension: the law is solved by bisection between 0.48 and 1.05.
double StretchUnder(const MuscleLaw& law, double resting, double active, double tension) {
  double low = 0.48, high = 1.05;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (MuscleAt(law, resting, active, middle).tension < tension ? low : high) = middle;
  }
  return low;
}

// Pulls a strip's end along x with this tension [N/m].
void PullEnd(double tension, const StripShape& shape, State& state) {
  for (int row = 0; row < shape.rows; ++row) {
    const double share = (row == 0 || row == shape.rows - 1 ? 0.5 : 1) / (shape.rows - 1);
    state.pulls.push_back({(row + 1) * shape.columns - 1, {tension * shape.width * share, 0, 0}});
  }
}

// Two vertices of the narrow strip far from its ends, 40 mm from each other at rest.
constexpr int kNear = 3, kFar = 13;
double StripStretch(const State& state) { return (state.x.col(kFar) - state.x.col(kNear)).norm() / 0.04; }
double StripRate(const State& state) { return (state.v(0, kFar) - state.v(0, kNear)) / 0.04; }

TEST(MuscleLaw, TensionIsTheDerivativeOfItsEnergyAndSlopeThatOfTension) {
  const auto model = CompileText(MuscleStrip(""));
  const MuscleLaw law = MakeMuscleLaw(model->scene.forces(0).muscle());
  for (double stretch = 0.3; stretch < 2.5; stretch += 0.0137) {
    const auto difference = [&](const auto& at, auto member) {
      return (at(stretch + 1e-6).*member - at(stretch - 1e-6).*member) / 2e-6;
    };
    const auto muscle = [&](double l) { return MuscleAt(law, 45, 300, l); };
    const auto linear = [&](double l) { return LinearAt(law.tendon, 35, l); };
    EXPECT_NEAR(difference(muscle, &TensionAt::energy), muscle(stretch).tension, 1e-3) << stretch;
    EXPECT_NEAR(difference(muscle, &TensionAt::tension), muscle(stretch).slope, 2e-2) << stretch;
    EXPECT_NEAR(difference(linear, &TensionAt::energy), linear(stretch).tension, 1e-3) << stretch;
    EXPECT_NEAR(difference(linear, &TensionAt::tension), linear(stretch).slope, 1e-2) << stretch;
  }
}

TEST(MuscleLaw, HillHasItsThreePoints) {
  const HillLaw hill{6, 1.5};
  EXPECT_EQ(hill.At(0), 1);
  EXPECT_EQ(hill.At(-6), 0);
  EXPECT_EQ(hill.At(-7), 0);
  EXPECT_NEAR(hill.At(-0.25 * 6), 0.75 / 2, 1e-15);
  EXPECT_NEAR(hill.At(0.13 * 6), 1.25, 1e-15);
  EXPECT_LT(hill.At(1e6), 1.5);
  EXPECT_EQ((HillLaw{0, 1.5}.At(-100)), 1) << "no dependence";
}

// Both precisions, on every instruction set and for any number of threads; enough triangles for several threads.
TEST(MuscleForce, HasTheSameBitsEverywhere) {
  for (const char* precision : {"", "precision: PRECISION_DOUBLE"}) {
    const auto model = CompileText(MuscleDome(precision, "", 40));
    State state = model->InitialState();
    state.phase = 0.4;
    Shake(1e-3, state);
    const Points first = MuscleForceAt(*model, state);
    ScalarState rates = state.scalars;
    const EvalContext at = MakeEvalContext(*model, model->parameters, state);
    model->forces.front()->AdvanceScalars(at, 0, 1e-3, rates);
    const auto same = [&] {
      EXPECT_EQ(MuscleForceAt(*model, state), first);
      ScalarState again = state.scalars;
      model->forces.front()->AdvanceScalars(at, 0, 1e-3, again);
      EXPECT_EQ(again.q, rates.q);
    };
    EXPECT_GT(rates.q.cwiseAbs().minCoeff(), 0);
    OnEveryTarget(same);
    SetStepThreads(3);
    same();
    SetStepThreads(1);
  }
}

TEST(MuscleForce, InSinglePrecisionIsNear) {
  const auto single = CompileText(MuscleDome("", "")),
             exact = CompileText(MuscleDome("precision: PRECISION_DOUBLE", ""));
  State state = exact->InitialState();
  state.phase = 0.4;
  Shake(1e-3, state);
  const Points f = MuscleForceAt(*exact, state);
  EXPECT_LT((MuscleForceAt(*single, state) - f).cwiseAbs().maxCoeff(), 2e-5 * f.cwiseAbs().maxCoeff());
}

// The stretch of muscle under a constant load is where force-length and passive tension together carry it.
TEST(MuscleForce, ShortensUnderALoadToWhereForceLengthSays) {
  const auto model =
      CompileText(MuscleStrip("resting_tension_across: 0 tendon_tension: 0 shortening_rate: 0", kNarrow));
  ASSERT_NE(model, nullptr);
  const MuscleLaw law = MakeMuscleLaw(model->scene.forces(0).muscle());
  v1::Parameters parameters = model->parameters;
  parameters.set_integrator(v1::INTEGRATOR_STATIC);
  for (const double tension : {200.0, 500.0, 800.0}) {
    State state = AtPeakSignal(*model);
    PullEnd(tension, kNarrow, state);
    Workspace work = model->MakeWorkspace();
    ASSERT_TRUE(Step(*model, parameters, 1e-6, state, work).ok()) << tension;
    EXPECT_NEAR(StripStretch(state), StretchUnder(law, 45, law.active, tension), 1e-4) << tension;
  }
}

// At full activation, reached slowly, the strip stops just above the stretch at which force-length vanishes, however
// little it has to carry, with every triangle the right way up.
TEST(MuscleForce, StopsWhereForceLengthVanishesWithoutFolding) {
  constexpr double kTension = 20;
  const StripShape shape;
  const auto model = CompileText(MuscleStrip("resting_tension: 0 resting_tension_across: 0 tendon_tension: 0", shape,
                                             "forces { friction { bodies: 'strip' rate: 20 } }"));
  ASSERT_NE(model, nullptr);
  State state = model->InitialState();
  PullEnd(kTension, shape, state);
  v1::Parameters parameters = model->parameters;
  parameters.set_breath_length(8);
  Workspace work = model->MakeWorkspace();
  while (state.time < 2) ASSERT_TRUE(Step(*model, parameters, parameters.time_step(), state, work).ok());
  const MuscleLaw law = MakeMuscleLaw(model->scene.forces(0).muscle());
  const double stop = StretchUnder(law, 0, law.active, kTension);
  EXPECT_LT(stop, 0.49);  // force-length vanishes at 0.4725
  EXPECT_NEAR(TheMuscle(*model).Read(0, MakeEvalContext(*model, parameters, state)), stop, 0.03);
  for (const MuscleTriangle& triangle : TheMuscle(*model).triangles()) {
    const Eigen::Vector3d a = state.x.col(triangle.vertices[0]);
    const Eigen::Vector3d b = state.x.col(triangle.vertices[1]), c = state.x.col(triangle.vertices[2]);
    EXPECT_GT((b - a).cross(c - a).z(), 0.05 * 2 * triangle.area)
        << "turned over or flattened at " << model->rest.col(triangle.vertices[0]).transpose();
  }
}

// Isotonic release: the rate at which a strip shortens under a constant load, against Hill's law with viscosity.
TEST(MuscleForce, ShortensUnderALoadAtTheRateThatHillSays) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the Release build runs it: 0.12 s of simulated time";
#endif
  constexpr double kTension = 500;
  const auto model = CompileText(MuscleStrip("resting_tension_across: 0 tendon_tension: 0 viscosity: 2", kNarrow));
  ASSERT_NE(model, nullptr);
  const MuscleLaw law = MakeMuscleLaw(model->scene.forces(0).muscle());
  const HillLaw hill = MakeHillLaw(model->scene.forces(0).muscle());
  State state = AtPeakSignal(*model);
  PullEnd(kTension, kNarrow, state);
  Workspace work = model->MakeWorkspace();
  const double dt = model->parameters.time_step();
  while (state.time < 0.12) ASSERT_TRUE(Step(*model, model->parameters, dt, state, work).ok());
  const double stretch = StripStretch(state), rate = StripRate(state);
  EXPECT_LT(stretch, 0.97);
  EXPECT_GT(stretch, 0.7) << "still on its way";
  double slow = 0, fast = -6;  // bisection of the tension at this stretch for the rate
  for (int i = 0; i < 60; ++i) {
    const double middle = (slow + fast) / 2;
    const double tension = MuscleAt(law, 45, law.active * hill.At(middle), stretch).tension + law.viscosity * middle;
    (tension > kTension ? slow : fast) = middle;
  }
  EXPECT_NEAR(rate, slow, 0.06 * std::abs(slow));
}

TEST(MuscleForce, MirroredSheetsHaveMirroredForces) {
  const auto model = CompileText(MuscleDome("precision: PRECISION_DOUBLE", ""));
  const Points& rest = model->rest;
  const NearestSearch search(rest);
  State state = model->InitialState();
  state.phase = 0.4;
  std::vector<int> twin;
  for (int i = 0; i < static_cast<int>(rest.cols()); ++i) {
    const auto found = search.Nearest({-rest(0, i), rest(1, i), rest(2, i)});
    ASSERT_LT(found.distance, 1e-12);
    twin.push_back(found.vertex);
  }
  for (int i = 0; i < static_cast<int>(rest.cols()); ++i) {
    const Eigen::Vector3d p = rest.col(i);
    state.x.col(i) += 0.02 * Eigen::Vector3d(p.x() * std::cos(30 * p.z()), std::abs(p.x()) - p.z(), p.y());
  }
  const Points f = MuscleForceAt(*model, state);
  for (int i = 0; i < static_cast<int>(rest.cols()); ++i) {
    const Eigen::Vector3d mirrored(-f(0, i), f(1, i), f(2, i));
    EXPECT_LT((f.col(twin[i]) - mirrored).norm(), 1e-9 * f.cwiseAbs().maxCoeff());
  }
}

TEST(MuscleForce, PullsOnTheSideThatIsActive) {
  const auto model = CompileText(MuscleDome("precision: PRECISION_DOUBLE", ""));
  State state = model->InitialState();
  const Points passive = MuscleForceAt(*model, state);
  state.phase = 0.4;
  v1::Parameters parameters = model->parameters;
  parameters.set_right_activation(0);
  const auto active = [&] {
    Points f = -passive;
    model->forces.front()->AddForce(MakeEvalContext(*model, parameters, state), f);
    double right = 0, left = 0;
    for (Eigen::Index i = 0; i < f.cols(); ++i) {
      if (model->rest(0, i) < -0.03) right += f.col(i).norm();
      if (model->rest(0, i) > 0.03) left += f.col(i).norm();
    }
    return std::pair(right, left);
  };
  EXPECT_EQ(active().first, 0);
  EXPECT_GT(active().second, 1);
  parameters.set_apply_muscles(false);
  EXPECT_EQ(active().second, 0);
}

TEST(MuscleForce, ElasticityScalesStiffnessButNotTension) {
  const auto model = CompileText(MuscleDome("precision: PRECISION_DOUBLE", ""));
  v1::Parameters parameters = model->parameters;
  State state = model->InitialState();
  const auto force = [&](double elasticity) {
    parameters.set_elasticity(elasticity);
    Points f = Points::Zero(3, state.x.cols());
    model->forces.front()->AddForce(MakeEvalContext(*model, parameters, state), f);
    return f;
  };
  EXPECT_LT((force(10) - force(1)).cwiseAbs().maxCoeff(), 1e-5);
  state.x *= 1.05;
  EXPECT_GT(force(10).norm(), 4 * force(1).norm());
}

// Of a straight strip that shortens uniformly.
TEST(MuscleRates, FollowTheMeanRateOfFibresAndTheirTimeConstant) {
  const auto model = CompileText(MuscleStrip("rate_time: 0.015"));
  ASSERT_EQ(model->scalars.size(), static_cast<size_t>(FibreBundles::kCount));
  State state = model->InitialState();
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) state.v(0, i) = -2 * (state.x(0, i) - 0.05);
  const EvalContext at = MakeEvalContext(*model, model->parameters, state);
  ScalarState rates = state.scalars;
  for (int tick = 0; tick < 15; ++tick) TheMuscle(*model).AdvanceScalars(at, tick, 1e-3, rates);
  double sum = 0;
  int count = 0;
  for (const double rate : rates.q) {
    if (rate != 0) sum += rate, ++count;
  }
  EXPECT_EQ(count, 5) << "one for each vertex of the edge where fibres begin, all on the left";
  EXPECT_NEAR(sum / count, -2 * (1 - std::exp(-1.0)), 0.1);
  for (int tick = 0; tick < 2000; ++tick) TheMuscle(*model).AdvanceScalars(at, tick, 1e-3, rates);
  EXPECT_NEAR(rates.q.minCoeff(), -2, 1e-6);
}

TEST(MuscleRates, AreAbsentWhereForceDoesNotDependOnThem) {
  const auto model = CompileText(MuscleStrip("shortening_rate: 0"));
  EXPECT_TRUE(model->scalars.empty());
  EXPECT_FALSE(model->forces.front()->advances_scalars());
}

// A run that goes on from a copy, with fresh memory, has the same future bit for bit; so has one on several threads.
TEST(MuscleRates, GoOnFromACopyBitForBit) {
  const auto model = CompileText(MuscleDome("balanced_at_rest: true", std::string(kDomePressure) + kDomeFriction));
  for (const double tolerance : {0.0, 1e-6}) {
    v1::Parameters parameters = model->parameters;
    parameters.set_step_tolerance(tolerance);
    parameters.set_breath_length(0.5);
    State state = model->InitialState(), copy;
    Workspace work = model->MakeWorkspace();
    const double dt = parameters.time_step();
    for (int i = 0; i < 60; ++i) {
      if (i == 31) copy = state;
      ASSERT_TRUE(Step(*model, parameters, dt, state, work).ok());
    }
    EXPECT_GT(state.scalars.q.cwiseAbs().maxCoeff(), 1e-3) << "fibres shorten";
    Workspace fresh = model->MakeWorkspace();
    SetStepThreads(2);
    for (int i = 31; i < 60; ++i) ASSERT_TRUE(Step(*model, parameters, dt, copy, fresh).ok());
    SetStepThreads(1);
    EXPECT_EQ(StateHash(copy), StateHash(state)) << tolerance;
  }
}

// Rest is an equilibrium: nothing pulls, and nothing drifts.
TEST(MusclePrestress, HoldsTheLoadAtRest) {
  for (const char* precision : {"", " precision: PRECISION_DOUBLE"}) {
    const auto model = CompileText(
        MuscleDome(std::string("balanced_at_rest: true") + precision, std::string(kDomePressure) + kDomeFriction));
    ASSERT_NE(model, nullptr);
    State state = model->InitialState();
    Points f(3, state.x.cols());
    model->plan->SumForces(MakeEvalContext(*model, model->parameters, state), f);
    EXPECT_LT((f * (model->inverse_mass.array() > 0).cast<double>().matrix().asDiagonal()).cwiseAbs().maxCoeff(),
              1e-12);
    v1::Parameters parameters = model->parameters;
    parameters.set_diaphragm_activation(0);
    Workspace work = model->MakeWorkspace();
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(Step(*model, parameters, parameters.time_step(), state, work).ok());
    EXPECT_LT((state.x - model->rest).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// Tensions, within their bounds, carry most of the pressure.
TEST(MusclePrestress, CarriesThePressureByTensionsWithinTheirBounds) {
  const auto model = CompileText(MuscleDome("balanced_at_rest: true", kDomePressure));
  const Points& left = TheMuscle(*model).rest_load();
  Points pressure = Points::Zero(3, left.cols());
  const State rest = model->InitialState();
  model->forces.back()->AddForce(MakeEvalContext(*model, model->parameters, rest), pressure);
  double carried = 0, all = 0;
  for (Eigen::Index i = 0; i < left.cols(); ++i) {
    if (model->inverse_mass[i] > 0) carried += left.col(i).norm(), all += pressure.col(i).norm();
  }
  EXPECT_LT(carried, 0.15 * all);
  for (const MuscleTriangle& triangle : TheMuscle(*model).triangles()) {
    EXPECT_GE(triangle.resting_along, 0.14 * 35);
    EXPECT_LE(triangle.resting_along, 120 * (1 + 1e-6));
    EXPECT_GE(triangle.resting_across, 0);
    EXPECT_LE(triangle.resting_across, 84 * (1 + 1e-6));
  }
}

// A flat sheet cannot hold a pressure; the surface behind it can, from one side only.
TEST(MusclePrestress, LeavesToContactsWhatPointsIntoThem) {
  const auto model = CompileText(MuscleStrip(""));
  std::vector<MuscleTriangle> triangles = TheMuscle(*model).triangles();
  const Eigen::Index n = model->rest.cols();
  const Eigen::VectorXd area = Eigen::VectorXd::Constant(n, 7e-5);
  for (const double pressure : {700.0, -700.0}) {
    Points load = Points::Zero(3, n), normals = load;
    load.row(2).setConstant(pressure * 7e-5);
    normals.row(2).setOnes();
    const PrestressReport report = ChoosePrestress(
        {.first = 0, .load = load, .normals = normals, .area = area, .free = std::vector<bool>(n, true)}, 120,
        StopCheck(), triangles);
    EXPECT_NEAR(report.contact.minCoeff(), std::max(0.0, pressure), 1);
    EXPECT_NEAR(report.contact.maxCoeff(), std::max(0.0, pressure), 1);
  }
}

TEST(MuscleStep, IsStableUpToItsLimitWithViscosity) {
  const auto model = CompileText(MuscleStrip("viscosity: 20 tendon_viscosity: 20 shortening_rate: 0"));
  ASSERT_NE(model, nullptr);
  v1::Parameters parameters = model->parameters;
  for (const auto integrator : {v1::INTEGRATOR_SEMI_IMPLICIT_EULER, v1::INTEGRATOR_VELOCITY_VERLET}) {
    parameters.set_integrator(integrator);
    parameters.set_diaphragm_activation(1);
    const double limit = LargestStableStep(*model, parameters).seconds();
    parameters.set_diaphragm_activation(0);
    const auto speed_after = [&](double dt) {
      State state = model->InitialState();
      Shake(1e-5, state);
      for (const int i : model->fixed_vertices) state.x.col(i) = model->rest.col(i), state.v.col(i).setZero();
      Workspace work = model->MakeWorkspace();
      for (int i = 0; i < 400; ++i) {
        if (!Step(*model, parameters, dt, state, work).ok()) return HUGE_VAL;
      }
      return state.v.cwiseAbs().maxCoeff();
    };
    EXPECT_LT(speed_after(0.95 * limit), 10);
    EXPECT_GT(speed_after(1.3 * limit), 1e3) << "the limit is not far from what is stable";
  }
}

TEST(MuscleStep, ImplicitIntegratorsKnowItsViscosity) {
  const auto model = CompileText(MuscleStrip("viscosity: 100 tendon_viscosity: 100 shortening_rate: 0"));
  for (const auto integrator : {v1::INTEGRATOR_LINEAR_IMPLICIT_EULER, v1::INTEGRATOR_BDF2, v1::INTEGRATOR_TR_BDF2,
                                v1::INTEGRATOR_PROJECTIVE_DYNAMICS}) {
    State state = AtPeakSignal(*model);
    v1::Parameters parameters = model->parameters;
    parameters.set_integrator(integrator);
    Workspace work = model->MakeWorkspace();
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(Step(*model, parameters, 0.01, state, work).ok()) << integrator;
    // Muscle of 882 N/m shortens against 100 N s/m at 8 per second, until force-length ends it.
    const double stretch = TheMuscle(*model).Read(0, MakeEvalContext(*model, parameters, state));
    EXPECT_GT(stretch, 0.45) << integrator;
    EXPECT_LT(stretch, 0.75) << integrator;
  }
}

// A strip held at its whole end, so that it narrows unevenly: finer meshes come together.
TEST(MuscleMesh, RefinementConverges) {
  std::vector<double> tip;
  for (const int n : {5, 9, 17}) {
    const auto model =
        CompileText(MuscleStrip("shortening_rate: 0", {.columns = 2 * n - 1, .rows = n},
                                "forces { point_load { body: 'strip' region: 'tendon' force { x: 6 } } }"));
    ASSERT_NE(model, nullptr);
    State state = AtPeakSignal(*model);
    v1::Parameters parameters = model->parameters;
    parameters.set_diaphragm_activation(0.2);
    parameters.set_integrator(v1::INTEGRATOR_STATIC);
    Workspace work = model->MakeWorkspace();
    ASSERT_TRUE(Step(*model, parameters, 1e-6, state, work).ok());
    tip.push_back(state.x(0, (n / 2) * (2 * n - 1) + n - 1));
  }
  EXPECT_LT(std::abs(tip[2] - tip[1]), 0.7 * std::abs(tip[1] - tip[0]));
  EXPECT_LT(std::abs(tip[2] - tip[1]), 1e-3);
}

TEST(MuscleScene, AnswersToActivation) {
  const auto model = CompileText(MuscleStrip(""));
  for (const std::string& idle : model->report.idle_parameters()) {
    EXPECT_TRUE(idle != "diaphragm_activation" && idle != "right_activation" && idle != "left_activation") << idle;
    EXPECT_TRUE(idle != "apply_muscles" && idle != "muscle_strength") << idle;
  }
}

TEST(MuscleScene, NamesWhatIsWrong) {
  const auto message = [](const std::string& text) { return std::string(TryCompileText(text).status().message()); };
  EXPECT_NE(message(MuscleStrip("passive_regions: 'cap'")).find("passive_regions[0]"), std::string::npos);
  EXPECT_NE(message(MuscleStrip("tendon_stiffness: -1")).find("tendon_stiffness"), std::string::npos);
}

}  // namespace
}  // namespace phrenic
