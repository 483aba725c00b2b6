// How elements name bodies and sets of bodies.
#include "server/mechanics/body_names.h"

#include <gmock/gmock.h>

#include "tests/compile_text.h"

namespace phrenic {
namespace {

using testing::ElementsAre;

std::string SeenBody(const std::string& name, const std::string& more) {
  return "bodies { name: '" + name + "' role: ROLE_SEEN polyhedron { vertices {} } " + more + " } ";
}

const std::string kNamedBodies = "name: 's' layers { name: 'bones' } layers { name: 'empty' } " +
                                 SeenBody("rib-2", "layer: 'bones' anatomy { structure: STRUCTURE_RIB number: 2 }") +
                                 SeenBody("lung", "layer: 'lung' anatomy { structure: STRUCTURE_LUNG }") +
                                 SeenBody("rib-1", "layer: 'bones' anatomy { structure: STRUCTURE_RIB number: 1 }") +
                                 SeenBody("bare", "");

std::vector<int> BodiesOf(const std::string& name, const std::string& text = kNamedBodies) {
  const auto bodies = BodiesNamed(*CompileText(text), name, "bodies[0]");
  EXPECT_TRUE(bodies.ok()) << bodies.status();
  return bodies.ok() ? *bodies : std::vector<int>();
}

std::string RefusalOfName(const std::string& name, const std::string& text = kNamedBodies) {
  const auto bodies = BodiesNamed(*CompileText(text), name, "bodies[0]");
  EXPECT_EQ(bodies.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(bodies.status().message());
}

TEST(BodyNames, AreOfABodyOrALayer) {
  EXPECT_THAT(BodiesOf("rib-1"), ElementsAre(2));
  EXPECT_THAT(BodiesOf("bones"), ElementsAre(0, 2));
  EXPECT_THAT(BodiesOf("lung"), ElementsAre(1));
}

TEST(BodyNames, MaySayWhichKindTheyAreOf) {
  EXPECT_THAT(BodiesOf("body:lung"), ElementsAre(1));
  EXPECT_THAT(BodiesOf("layer:bones"), ElementsAre(0, 2));
  EXPECT_THAT(BodiesOf("structure:rib"), ElementsAre(0, 2));
  EXPECT_THAT(BodiesOf("structure:RIB"), ElementsAre(0, 2));
}

TEST(BodyNames, UnknownOnesAreRefusedWithThoseThereAre) {
  EXPECT_EQ(RefusalOfName("lnug"), "bodies[0]: there is no body or layer \"lnug\"; there are bones, lung, bare");
  EXPECT_EQ(RefusalOfName("layer:bare"),
            "bodies[0]: there is no body or layer \"layer:bare\"; there are bones, lung, bare");
  EXPECT_EQ(RefusalOfName("structure:ribs"),
            "bodies[0]: there is no structure \"ribs\"; there are diaphragm, rib, costal_cartilage, manubrium, "
            "sternum_body, xiphoid, vertebra, lung, inner_cage, disc, heart, aorta, vena_cava, oesophagus, trachea, "
            "liver, stomach, spleen, clavicle, scapula, kidney, lung_lobe, fissure");
}

TEST(BodyNames, EmptySetsAreRefused) {
  EXPECT_EQ(RefusalOfName("empty"), "bodies[0]: no body is in layer \"empty\": put one in it");
  EXPECT_EQ(RefusalOfName("layer:empty"), "bodies[0]: no body is in layer \"empty\": put one in it");
  EXPECT_EQ(RefusalOfName("structure:xiphoid"),
            "bodies[0]: no body is of structure \"xiphoid\": give one that anatomy");
}

TEST(BodyNames, ABodyAndALayerOfOneNameAreNotMixedUp) {
  const std::string both = kNamedBodies + SeenBody("bones", "layer: 'other'");
  EXPECT_EQ(
      RefusalOfName("bones", both),
      "bodies[0]: there are a body \"bones\" and a layer \"bones\" that does not hold it; write \"body:bones\" or "
      "\"layer:bones\"");
  EXPECT_THAT(BodiesOf("body:bones", both), ElementsAre(4));
  EXPECT_THAT(BodiesOf("layer:bones", both), ElementsAre(0, 2));
}

TEST(BodyNames, ElementsTakeSets) {
  const auto model = CompileText(kNamedBodies + "motions { skin { bodies: 'structure:rib' drivers: 'lung' } }");
  EXPECT_GE(model->bodies[0].skin, 0);
  EXPECT_GE(model->bodies[2].skin, 0);
  EXPECT_LT(model->bodies[3].skin, 0);
}

}  // namespace
}  // namespace phrenic
