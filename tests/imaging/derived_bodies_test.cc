// Inner cage and middle surface derived from surfaces: those of the generated thorax, whose own are known.
#include "server/imaging/surfaces/derived_bodies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/anatomy/anatomy.h"
#include "server/imaging/surfaces/surface_scene.h"
#include "server/imaging/surfaces/voxelised_parts.h"
#include "server/mesh/topology.h"
#include "server/mesh/triangle_tree.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

using ::testing::HasSubstr;

constexpr char kBodies[] = R"(name: "person"
  bodies { name: "diaphragm" role: ROLE_SEEN anatomy { structure: STRUCTURE_DIAPHRAGM }
           derived { file { path: "diaphragm.obj" } } }
  bodies { name: "diaphragm-middle" role: ROLE_DEFORMABLE anatomy { structure: STRUCTURE_DIAPHRAGM }
           derived { resolution_mm: 6 } }
  bodies { name: "chest-wall" role: ROLE_SEEN anatomy { structure: STRUCTURE_INNER_CAGE } derived {} }
  bodies { name: "rib-{number}-{side}" for_each { numbers { first: 1 last: 12 } sides: [SIDE_RIGHT, SIDE_LEFT] }
           role: ROLE_DRIVEN anatomy { structure: STRUCTURE_RIB } file { path: "rib.obj" } }
  bodies { name: "cartilage-{number}-{side}" for_each { numbers { first: 1 last: 10 } sides: [SIDE_RIGHT, SIDE_LEFT] }
           role: ROLE_SEEN anatomy { structure: STRUCTURE_COSTAL_CARTILAGE } file { path: "cartilage.obj" } }
  bodies { name: "{vertebra}" for_each { numbers { first: 1 last: 15 } } role: ROLE_AT_REST
           anatomy { structure: STRUCTURE_VERTEBRA } file { path: "vertebra.obj" } }
  bodies { name: "manubrium" role: ROLE_DRIVEN anatomy { structure: STRUCTURE_MANUBRIUM } file { path: "m.obj" } }
  bodies { name: "sternum-body" role: ROLE_DRIVEN anatomy { structure: STRUCTURE_STERNUM_BODY } file { path: "s.obj" } }
  bodies { name: "xiphoid" role: ROLE_DRIVEN anatomy { structure: STRUCTURE_XIPHOID } file { path: "x.obj" } }
  bodies { name: "lung-{side}" for_each { sides: [SIDE_RIGHT, SIDE_LEFT] } role: ROLE_SEEN
           anatomy { structure: STRUCTURE_LUNG } file { path: "lung.obj" } })";

v1::Scene Person() { return *schema::ParseScene("person", kBodies); }

v1::Body* FindBody(v1::Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(*scene.mutable_bodies(), name, &v1::Body::name);
  return found == scene.mutable_bodies()->end() ? nullptr : &*found;
}

// Stands for files: the generated thorax.
absl::StatusOr<Mesh> Surface(const v1::Body& body) {
  if (!body.has_file()) return absl::NotFoundError("not a file");
  return anatomy::Generate(body.anatomy(), 8);
}

Mesh Truth(v1::Structure structure, v1::Sheet sheet) {
  v1::Anatomy part;
  part.set_structure(structure);
  return *anatomy::Generate(part, 6, sheet);
}

// Returns the distances of a's vertices from b [mm], ascending.
std::vector<double> SortedDistances(const Mesh& a, const Mesh& b) {
  const TriangleTree tree(b.vertices, b.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(b.vertices, boxes);
  std::vector<double> distances;
  for (const auto x : a.vertices.colwise())
    distances.push_back(1e3 * std::sqrt(tree.Nearest(b.vertices, boxes, x, 1).squared));
  std::ranges::sort(distances);
  return distances;
}

double MeanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

class DerivedBodies : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    v1::Scene scene = Person();
    const BodySource source = WithDerived(&Surface, scene);
    layers_ = *source(*FindBody(scene, "diaphragm"));
    middle_ = *source(*FindBody(scene, "diaphragm-middle"));
    cage_ = *source(*FindBody(scene, "chest-wall"));
  }

  inline static Mesh layers_, middle_, cage_;
};

