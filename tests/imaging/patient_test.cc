// A phantom's label volume is converted to a thorax; surfaces, rib axes and diaphragm are compared with the ground
// truth.
#include "server/imaging/patient/patient.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "server/anatomy/rib.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/phantom.h"
#include "server/imaging/rib_axis.h"
#include "server/mesh/normals.h"
#include "server/mesh/topology.h"
#include "server/mesh/triangle_tree.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

using ::testing::HasSubstr;

constexpr double kVoxel = 3;  // [mm]

v1::LabelMap Map() { return *ReadLabelMap("totalsegmentator"); }

v1::Scene Pattern() {
  std::ifstream file(PHRENIC_SCENES_DIR "/thorax.textproto");
  std::stringstream text;
  text << file.rdbuf();
  return *schema::ParseScene("thorax.textproto", text.str());
}

bool NeverCancel(double, std::string_view) { return true; }

PatientOptions Coarse() {
  PatientOptions options;
  options.edge_length = 6;
  options.diaphragm.vertices = 2500;
  return options;
}

// Returns the distances of a's vertices from b's surface [mm], ascending.
std::vector<double> Distances(const Mesh& a, const Mesh& b) {
  const TriangleTree tree(b.vertices, b.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(b.vertices, boxes);
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < a.vertices.cols(); ++i) {
    distances.push_back(1e3 * std::sqrt(tree.Nearest(b.vertices, boxes, a.vertices.col(i), 1).squared));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double P95(const std::vector<double>& sorted) { return sorted[sorted.size() * 95 / 100]; }

// Converts one phantom for all tests.
class Adult : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    body_ = *FindPhantomBody("adult");
    const auto volume = MakePhantom(body_, {kVoxel, 0.02, 40, 1}, Map());
    ASSERT_TRUE(volume.ok()) << volume.status();
    auto patient = MakePatient(*volume, Map(), Pattern(), Coarse(), NeverCancel);
    ASSERT_TRUE(patient.ok()) << patient.status();
    patient_ = *std::move(patient);
  }

  static const PatientBody* Find(const std::string& name) {
    for (const PatientBody& body : patient_.bodies) {
      if (body.name == name) return &body;
    }
    return nullptr;
  }
  // Returns the generated part in the patient's frame, shifted like the patient.
  static Mesh Truth(v1::Structure structure, int number, v1::Side side, double resolution_mm) {
    v1::Anatomy part;
    part.set_structure(structure);
    part.set_number(number);
    part.set_side(side);
    Mesh mesh = *PhantomPart(body_, part, resolution_mm);
    mesh.vertices.row(0).array() += 1e-3 * patient_.report.moved_left_mm();
    return mesh;
  }

  static PhantomBody body_;
  static Patient patient_;
};

PhantomBody Adult::body_;
Patient Adult::patient_;

TEST_F(Adult, SurfacesAreClosedOutwardAndWithinAVoxelOfTheTruth) {
  ASSERT_GE(patient_.bodies.size(), 45U);
  for (const PatientBody& body : patient_.bodies) {
    if (body.name == "diaphragm-middle" || body.name == "chest-wall") continue;
    EXPECT_TRUE(AnalyseTopology(body.mesh).watertight()) << body.name;
    EXPECT_GT(SignedVolume(body.mesh.vertices, body.mesh.triangles), 0) << body.name;
  }
  const auto far = [](const char* name, const Mesh& truth) {
    return Mean(Distances(Find(name)->mesh, truth)) + Mean(Distances(truth, Find(name)->mesh));
  };
  EXPECT_LT(far("rib-5-left", Truth(v1::STRUCTURE_RIB, 5, v1::SIDE_LEFT, 5)), 2 * 0.4 * kVoxel);
  EXPECT_LT(far("lung-upper-lobe-right", Truth(v1::STRUCTURE_LUNG, 0, v1::SIDE_RIGHT, 8)), 2 * 0.3 * kVoxel);
  EXPECT_LT(far("l1", Truth(v1::STRUCTURE_VERTEBRA, 13, v1::SIDE_UNSPECIFIED, 6)), 2 * 0.4 * kVoxel);
}

