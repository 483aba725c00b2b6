#include "server/study/extreme_cases.h"

#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic::study {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kChain = 20;  // vertices

// A sheet of 6 x 6 vertices, 10 cm apart, that hangs from its first row; `mass` is the total [kg].
std::string Hanging(const std::string& mass, const std::string& more) {
  return absl::StrCat(R"(
    name: "extreme"
    bodies {
      name: "b" role: ROLE_DEFORMABLE mass: )",
                      mass, R"( fixed_vertices: [0, 1, 2, 3, 4, 5]
      grid { columns: 6 rows: 6 u { x: 0.1 } v { z: -0.1 } }
      regions { name: "top" low { x: -1 y: -1 z: -0.05 } high { x: 1 y: 1 z: 1 } }
      regions { name: "bottom" low { x: -1 y: -1 z: -1 } high { x: 1 y: 1 z: -0.45 } }
    }
  )",
                      more);
}

const char kGravity[] = R"(forces { gravity { bodies: "b" acceleration { z: -9.81 } } })";
const char kSoftSprings[] = R"(forces { springs { bodies: "b" stiffness: 100 } })";
const char kFriction[] = R"(forces { friction { bodies: "b" rate: 1 } })";

std::string Usual() { return absl::StrCat(kSoftSprings, kFriction, kGravity); }
std::string Sheet(const std::string& more) { return Hanging("0.36", more); }

// Pulls the sheet out of its plane with `newtons` at the peak of a breath of half a second.
std::string Pulled(const std::string& newtons) {
  return Sheet(absl::StrCat(Usual(), R"(
    forces { action_line { bodies: "b" origin { x: 0.25 z: -0.25 } direction { y: 1 } radius: 0.3 force: )",
                            newtons, R"( } }
    parameters { breath_length: 0.5 }
  )"));
}

// A body of explicit vertices, joined by springs along `edges`.
std::string Points3(const std::string& vertices, const std::string& edges, const std::string& more) {
  return absl::StrCat(R"(name: "extreme" bodies { name: "b" role: ROLE_DEFORMABLE mass: 0.04 )", more, " polyhedron {",
                      vertices, edges, "} } ", Usual());
}

std::string Coincident() {
  return Points3("vertices { } vertices { z: -0.1 } vertices { z: -0.1 } vertices { z: -0.2 }",
                 "edges { a: 0 b: 1 } edges { a: 1 b: 2 } edges { a: 2 b: 3 }", "fixed_vertices: [0]");
}

std::string OnePoint() {
  return Points3("vertices { } vertices { } vertices { } vertices { }",
                 "edges { a: 0 b: 1 } edges { a: 1 b: 2 } edges { a: 2 b: 3 } edges { a: 3 b: 0 }", "");
}

std::string NotANumber() { return Points3("vertices { } vertices { z: nan }", "edges { a: 0 b: 1 }", ""); }

// A chain in which every fifth spring is 1e7 times as stiff as the others.
std::string StiffFifths() {
  std::string vertices, edges, regions, springs;
  for (int i = 0; i < kChain; ++i) {
    absl::StrAppend(&vertices, absl::StrFormat("vertices { x: %g }", 0.1 * i));
    if (i + 1 < kChain) absl::StrAppend(&edges, absl::StrFormat("edges { a: %d b: %d }", i, i + 1));
    if (i % 5 != 3 || i + 1 == kChain) continue;
    absl::StrAppend(&regions,
                    absl::StrFormat("regions { name: \"r%d\" low { x: %g y: -1 z: -1 } high { x: %g y: 1 z: 1 } }", i,
                                    0.1 * i - 0.05, 0.1 * i + 0.15));
    absl::StrAppend(&springs,
                    absl::StrFormat("forces { springs { bodies: \"b\" stiffness: 1e9 region: \"r%d\" } }", i));
  }
  return absl::StrCat(Points3(vertices, edges, absl::StrCat("fixed_vertices: [0, 19]", regions)), springs);
}

std::string MassRatio() {
  return absl::StrCat(R"(
    name: "extreme"
    bodies { name: "b" role: ROLE_DEFORMABLE mass: 0.09 fixed_vertices: [0, 1, 2]
      grid { columns: 3 rows: 3 u { x: 0.1 } v { z: -0.1 } } }
    bodies { name: "light" role: ROLE_DEFORMABLE mass: 9e-8
      grid { columns: 3 rows: 3 origin { y: 0.05 } u { x: 0.1 } v { z: -0.1 } } }
    forces { cross_layer { bodies: "light" other_bodies: "b" distance: 0.08 stiffness: 100 } }
    forces { springs { bodies: "light" stiffness: 100 } }
  )",
                      Usual());
}

std::string Dome(const std::string& forces) {
  return absl::StrCat(R"(
    name: "extreme"
    bodies {
      name: "b" role: ROLE_DEFORMABLE mass: 0.1 fixed_regions: "rim"
      ellipsoid { radii { x: 0.1 y: 0.1 z: 0.06 } divisions: 4 upper_half: true }
      regions { name: "tendon" low { x: -1 y: -1 z: 0.05 } high { x: 1 y: 1 z: 1 } }
    }
  )",
                      kFriction, kGravity, forces);
}