TEST_F(DerivedBodies, MiddleSurfaceIsThatOfTheLayers) {
  const Mesh truth = Truth(v1::STRUCTURE_DIAPHRAGM, v1::SHEET_MIDDLE);
  const std::vector<double> there = SortedDistances(middle_, truth), back = SortedDistances(truth, middle_);
  std::printf("middle surface: %.2f and %.2f mm, 95 %% %.2f and %.2f\n", MeanOf(there), MeanOf(back),
              there[there.size() * 95 / 100], back[back.size() * 95 / 100]);
  EXPECT_LT(MeanOf(there), 1.5);
  EXPECT_LT(MeanOf(back), 1.5);
  EXPECT_EQ(BoundaryVertices(middle_.triangles).size(), middle_.regions.at("rim").size()) << "no openings";
}

TEST_F(DerivedBodies, CageIsInsideOfTheBonesAndTheSheetInsideOfTheCage) {
  const Mesh truth = Truth(v1::STRUCTURE_INNER_CAGE, v1::SHEET_UNSPECIFIED);
  Mesh apposed = cage_;  // where the diaphragm lies on it; above, mediastinum and lungs leave it open what the wall is
  apposed.vertices.resize(3, 0);
  for (const auto x : cage_.vertices.colwise()) {
    if (x.z() < 0.08 || x.z() > 0.16) continue;
    apposed.vertices.conservativeResize(3, apposed.vertices.cols() + 1);
    apposed.vertices.rightCols(1) = x;
  }
  const std::vector<double> off = SortedDistances(apposed, truth);
  std::printf("inner cage: %.2f mm, 95 %% %.2f\n", MeanOf(off), off[off.size() * 95 / 100]);
  EXPECT_LT(MeanOf(off), 5);  // the wall is as far inside of the ribs
  const TriangleTree tree(cage_.vertices, cage_.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(cage_.vertices, boxes);
  double furthest = 0;
  for (const auto x : middle_.vertices.colwise()) {
    const SurfacePoint nearest = tree.Nearest(cage_.vertices, boxes, x, 1);
    if (nearest.facing < 0 && !nearest.on_boundary) furthest = std::max(furthest, std::sqrt(nearest.squared));
  }
  EXPECT_LT(furthest, 0.5e-3) << "outside of the cage";
}

TEST_F(DerivedBodies, LayersKeepTheirTrianglesAndStayWhereTheyAreInsideTheCage) {
  v1::Scene scene = Person();
  const v1::SurfaceFile path = FindBody(scene, "diaphragm")->derived().file();
  v1::Body read = *FindBody(scene, "diaphragm");
  *read.mutable_file() = path;
  const Mesh scanned = *Surface(read);
  ASSERT_EQ(layers_.vertices.cols(), scanned.vertices.cols());
  EXPECT_EQ(layers_.triangles, scanned.triangles);
  const auto moved = (layers_.vertices - scanned.vertices).colwise().norm().eval();
  std::printf("layers moved: %.2f mm at most, %.2f on average\n", 1e3 * moved.maxCoeff(), 1e3 * moved.mean());
  EXPECT_LT(moved.mean(), 1e-3);
}

TEST_F(DerivedBodies, FollowTheSurfacesPlace) {
  v1::Scene scene = Person();
  for (v1::Body& body : *scene.mutable_bodies()) {
    if (body.name() != "diaphragm-middle" && body.name() != "chest-wall") body.mutable_offset()->set_z(0.5);
  }
  const BodySource source = WithDerived(&Surface, scene);
  // The grid of voxels is shifted by rounding, and the mesh may have some vertices more or less.
  Mesh middle = *source(*FindBody(scene, "diaphragm-middle"));
  const Mesh layers = *source(*FindBody(scene, "diaphragm"));
  middle.vertices.row(2).array() -= 0.5;
  EXPECT_LT(MeanOf(SortedDistances(middle, middle_)), 0.2);
  EXPECT_LT((layers.vertices - layers_.vertices).colwise().norm().mean(), 2e-4) << "the body's offset moves it later";
}

std::string ErrorOf(const v1::Scene& scene, const std::string& body) {
  v1::Scene copy = scene;
  const auto mesh = WithDerived(&Surface, copy)(*FindBody(copy, body));
  return mesh.ok() ? "" : std::string(mesh.status().message());
}

TEST_F(DerivedBodies, SaysWhatIsMissing) {
  v1::Scene alone = Person();
  while (alone.bodies_size() > 3) alone.mutable_bodies()->RemoveLast();
  EXPECT_THAT(ErrorOf(alone, "chest-wall"), HasSubstr("labels of vertebrae"));
  v1::Scene lung = Person();
  FindBody(lung, "lung-left")->mutable_derived();
  EXPECT_THAT(ErrorOf(lung, "lung-left"), HasSubstr("only an inner cage and a diaphragm"));
  v1::Scene two = Person();
  FindBody(two, "diaphragm-middle")->mutable_derived()->mutable_file()->set_path("again.obj");
  EXPECT_THAT(ErrorOf(two, "chest-wall"), HasSubstr("\"diaphragm\" and \"diaphragm-middle\""));
}

TEST(VoxeliseParts, RefusesWhatEnclosesNothing) {
  EXPECT_FALSE(VoxeliseParts({}).ok());
  PatientBody flat{"plate", {}, {}};
  flat.mesh.vertices = (Points(3, 3) << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished();
  flat.mesh.triangles = (Triangles(3, 1) << 0, 1, 2).finished();
  EXPECT_THAT(std::string(VoxeliseParts({flat}).status().message()), HasSubstr("\"plate\": encloses no voxel"));
}

// A box of these sides [m] far from the origin.
PatientBody BoxOf(const Eigen::Vector3d& sides, const Eigen::Vector3d& at) {
  PatientBody body{"box", {}, {}};
  body.mesh.vertices.resize(3, 4);
  body.mesh.vertices << at, at + Eigen::Vector3d(sides.x(), 0, 0), at + Eigen::Vector3d(0, sides.y(), 0),
      at + Eigen::Vector3d(0, 0, sides.z());
  body.mesh.triangles = (Triangles(3, 4) << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3).finished();
  return body;
}

TEST(VoxeliseParts, HasABoundedGridAlsoForFlatSurfaces) {
  for (const Eigen::Vector3d& sides :
       {Eigen::Vector3d(2.9, 2.9, 0), Eigen::Vector3d(2.9, 2.9, 0.05), Eigen::Vector3d(2.9, 2.9, 2.9)}) {
    const auto parts = VoxeliseParts({BoxOf(sides, Eigen::Vector3d::Zero())});
    if (!parts.ok()) continue;  // a plate may lie between voxels
    EXPECT_LE(parts->volume.labels.size(), 20'000'000U);
  }
  const auto apart = VoxeliseParts({BoxOf({0.1, 0.1, 0.1}, {0, 0, 0}), BoxOf({0.1, 0.1, 0.1}, {1e6, 1e6, 0})});
  EXPECT_THAT(std::string(apart.status().message()), HasSubstr("check their units and offsets"));
}

TEST(VoxeliseParts, EndsBetweenPartsWhenAsked) {
  const std::vector<PatientBody> bodies(3, BoxOf({0.1, 0.1, 0.1}, Eigen::Vector3d::Zero()));
  int asked = 0;
  const auto parts = VoxeliseParts(bodies, [&] { return ++asked < 2 ? absl::OkStatus() : absl::CancelledError(""); });
  EXPECT_TRUE(absl::IsCancelled(parts.status())) << parts.status();
  EXPECT_EQ(asked, 2);
}

TEST(VoxeliseParts, KeepsVolumes) {
  v1::Anatomy rib;
  rib.set_structure(v1::STRUCTURE_RIB);
  rib.set_number(6);
  rib.set_side(v1::SIDE_LEFT);
  const Mesh mesh = *anatomy::Generate(rib, 5);
  const auto parts = VoxeliseParts({{"rib", rib, mesh}});
  ASSERT_TRUE(parts.ok()) << parts.status();
  const double voxel = 1e-9 * parts->volume.Spacing().prod();
  EXPECT_NEAR(voxel * static_cast<double>(parts->parts[0].mask.Count()) / SignedVolume(mesh.vertices, mesh.triangles),
              1, 0.03);
}

}  // namespace
}  // namespace phrenic::imaging
