// Laws of bodies by sex, age and shape, for the ten of the README's contact sheet.
#include "tests/anatomy/ten_bodies.h"

#include <gtest/gtest.h>

#include <functional>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/physique.h"
#include "server/anatomy/physique_inverse.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"
#include "server/schema/physique.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

constexpr double kCoarse = 9;  // [mm]

v1::Physique PhysiqueOf(const std::string& text) {
  v1::Physique physique;
  EXPECT_TRUE(schema::ParseText("physique", text, &physique).ok()) << text;
  return physique;
}

Mesh Carried(const Mesh& adult, const PhysiqueMap& map) {
  Mesh person = adult;
  for (auto vertex : person.vertices.colwise()) vertex = kMillimetre * map(vertex / kMillimetre);
  return person;
}

// Groups of parts none of which crosses another in the adult. In the adult the lungs cross the heart, the great vessels
// and ribs 8 and 9, rib heads their vertebrae, and the aorta the heart.
std::vector<std::vector<v1::Anatomy>> ApartGroups() {
  const v1::Anatomy sheet = Part(v1::STRUCTURE_DIAPHRAGM);
  std::vector<v1::Anatomy> around = {sheet, Part(v1::STRUCTURE_HEART)}, below = {sheet}, behind = {sheet};
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    for (int number = 1; number <= 12; ++number) around.push_back(Part(v1::STRUCTURE_RIB, number, side));
    below.push_back(Part(v1::STRUCTURE_LUNG, 0, side));
  }
  for (const auto& more : {AbdominalOrgans(), Kidneys()}) below.insert(below.end(), more.begin(), more.end());
  for (const v1::Anatomy& bone : ShoulderGirdle()) around.push_back(bone);
  for (int number = 1; number <= kVertebrae; ++number) behind.push_back(Part(v1::STRUCTURE_VERTEBRA, number));
  behind.push_back(Part(v1::STRUCTURE_AORTA));
  return {around, below, behind};
}

Mesh Together(const std::vector<v1::Anatomy>& parts) {
  Mesh all;
  for (const v1::Anatomy& part : parts) {
    const Mesh& mesh = MeshOf(part, kCoarse);
    const Eigen::Index vertices = all.vertices.cols(), triangles = all.triangles.cols();
    all.vertices.conservativeResize(3, vertices + mesh.vertices.cols());
    all.triangles.conservativeResize(3, triangles + mesh.triangles.cols());
    all.vertices.rightCols(mesh.vertices.cols()) = mesh.vertices;
    all.triangles.rightCols(mesh.triangles.cols()) = mesh.triangles.array() + static_cast<int>(vertices);
  }
  return all;
}

TEST(TenBodies, AreWatertightAndCrossNothingAtRest) {
  const auto groups = ApartGroups();
  std::vector<Mesh> apart;
  apart.reserve(groups.size());
  for (const auto& group : groups) apart.push_back(Together(group));
  for (const NamedBody& body : TenBodies()) {
    SCOPED_TRACE(body.title);
    const PhysiqueMap map(body.physique);
    for (const v1::Anatomy& part : AllParts()) {
      const Mesh person = Carried(MeshOf(part, kCoarse), map);
      EXPECT_TRUE(AnalyseTopology(person).watertight()) << part.ShortDebugString();
      EXPECT_GT(SignedVolume(person.vertices, person.triangles), 0) << part.ShortDebugString();
      EXPECT_EQ(SelfCrossings(person, kCoarse * kMillimetre), 0) << part.ShortDebugString();
    }
    for (const Mesh& group : apart) {
      EXPECT_EQ(SelfCrossings(Carried(group, map), kCoarse * kMillimetre), 0) << "of one part with another";
    }
  }
}

TEST(TenBodies, TheAdultWrittenOutIsTodaysBitForBit) {
  const v1::Physique man = PhysiqueOf("sex: SEX_MALE age: 30 barrel_chest: 0 height: 1.75 right_dome_height: 0");
  EXPECT_TRUE(PhysiqueMap(man).IsIdentity());
  v1::Generated shape;
  *shape.mutable_physique() = man;
  shape.set_resolution_mm(kCoarse);
  for (const v1::Anatomy& part : {Part(v1::STRUCTURE_DIAPHRAGM), Part(v1::STRUCTURE_INNER_CAGE),
                                  Part(v1::STRUCTURE_RIB, 7, v1::SIDE_LEFT), Part(v1::STRUCTURE_HEART)}) {
    const auto mesh = Generate(part, shape);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->vertices, MeshOf(part, kCoarse).vertices) << part.ShortDebugString();
  }
}

// A number of a body, and a length [mm] that it alone enlarges.
struct Effect {
  std::string number;
  std::function<double(const PhysiqueMap&)> length;
};

