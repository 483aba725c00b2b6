// Measures the order and the energy of every integrator with the elements that a scene may have, and prints the tables
// of server/mechanics/README.md:
//
//   build/contract_test --gtest_filter='Measured*'
//
// A new element joins with one line in kScenes, a new integrator with one line in kMethods.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

#define FALLS(body) " forces { gravity { bodies: '" body "' acceleration { z: -9.81 } } }"

struct SceneCase {
  const char* name;
  const char* text;
  double seconds;
  double step;  // at which orders show: in their limit, above rounding [s]
};

const SceneCase kScenes[] = {
    {"springs",
     "bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0, 2] grid { columns: 3 rows: 3 u { x: 0.1 "
     "} v { y: 0.1 } } } forces { springs { bodies: 'sheet' stiffness: 200 } }" FALLS("sheet"),
     0.5, 2e-3},
    {"links",
     "bodies { name: 'two' role: ROLE_DEFORMABLE mass: 3 fixed_vertices: 0 polyhedron { vertices {} vertices { x: 0.4 "
     "y: 0.3 } vertices { x: 1 y: 0.3 z: 0.2 } } } constraints { rigid_links { body: 'two' list { links { a: 0 b: 1 } "
     "links { a: 1 b: 2 } } } }" FALLS("two"),
     0.5, 2e-3},
    {"links, driven",
     "bodies { name: 'two' role: ROLE_DEFORMABLE mass: 3 polyhedron { vertices {} vertices { x: 0.4 y: 0.3 } vertices "
     "{ x: 1 y: 0.3 z: 0.2 } edges { a: 1 b: 2 } } } motions { oscillation { body: 'two' vertices: 0 amplitude { y: "
     "0.05 z: 0.02 } period: 0.7 } } forces { springs { bodies: 'two' stiffness: 60 } } constraints { rigid_links { "
     "body: 'two' list { links { a: 0 b: 1 } } } }" FALLS("two"),
     0.5, 2e-3},
    {"links beside springs",
     "bodies { name: 'net' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0, 2] grid { columns: 3 rows: 3 u { x: 0.1 } "
     "v { y: 0.1 } } } forces { springs { bodies: 'net' stiffness: 400 } } constraints { rigid_links { body: 'net' "
     "list { links { a: 3 b: 4 } links { a: 4 b: 5 } links { a: 7 b: 8 } } } }" FALLS("net"),
     0.5, 1e-3},
    {"length limits, reached",
     "bodies { name: 'two' role: ROLE_DEFORMABLE mass: 3 fixed_vertices: 0 polyhedron { vertices {} vertices { z: -0.5 "
     "} vertices { x: 0.1 z: -0.9 } } } constraints { length_limits { body: 'two' list { links { a: 0 b: 1 } links { "
     "a: 1 b: 2 } } at_most_ratio: 1 } }" FALLS("two"),
     0.5, 2e-3},
    {"cables, taut",
     "bodies { name: 'net' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0, 2, 6, 8] grid { columns: 3 rows: 3 u { x: "
     "0.1 } v { y: 0.1 } } } forces { cables { body: 'net' stiffness: 300 rest_length_ratio: 0.5 } }" FALLS("net"),
     0.5, 2e-3},
    {"contact, held",
     "bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 0.9 polyhedron { vertices { x: -0.05 y: -0.05 z: -0.0005 } "
     "vertices { x: 0.05 y: -0.05 z: -0.0005 } vertices { y: 0.05 z: -0.0005 } triangles { a: 0 b: 1 c: 2 } } } bodies "
     "{ name: 'floor' role: ROLE_AT_REST polyhedron { vertices { x: -1 y: -1 } vertices { x: 1 y: -1 } vertices { y: 1 "
     "} triangles { a: 0 "
     "b: 1 c: 2 } } } forces { contact { bodies: 'sheet' surfaces: 'floor' depth: 0.01 load: 30 } } forces { springs { "
     "bodies: 'sheet' stiffness: 100 } }" FALLS("sheet"),
     0.5, 5e-4},
    {"pressure",
     "bodies { name: 'ball' role: ROLE_DEFORMABLE mass: 1 fixed_vertices: 0 ellipsoid { radii { x: 0.1 y: 0.1 z: 0.1 } "
     "divisions: 2 } "
     "} forces { springs { bodies: 'ball' stiffness: 200 rest_length_ratio: 0.9 } } forces { pressure { surface { "
     "bodies: 'ball' } compliance: 1e-6 pressure: 50 } }",
     0.3, 1e-3},
};

struct MethodCase {
  const char* name;
  double order;       // that the table of the README states
  double longer = 1;  // of the step: where its order shows
};

const MethodCase kMethods[] = {{"SEMI_IMPLICIT_EULER", 1, 0.25},   {"VELOCITY_VERLET", 2}, {"RUNGE_KUTTA_4", 4, 2},
                               {"LINEAR_IMPLICIT_EULER", 1, 0.01}, {"BDF2", 2, 0.5},       {"TR_BDF2", 2},
                               {"PROJECTIVE_DYNAMICS", 1, 0.05}};

std::shared_ptr<const Model> CompileFor(const std::string& scene, const std::string& integrator) {
  return CompileText("name: 'measured' " + scene + " parameters { integrator: INTEGRATOR_" + integrator + " }");
}

// The end of the motion by a method, halved until two steps give the same end.
const Points& Reference(const SceneCase& scene) {
  static std::map<std::string, Points> ends;
  Points& end = ends[scene.name];
  if (end.size() == 0) end = RunTo(*CompileFor(scene.text, "RUNGE_KUTTA_4"), scene.seconds, scene.step / 16).x;
  return end;
}