TEST_F(Adult, SmoothingKeepsTheVolumeOfTheLabel) {
  for (const v1::PatientSurface& surface : patient_.report.surfaces()) {
    if (surface.label_volume_ml() < 20 || surface.body().starts_with("cartilage")) continue;
    EXPECT_NEAR(surface.volume_ml() / surface.label_volume_ml(), 1, 0.15) << surface.body();
  }
}

TEST_F(Adult, RibAxesFollowTheRibsNecks) {
  double off = 0;
  int ribs = 0;
  for (const PatientBody& body : patient_.bodies) {
    if (body.anatomy.structure() != v1::STRUCTURE_RIB) continue;
    const anatomy::Curve path = anatomy::LeftRibPath(body.anatomy.number());
    Eigen::Vector3d truth = (path[2] - path[0]).normalized();
    if (body.anatomy.side() == v1::SIDE_RIGHT) truth.x() = -truth.x();
    const double angle = std::acos(FindRibNeck(body.mesh, 1).Axis().dot(truth)) * 180 / std::numbers::pi;
    EXPECT_LT(angle, 25) << body.name;
    off += angle, ++ribs;
  }
  EXPECT_EQ(ribs, 24);
  EXPECT_LT(off / ribs, 12) << "of a neck of 22 mm in voxels of 3 mm";
}

TEST_F(Adult, TheDerivedDiaphragmIsCloseToTheGeneratedOne) {
  const Mesh& derived = patient_.bodies.front().mesh;
  const Mesh truth = Truth(v1::STRUCTURE_DIAPHRAGM, 0, v1::SIDE_UNSPECIFIED, 6);
  const std::vector<double> there = Distances(derived, truth), back = Distances(truth, derived);
  const double assd = (Mean(there) + Mean(back)) / 2, hd95 = std::max(P95(there), P95(back));
  std::printf("derived diaphragm: assd %.2f mm, hd95 %.2f mm; extrapolated %.0f %%\n", assd, hd95,
              100 * patient_.report.diaphragm().extrapolated());
  EXPECT_LT(assd, 4);
  EXPECT_LT(hd95, 16);
  EXPECT_EQ(AnalyseTopology(derived).genus(), 0);
  for (const char* region : {"tendon", "rim", "crus-right", "crus-left"}) {
    EXPECT_TRUE(derived.regions.contains(region)) << region;
  }
  const v1::DerivedDiaphragm& report = patient_.report.diaphragm();
  EXPECT_NEAR(report.between_organs() + report.beside_one_organ() + report.on_bone() + report.extrapolated(), 1, 1e-9);
  EXPECT_GT(report.between_organs(), 0.15);
  EXPECT_GT(report.extrapolated(), 0.01) << "the mediastinum gives no evidence";
}

// Returns how far the points are outside of the wall, negative inside [mm].
std::vector<double> OutsideOf(const Mesh& wall, const Points& points) {
  const TriangleTree tree(wall.vertices, wall.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(wall.vertices, boxes);
  std::vector<double> outside;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const SurfacePoint nearest = tree.Nearest(wall.vertices, boxes, points.col(i), 1);
    if (!nearest.on_boundary) outside.push_back(std::copysign(1e3 * std::sqrt(nearest.squared), -nearest.facing));
  }
  return outside;
}

TEST_F(Adult, TheWallIsInsideTheBones) {
  for (const PatientBody& body : patient_.bodies) {
    if (body.anatomy.structure() != v1::STRUCTURE_RIB && body.anatomy.structure() != v1::STRUCTURE_VERTEBRA) continue;
    const std::vector<double> outside = OutsideOf(Find("chest-wall")->mesh, body.mesh.vertices);
    if (outside.empty()) continue;
    const double least = body.anatomy.structure() == v1::STRUCTURE_RIB ? -kVoxel / 2 : -kVoxel;
    EXPECT_GT(*std::min_element(outside.begin(), outside.end()), least) << body.name;
  }
}