std::string FibreRatio() {
  return Dome(R"(
    forces { membrane { bodies: "b" youngs_modulus: 5000 thickness: 0.003 } }
    forces { fibres { bodies: "b" from_region: "rim" to_region: "tendon" modulus_along: 5e9 thickness: 0.003 active_stress: 100 } }
  )");
}

std::string Shell() {
  return Dome(R"(
    forces { springs { bodies: "b" stiffness: 100 } }
    forces { bending { bodies: "b" youngs_modulus: 5e5 thickness: 0.004 } }
  )");
}

// A triangle with a height of 1e-6 of its length, and one of opposite orientation.
std::string Slivers() {
  return absl::StrCat(R"(
    name: "extreme"
    bodies { name: "b" role: ROLE_DEFORMABLE mass: 0.04 fixed_vertices: [0, 1]
      polyhedron {
        vertices { } vertices { x: 0.1 } vertices { x: 0.05 z: -1e-7 } vertices { x: 0.05 z: -0.1 }
        triangles { a: 0 b: 1 c: 2 } triangles { a: 2 b: 1 c: 3 } triangles { a: 0 b: 3 c: 2 }
      } }
    forces { membrane { bodies: "b" youngs_modulus: 5000 thickness: 0.003 } }
  )",
                      kFriction, kGravity);
}

std::string Flat() {
  return absl::StrCat(R"(
    name: "extreme"
    bodies { name: "b" role: ROLE_DEFORMABLE mass: 0.04 fixed_vertices: [0, 1]
      polyhedron {
        vertices { } vertices { x: 0.1 } vertices { x: 0.05 } vertices { x: 0.05 z: -0.1 }
        triangles { a: 0 b: 1 c: 2 } triangles { a: 2 b: 1 c: 3 } triangles { a: 0 b: 3 c: 2 }
      } }
    forces { membrane { bodies: "b" youngs_modulus: 5000 thickness: 0.003 } }
  )",
                      kFriction, kGravity);
}

std::string Solid() {
  return absl::StrCat(R"(
    name: "extreme"
    bodies { name: "b" role: ROLE_DEFORMABLE mass: 0.2 fixed_regions: "top"
      block { origin { z: -0.1 } size { x: 0.1 y: 0.1 z: 0.1 } columns: 2 rows: 2 layers: 2 }
      regions { name: "top" low { x: -1 y: -1 z: -0.01 } high { x: 1 y: 1 z: 1 } } }
    forces { solid { bodies: "b" youngs_modulus: 5000 poissons_ratio: 0.3 } }
  )",
                      kFriction, kGravity);
}

// Links between a fixed vertex and one that is driven away: their lengths cannot all be kept.
std::string ConflictingLinks() {
  return absl::StrCat(R"(
    name: "extreme"
    bodies { name: "b" role: ROLE_DEFORMABLE mass: 0.04 fixed_vertices: [0]
      polyhedron {
        vertices { } vertices { x: 0.1 } vertices { x: 0.2 } vertices { x: 0.1 z: -0.1 }
        edges { a: 0 b: 1 } edges { a: 1 b: 2 } edges { a: 1 b: 3 }
      } }
    motions { oscillation { body: "b" vertices: [2] amplitude { x: 0.2 } period: 0.4 } }
    constraints { rigid_links { body: "b" list { links { a: 0 b: 1 } links { a: 1 b: 2 } links { a: 0 b: 3 } links { a: 3 b: 2 } } } }
  )",
                      Usual());
}

// Every kind of element acts on one vertex, the lower right corner.
std::string Everything() {
  return absl::StrCat(Sheet(Usual()), R"(
    bodies { name: "post" role: ROLE_AT_REST
      polyhedron { vertices { x: 0.55 z: -0.5 } vertices { x: 0.55 y: 0.1 z: -0.5 } vertices { x: 0.55 z: -0.6 }
                   triangles { a: 0 b: 1 c: 2 } triangles { a: 0 b: 2 c: 1 } } }
    bodies { name: "floor" role: ROLE_AT_REST
      grid { columns: 2 rows: 2 origin { x: -1 y: -1 z: -0.52 } u { x: 3 } v { y: 3 } } }
    forces { membrane { bodies: "b" youngs_modulus: 5000 thickness: 0.003 } }
    forces { bending { bodies: "b" youngs_modulus: 5000 thickness: 0.003 } }
    forces { fibres { bodies: "b" from_region: "top" to_region: "bottom" modulus_along: 5000 active_stress: 100 } }
    forces { cables { body: "b" list { links { a: 35 b: 0 } links { a: 35 b: 6 } } stiffness: 100 } }
    forces { attachment { bodies: "b" anchors: "post" radius: 0.1 stiffness: 100 } }
    forces { contact { bodies: "b" surfaces: "floor" depth: 0.01 } }
    forces { action_line { bodies: "b" origin { x: 0.5 z: -0.5 } direction { z: 1 } radius: 0.2 force: 1 } }
    constraints { rigid_links { body: "b" list { links { a: 35 b: 28 } links { a: 35 b: 29 } } } }
    constraints { length_limits { body: "b" list { links { a: 35 b: 34 } } at_most_ratio: 1.1 at_least_ratio: 0.9 } }
  )");
}