std::vector<Effect> Effects() {
  const auto depth = [](const PhysiqueMap& map) { return map({40, 95, 235}).y() - map({0, -98, 180}).y(); };
  const auto front = [](const PhysiqueMap& map) { return map({0, -98, 180}).z(); };
  const double apex = BodyOfVertebra(8).Middle();
  return {{"height",
           [](const PhysiqueMap& map) {
             return map({0, SpineFront(390), 390}).z();
           }},
          {"chest_width",
           [](const PhysiqueMap& map) {
             return map({131, 0, 185}).x();
           }},
          {"chest_depth", depth},
          {"rib_slope_degrees", [=](const PhysiqueMap& map) { return -front(map); }},
          {"right_dome_height",
           [](const PhysiqueMap& map) {
             return map({-60, 0, 205}).z();
           }},
          {"left_dome_height",
           [](const PhysiqueMap& map) {
             return map({60, 0, 205}).z();
           }},
          {"scoliosis_degrees",
           [=](const PhysiqueMap& map) {
             return -map({0, SpineFront(apex), apex}).x();
           }},
          {"kyphosis_degrees",
           [=](const PhysiqueMap& map) {
             return map({0, SpineFront(apex), apex}).y();
           }},
          {"age",
           [=](const PhysiqueMap& map) {
             return map({0, SpineFront(apex), apex}).y();
           }},
          {"age", depth},
          {"age", front},
          {"barrel_chest", depth},
          {"barrel_chest", front},
          {"barrel_chest", [](const PhysiqueMap& map) {
             return -map({-60, 0, 205}).z();
           }}};
}

TEST(TenBodies, EveryNumberEnlargesItsLengthThroughoutItsRange) {
  for (const Effect& effect : Effects()) {
    const auto* field = v1::Physique::descriptor()->FindFieldByName(effect.number);
    const v1::Quantity& quantity = field->options().GetExtension(v1::quantity);
    double before = -1e9;
    for (int step = 0; step <= 8; ++step) {
      v1::Physique physique;
      physique.GetReflection()->SetDouble(&physique, field,
                                          quantity.minimum() + step * (quantity.maximum() - quantity.minimum()) / 8);
      const double length = effect.length(PhysiqueMap(physique));
      EXPECT_GT(length, before + 0.05) << physique.ShortDebugString();
      before = length;
    }
  }
}

TEST(TenBodies, AWomansChestOfAMansHeightHasNineTenthsOfItsSectionAndSteeperRibs) {
  const PhysiqueMap woman(PhysiqueOf("sex: SEX_FEMALE height: 1.75"));
  const double width = woman({131, 0, 185}).x() / 131,
               depth = (woman({0, 100, 185}).y() - woman({0, -90, 185}).y()) / 190;
  EXPECT_NEAR(width * depth, 0.9, 0.005);
  EXPECT_NEAR(width, depth, 1e-12) << "the thoracic index is a man's";
  EXPECT_LT(woman({0, -98, 180}).z(), 180 - 5);
  EXPECT_NEAR(PhysiqueMap(PhysiqueOf("sex: SEX_FEMALE"))({0, 100, 390}).z() / woman({0, 100, 390}).z(), 1.62 / 1.75,
              1e-9);
}

TEST(TenBodies, ABarrelChestIsNearlyAsDeepAsWide) {
  const PhysiqueMap map(PhysiqueOf("barrel_chest: 1"));
  const double depth = map({40, 105, 185}).y() - map({0, -98, 185}).y(), width = 2 * map({131, 0, 185}).x();
  EXPECT_GT(depth / width, 0.9);
  EXPECT_LT(depth / width, 1);
}

TEST(TenBodies, ANumberThatIsSetCountsAndOthersStayInTheirRanges) {
  const v1::Physique given =
      schema::CompletePhysique(PhysiqueOf("sex: SEX_FEMALE age: 90 barrel_chest: 1 height: 1.9 kyphosis_degrees: 0"));
  EXPECT_EQ(given.height(), 1.9);
  EXPECT_EQ(given.kyphosis_degrees(), 0);
  EXPECT_TRUE(schema::Validate(given).ok());
  EXPECT_TRUE(schema::Validate(schema::CompletePhysique(PhysiqueOf("age: 90 barrel_chest: 1"))).ok());
  EXPECT_EQ(schema::CompletePhysique(given).SerializeAsString(), given.SerializeAsString());
}

TEST(TenBodies, AreMirrorImagesWithTheSidesExchanged) {
  const auto mirrored = [](Eigen::Vector3d x) { return x.x() = -x.x(), x; };
  for (const NamedBody& body : TenBodies()) {
    v1::Physique other = schema::CompletePhysique(body.physique);
    other.set_scoliosis_degrees(-other.scoliosis_degrees());
    const double right = other.right_dome_height();
    other.set_right_dome_height(other.left_dome_height());
    other.set_left_dome_height(right);
    const PhysiqueMap map(body.physique), mirror(other);
    for (double z = 10; z < 390; z += 38) {
      const Eigen::Vector3d at(0.3 * z - 55, 90 - 0.4 * z, z);
      EXPECT_LT((map(at) - mirrored(mirror(mirrored(at)))).norm(), 1e-9) << body.title << ", z = " << z;
    }
  }
}

TEST(TenBodies, TheInverseFindsTheAdultsPoint) {
  for (const NamedBody& body : TenBodies()) {
    const PhysiqueMap map(body.physique);
    PhysiqueInverse inverse(map);
    for (double z = 10; z < 390; z += 38) {
      for (const double x : {-110.0, -30.0, 30.0, 110.0}) {
        const Eigen::Vector3d at(x, 60 - 0.4 * z, z);
        EXPECT_LT((inverse(map(at)) - at).norm(), 0.1) << body.title << ": " << at.transpose();
      }
    }
  }
}

}  // namespace
}  // namespace phrenic::anatomy