double MeasuredOrder(const SceneCase& scene, const MethodCase& method) {
  const auto model = CompileFor(scene.text, method.name);
  if (model == nullptr) return NAN;
  const auto error = [&](double dt) { return (RunTo(*model, scene.seconds, dt).x - Reference(scene)).norm(); };
  const double dt = scene.step * method.longer;
  const double one = error(dt), two = error(dt / 2);
  return std::log2(one / two);
}

TEST(MeasuredOrder, OfEveryIntegratorWithEveryElement) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the Release build runs it; the same code runs under sanitizers in the other tests of this program";
#endif
  std::printf("| integrator |");
  for (const SceneCase& scene : kScenes) std::printf(" %s |", scene.name);
  std::printf("\n");
  for (const MethodCase& method : kMethods) {
    std::printf("| %s |", method.name);
    for (const SceneCase& scene : kScenes) {
      const double order = MeasuredOrder(scene, method);
      std::printf(" %.2f |", order);
      EXPECT_GT(order, method.order - 0.15) << method.name << ", " << scene.name;
    }
    std::printf("\n");
  }
}

// What a scene has without its motions: kinetic energy and that of all conservative forces.
struct Energies {
  double kinetic = 0, whole = 0;
};

Energies EnergiesOf(const Model& model, const State& state) {
  Energies energies;
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model.inverse_mass[i] > 0) energies.kinetic += 0.5 * model.mass[i] * state.v.col(i).squaredNorm();
  }
  energies.whole = energies.kinetic;
  const EvalContext at = MakeEvalContext(model, model.parameters, state);
  for (const auto& force : model.forces) energies.whole += force->conservative() ? force->Energy(at) : 0;
  return energies;
}

// A scene in which nothing acts but what stores energy: it cannot have more than at the start.
const SceneCase kPassive[] = {
    {"springs, stiff",
     "bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0, 2] grid { columns: 3 rows: 3 u { x: 0.1 "
     "} v { y: 0.1 } } } forces { springs { bodies: 'sheet' stiffness: 1e5 } }" FALLS("sheet"),
     0, 0},
    {"links", kScenes[1].text, 0, 0},
    {"links beside stiff springs",
     "bodies { name: 'net' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0, 2] grid { columns: 3 rows: 4 u { x: 0.1 } "
     "v { y: 0.1 } } } forces { springs { bodies: 'net' stiffness: 1e5 } } constraints { rigid_links { body: 'net' "
     "list { links { a: 3 b: 4 } links { a: 4 b: 5 } links { a: 7 b: 10 } links { a: 8 b: 11 } } } }" FALLS("net"),
     0, 0},
    {"length limits", kScenes[4].text, 0, 0},
    {"cables", kScenes[5].text, 0, 0},
    {"contact", kScenes[6].text, 0, 0},
    {"pressure", kScenes[7].text, 0, 0},
};

// The largest energy above the first in 10 s, relative to the largest kinetic energy of the exact motion in 1 s.
double LargestGain(const SceneCase& scene, const char* integrator, double dt) {
  const auto exact = CompileFor(scene.text, "VELOCITY_VERLET");
  const auto model = CompileFor(scene.text, integrator);
  if (exact == nullptr || model == nullptr) return NAN;
  const auto run = [](const Model& of, double step, double seconds, auto see) {
    State state = of.InitialState();
    Workspace work = of.MakeWorkspace();
    for (double t = 0; t < seconds; t += step) {
      if (const absl::Status stepped = Step(of, of.parameters, step, state, work); !stepped.ok()) {
        ADD_FAILURE() << stepped << " at " << t;
        return see(Energies{HUGE_VAL, HUGE_VAL});
      }
      see(EnergiesOf(of, state));
    }
  };
  double most = 0, gain = 0;
  run(*exact, std::min(1e-3, 0.2 * exact->report.stable_step().seconds()), 1.0,
      [&](const Energies& at) { most = std::max(most, at.kinetic); });
  const double first = EnergiesOf(*model, model->InitialState()).whole;
  run(*model, dt, 10.0, [&](const Energies& at) { gain = std::max(gain, at.whole - first); });
  return gain / most;
}

// What server/mechanics/README.md states: none, but projective dynamics projects links after its step, and one Newton
// step is not enough where stiff springs turn far in one step.
double MostGain(const std::string& integrator, double dt) {
  if (integrator == "PROJECTIVE_DYNAMICS") return 5 * dt;
  return integrator == "LINEAR_IMPLICIT_EULER" && dt > 1e-2 ? HUGE_VAL : 2e-3;
}

TEST(MeasuredEnergy, OfImplicitIntegratorsWithEveryElement) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the Release build runs it; the same code runs under sanitizers in the other tests of this program";
#endif
  std::printf("| integrator | step |");
  for (const SceneCase& scene : kPassive) std::printf(" %s |", scene.name);
  std::printf("\n");
  for (const char* integrator : {"LINEAR_IMPLICIT_EULER", "BDF2", "TR_BDF2", "PROJECTIVE_DYNAMICS"}) {
    for (const double dt : {2e-3, 1e-2, 5e-2}) {
      std::printf("| %s | %g ms |", integrator, 1e3 * dt);
      for (const SceneCase& scene : kPassive) {
        const double gain = LargestGain(scene, integrator, dt);
        std::printf(" %.3f |", gain);
        EXPECT_LT(gain, MostGain(integrator, dt)) << integrator << ", " << scene.name << ", " << dt;
      }
      std::printf("\n");
    }
  }
}

}  // namespace
}  // namespace phrenic
