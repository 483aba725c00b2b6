// What `inspect` says a scene would refuse is what compiling a scene refuses, for every use and many broken surfaces.
#include "server/compare/refusals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "server/mechanics/compile/compile.h"
#include "server/mesh/ellipsoid.h"
#include "server/mesh/repair_all.h"
#include "server/schema/schema.h"

namespace phrenic::compare {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

struct Use {
  const char* named;  // in the refusal
  const char* scene;
};

// Scenes as a person writes them around a file.
constexpr Use kUses[] = {
    {"a material",
     "bodies { name: 'a' role: ROLE_DEFORMABLE material { density: 1000 } file { path: 'a.stl' } } "
     "forces { gravity { bodies: 'a' acceleration { z: -9.81 } } }"},
    {"contact on it",
     "bodies { name: 'a' role: ROLE_AT_REST file { path: 'a.stl' } } "
     "bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 2 "
     "         grid { columns: 3 rows: 3 origin { z: 1 } u { x: 0.1 } v { y: 0.1 } } } "
     "forces { contact { bodies: 'sheet' surfaces: 'a' depth: 0.002 } }"},
    {"springs that draw to it",
     "bodies { name: 'a' role: ROLE_AT_REST file { path: 'a.stl' } } "
     "bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 2 "
     "         grid { columns: 3 rows: 3 origin { z: 1 } u { x: 0.1 } v { y: 0.1 } } } "
     "forces { target_spring { bodies: 'sheet' surface: 'a' stiffness: 5 } }"},
    {"a pressure on it",
     "bodies { name: 'a' role: ROLE_DEFORMABLE mass: 1 file { path: 'a.stl' } } "
     "forces { pressure { surface { bodies: 'a' } breath_pressure: 100 } }"},
    {"bodies that follow its triangles",
     "bodies { name: 'a' role: ROLE_DEFORMABLE mass: 1 file { path: 'a.stl' } } "
     "bodies { name: 'seen' role: ROLE_SEEN grid { columns: 3 rows: 3 u { x: 0.1 } v { y: 0.1 } } } "
     "motions { skin { bodies: 'seen' drivers: 'a' mode: SKIN_MODE_TRIANGLES } }"},
    {"a lung",
     "bodies { name: 'a' role: ROLE_DEFORMABLE mass: 1 anatomy { structure: STRUCTURE_LUNG side: SIDE_LEFT } file { "
     "path: 'a.stl' } "
     "} "
     "motions { lung_modes { lungs: 'a' } }"},
};

bool Compiles(const std::string& text, const Mesh& mesh) {
  const auto scene = schema::ParseScene("scene", "name: 'test' " + text);
  EXPECT_TRUE(scene.ok()) << scene.status();
  return Compile(*scene, [&mesh](const v1::Body&) -> absl::StatusOr<Mesh> { return mesh; }).ok();
}

Mesh WholeBall() { return EllipsoidSurface({0, 0, 0}, {0.05, 0.05, 0.05}, 5, false); }

Mesh Of(Points vertices, Triangles triangles) { return {std::move(vertices), std::move(triangles), {}, {}, {}}; }

std::vector<std::pair<const char*, Mesh>> BrokenSurfaces() {
  std::vector<std::pair<const char*, Mesh>> meshes = {{"whole", WholeBall()}};
  const auto add = [&meshes](const char* name) -> Mesh& { return meshes.emplace_back(name, WholeBall()).second; };
  Mesh& hole = add("with a hole");
  hole.triangles = Triangles(hole.triangles.rightCols(hole.triangles.cols() - 1));
  Mesh& inwards = add("facing inwards");
  inwards.triangles.row(0).swap(inwards.triangles.row(1));
  Mesh& turned = add("with a turned triangle");
  std::swap(turned.triangles(0, 3), turned.triangles(1, 3));
  Mesh& doubled = add("with a doubled vertex");
  doubled.vertices.conservativeResize(3, doubled.vertices.cols() + 1);
  doubled.vertices.rightCols(1) = doubled.vertices.col(4);
  add("very far away").vertices.array() += 2e6;
  add("very large").vertices *= 1e4;
  meshes.emplace_back("points alone", Of(Points::Identity(3, 3), Triangles(3, 0)));
  meshes.emplace_back("flat triangle", Of(Points::Zero(3, 3), Triangles::Zero(3, 1)));
  meshes.emplace_back("sheet", EllipsoidSurface({0, 0, 0}, {0.05, 0.05, 0.05}, 5, true));
  return meshes;
}

TEST(Refusals, AreThoseOfCompilation) {
  for (const auto& [name, mesh] : BrokenSurfaces()) {
    const std::vector<std::string> refusals = Refusals(mesh);
    bool any = false;
    for (const Use& use : kUses) {
      const bool compiles = Compiles(use.scene, mesh);
      any = any || !compiles;
      const bool named = std::any_of(refusals.begin(), refusals.end(), [&use](const std::string& refusal) {
        return refusal.starts_with(use.named) || refusal.starts_with("any body");
      });
      EXPECT_EQ(named, !compiles) << name << ", " << use.named << ": " << testing::PrintToString(refusals);
    }
    if (!any) continue;
    EXPECT_THAT(refusals, testing::Not(IsEmpty())) << name;
  }
}

TEST(Refusals, AWholeBallIsRefusedNothing) { EXPECT_THAT(Refusals(WholeBall()), IsEmpty()); }

TEST(Refusals, RepairRemovesThem) {
  for (const auto& [name, mesh] : BrokenSurfaces()) {
    const std::string what = name;
    if (what != "with a hole" && what != "facing inwards" && what != "with a turned triangle" &&
        what != "with a doubled vertex") {
      continue;
    }
    EXPECT_THAT(Refusals(mesh), testing::Not(IsEmpty())) << name;
    Mesh repaired = mesh;
    RepairOptions options;
    options.repairs = {"all"};
    options.hole = 0.05;
    RepairAll(options, repaired);
    EXPECT_THAT(Refusals(repaired), IsEmpty()) << name;
  }
}

TEST(Refusals, ASolidIsTriedByCells) {
  Mesh inwards = WholeBall();
  inwards.triangles.row(0).swap(inwards.triangles.row(1));
  EXPECT_THAT(Refusals(inwards), testing::Contains(HasSubstr("a solid that fills it by cells of 12.5 mm")));
  const std::string solid = "bodies { name: 'a' role: ROLE_SEEN filling { cell: 0.0125 file { path: 'a.stl' } } }";
  EXPECT_FALSE(Compiles(solid, inwards));
  EXPECT_TRUE(Compiles(solid, WholeBall()));
}

// A dome of muscle from its rim to a tendon, and crumbs beside it.
TEST(Refusals, AMuscleOfWhichNothingHoldsAPartIsRefusedUntilItIsRepaired) {
  const std::string scene =
      "bodies { name: 'a' role: ROLE_DEFORMABLE mass: 1 fixed_regions: 'rim' file { path: 'a.stl' } } "
      "forces { muscle { body: 'a' from_region: 'rim' tendon_region: 'tendon' } }";
  Mesh dome = EllipsoidSurface({0, 0, 0}, {0.1, 0.1, 0.08}, 8, true);
  for (int i = 0; i < static_cast<int>(dome.vertices.cols()); ++i) {
    if (dome.vertices(2, i) > 0.07) dome.regions["tendon"].push_back(i);
  }
  EXPECT_TRUE(Compiles(scene, dome));
  const auto first = static_cast<int>(dome.vertices.cols());
  Mesh crumbs = dome;
  crumbs.vertices.conservativeResize(3, first + 3);
  crumbs.vertices.rightCols(3) = 0.001 * Points::Identity(3, 3);
  crumbs.triangles.conservativeResize(3, crumbs.triangles.cols() + 1);
  crumbs.triangles.rightCols(1) << first, first + 1, first + 2;
  EXPECT_FALSE(Compiles(scene, crumbs));
  RepairOptions options;
  options.repairs = {"all"};
  RepairAll(options, crumbs);
  EXPECT_TRUE(Compiles(scene, crumbs));
  EXPECT_EQ(crumbs.vertices, dome.vertices);
}

}  // namespace
}  // namespace phrenic::compare