// Scales the positions of free vertices by the factors x, y, z.
std::function<void(const Model&, State&)> Scaled(double x, double y, double z) {
  return [=](const Model& model, State& state) {
    for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
      if (model.inverse_mass[i] > 0) state.x.col(i) = state.x.col(i).cwiseProduct(Eigen::Vector3d(x, y, z));
    }
  };
}

void Compress(const Model& model, State& state) {
  Scaled(1.0 / 3, 1.0 / 3, 1.0 / 3)(model, state);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {  // a small displacement out of the plane, so that it can buckle
    if (model.inverse_mass[i] > 0) state.x(1, i) += 1e-4 * static_cast<double>(i % 3 - 1);
  }
}

void Throw(const Model& model, State& state) {
  for (Eigen::Index i = 0; i < state.v.cols(); ++i) {
    if (model.inverse_mass[i] > 0) state.v(1, i) = 100;
  }
}

void SetNanPosition(const Model&, State& state) { state.x(1, state.x.cols() - 1) = kNan; }
void SetInfiniteForce(v1::Parameters& parameters) { parameters.set_breath_force(kInfinity); }

std::vector<ExtremeCase> RefusedOrStopped() {
  return {
      {.name = "NaN in a position of the scene", .scene = NotANumber()},
      {.name = "NaN in a position of a run", .scene = Sheet(Usual()), .disturb = SetNanPosition},
      {.name = "infinite force in the scene", .scene = Pulled("inf")},
      {.name = "infinite force in a run", .scene = Pulled("1"), .adjust = SetInfiniteForce},
      {.name = "zero mass", .scene = Hanging("0", Usual())},
  };
}

std::vector<ExtremeCase> Stiff() {
  return {
      {.name = "mass ratio 1e6", .scene = MassRatio(), .step = 0.001, .seconds = 0.2},
      {.name = "stiffness 1e9 on every fifth spring", .scene = StiffFifths()},
      {.name = "fibre ratio 1e6", .scene = FibreRatio(), .criteria = {.error = false}},
      {.name = "time step x 10", .scene = Sheet(Usual()), .step = 0.04, .criteria = {.error = false}},
      {.name = "friction rate 1e6",
       .scene = Sheet(absl::StrCat(kSoftSprings, kGravity, R"(forces { friction { bodies: "b" rate: 1e6 } })")),
       .seconds = 0.1},
      {.name = "force x 10", .scene = Pulled("10")},
      {.name = "force x 1000", .scene = Pulled("1000")},
      {.name = "initial speed 100 m/s", .scene = Sheet(Usual()), .criteria = {.error = false}, .disturb = Throw},
  };
}

std::vector<ExtremeCase> Degenerate() {
  return {
      {.name = "zero rest length",
       .scene = Sheet(absl::StrCat(kFriction, kGravity,
                                   R"(forces { springs { bodies: "b" stiffness: 100 rest_length_ratio: 0 } })")),
       .step = 0.002},
      {.name = "coincident vertices, connected", .scene = Coincident()},
      {.name = "all vertices in one point", .scene = OnePoint()},
      {.name = "nothing acts", .scene = Sheet("")},
      {.name = "no stiffness",
       .scene = Sheet(absl::StrCat(kFriction, kGravity, R"(forces { springs { bodies: "b" stiffness: 0 } })"))},
      {.name = "slivers", .scene = Slivers()},
      {.name = "a triangle without area", .scene = Flat()},
      {.name = "inverted tetrahedra",
       .scene = Solid(),
       .step = 0.001,
       .seconds = 0.1,
       .criteria = {.error = false},
       .disturb = Scaled(1, 1, -1)},
  };
}

std::vector<ExtremeCase> Folded() {
  return {
      {.name = "compressed threefold", .scene = Sheet(Usual()), .criteria = {.error = false}, .disturb = Compress},
      {.name = "inverted dome", .scene = Shell(), .criteria = {.error = false}, .disturb = Scaled(1, 1, -1)},
      {.name = "conflicting links", .scene = ConflictingLinks(), .criteria = {.energy = false, .error = false}},
      {.name = "everything on one vertex", .scene = Everything()},
  };
}

}  // namespace

std::vector<ExtremeCase> ExtremeCases() {
  std::vector<ExtremeCase> cases = {{.name = "baseline", .scene = Sheet(Usual())}};
  for (auto& part : {Degenerate(), RefusedOrStopped(), Stiff(), Folded()}) {
    cases.insert(cases.end(), part.begin(), part.end());
  }
  return cases;
}

}  // namespace phrenic::study