TEST_F(Adult, TheWallIsCloseToTheGeneratedOneInTheZoneOfApposition) {
  const Mesh truth = Truth(v1::STRUCTURE_INNER_CAGE, 0, v1::SIDE_UNSPECIFIED, 6);
  const Mesh& middle = Find("diaphragm-middle")->mesh;
  const std::vector<double> outside = OutsideOf(truth, middle.vertices(Eigen::all, middle.regions.at("insertion")));
  double off = 0;
  for (const double distance : outside) off += std::abs(distance) / static_cast<double>(outside.size());
  std::printf("insertion: %.2f mm from the generated wall\n", off);
  EXPECT_LT(off, 4);
}

TEST_F(Adult, TheMiddleLayerIsADiscInsideTheWallWithItsBorderOnIt) {
  const Mesh& middle = Find("diaphragm-middle")->mesh;
  const SurfaceTopology topology = AnalyseTopology(middle);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.euler_characteristic(), 1);
  const Mesh& wall = Find("chest-wall")->mesh;
  const std::vector<double> all = OutsideOf(wall, middle.vertices);
  EXPECT_LT(*std::max_element(all.begin(), all.end()), 0.5) << "chords of the wall before the spine";
  const std::vector<double> rim = OutsideOf(wall, middle.vertices(Eigen::all, middle.regions.at("rim")));
  EXPECT_GT(*std::min_element(rim.begin(), rim.end()), -5) << "what is inserted is near the wall";
  for (const char* region : {"tendon", "muscle", "rim", "insertion", "crus-right", "crus-left"}) {
    EXPECT_TRUE(middle.regions.contains(region)) << region;
  }
}

TEST_F(Adult, TheMiddleLayerFacesTheThorax) {
  const Mesh& middle = Find("diaphragm-middle")->mesh;
  double up = 0;
  for (const int i : middle.regions.at("tendon")) up += VertexNormals(middle.vertices, middle.triangles)(2, i);
  EXPECT_GT(up, 0);
}

TEST_F(Adult, TheSceneHasTheBodiesAndPatientSpecificRibAxes) {
  EXPECT_EQ(patient_.scene.bodies(0).file().path(), "patient/diaphragm.msh");
  int turned = 0;
  for (const v1::Motion& motion : patient_.scene.motions()) {
    if (!motion.has_ribs()) continue;
    EXPECT_TRUE(motion.ribs().has_free());
    const v1::RibEndState& end = motion.ribs().end_states(0);
    if (end.number() != 5) continue;
    EXPECT_NEAR(std::hypot(end.pump_degrees(), end.bucket_degrees()), std::hypot(9, 11.5), 1e-9)
        << "the pattern's angle";
    ++turned;
  }
  EXPECT_EQ(turned, 2);
  EXPECT_TRUE(schema::Validate(patient_.scene).ok()) << schema::Validate(patient_.scene);
}

TEST_F(Adult, TheScenesMuscleIsTheMiddleLayerAndNoBodyIsGenerated) {
  for (const v1::Body& body : patient_.scene.bodies()) {
    EXPECT_TRUE(body.has_file()) << body.name();
    EXPECT_EQ(body.role() == v1::ROLE_DEFORMABLE, body.name() == "diaphragm-middle") << body.name();
  }
  for (const v1::Force& force : patient_.scene.forces()) EXPECT_FALSE(force.has_action_line() || force.has_springs());
}

// The adult phantom is the generated thorax, so that what is scaled by the volume keeps its value.
TEST_F(Adult, TheLungsHaveTheGeneratedOnesRoom) {
  for (const v1::Force& force : patient_.scene.forces()) {
    if (!force.has_thorax_pressures()) continue;
    EXPECT_NEAR(force.thorax_pressures().lungs().room(), 3.6e-3, 0.5e-3);
  }
}

TEST(Patient, VolumesWithoutAThoraxAreRejected) {
  LabelVolume volume;
  volume.size = {8, 8, 8};
  volume.labels.assign(512, 7);
  const auto none = MakePatient(volume, Map(), Pattern(), Coarse(), NeverCancel);
  EXPECT_THAT(std::string(none.status().message()), HasSubstr("is it the right map?"));
  volume.labels.assign(512, 5);
  const auto liver = MakePatient(volume, Map(), Pattern(), Coarse(), NeverCancel);
  EXPECT_THAT(std::string(liver.status().message()), HasSubstr("no lungs, no ribs or no vertebrae"));
}

}  // namespace
}  // namespace phrenic::imaging
