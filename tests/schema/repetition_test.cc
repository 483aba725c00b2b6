// Elements that stand for several (`for_each`): the same as if they were written out.
#include "server/schema/repetition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kBall = "role: ROLE_SEEN ellipsoid { radii { x: 1 y: 1 z: 1 } } ";

absl::StatusOr<v1::Scene> ParseElements(const std::string& elements) {
  return ParseScene("s", "name: 's'\n" + elements);
}

// Of a scene of one body that repeats.
absl::StatusOr<v1::Scene> ParseBody(const std::string& body) {
  return ParseElements("bodies { " + kBall + body + " }");
}

std::vector<std::string> NamesOf(const absl::StatusOr<v1::Scene>& scene) {
  std::vector<std::string> names;
  EXPECT_TRUE(scene.ok()) << scene.status();
  if (scene.ok()) {
    for (const v1::Body& body : scene->bodies()) names.push_back(body.name());
  }
  return names;
}

std::string RefusalOf(const absl::StatusOr<v1::Scene>& scene) {
  EXPECT_EQ(scene.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(scene.status().message());
}

TEST(Repetition, MakesWhatAPersonWouldWrite) {
  const auto repeated = ParseBody(
      "name: 'rib-{number}-{side}' anatomy { structure: STRUCTURE_RIB } "
      "for_each { numbers { first: 1 last: 2 } sides: [SIDE_RIGHT, SIDE_LEFT] }");
  std::string written;
  for (const std::string side : {"right", "left"}) {
    for (const int number : {1, 2}) {
      absl::StrAppend(&written, "bodies { ", kBall, "name: 'rib-", number, "-", side,
                      "' anatomy { structure: STRUCTURE_RIB number: ", number,
                      " side: ", side == "right" ? "SIDE_RIGHT" : "SIDE_LEFT", " } } ");
    }
  }
  ASSERT_TRUE(repeated.ok()) << repeated.status();
  EXPECT_EQ(repeated->SerializeAsString(), ParseElements(written)->SerializeAsString());
}

TEST(Repetition, KeepsTheOrderOfBodies) {
  const auto scene = ParseElements("bodies { name: 'a' " + kBall +
                                   "} bodies { name: 'b{number}' for_each { numbers { first: 0 last: 2 } } " + kBall +
                                   "} bodies { name: 'c' " + kBall + "}");
  EXPECT_THAT(NamesOf(scene), ElementsAre("a", "b0", "b1", "b2", "c"));
}

TEST(Repetition, NamesVertebrae) {
  EXPECT_THAT(NamesOf(ParseBody("name: '{vertebra}' for_each { numbers { first: 11 last: 14 } }")),
              ElementsAre("t11", "t12", "l1", "l2"));
}

TEST(Repetition, TakesValuesInTheOrderOfTheRepetitions) {
  EXPECT_THAT(NamesOf(ParseBody("name: '{value}' for_each { values: ['x', 'y'] }")), ElementsAre("x", "y"));
  EXPECT_THAT(
      NamesOf(ParseBody("name: '{side}-{value}' for_each { sides: [SIDE_LEFT, SIDE_RIGHT] values: ['x', 'y'] }")),
      ElementsAre("left-x", "right-y"));
}

TEST(Repetition, FillsEveryTextOfAnElement) {
  const auto scene = ParseElements(
      "bodies { name: 'b' role: ROLE_SEEN grid { columns: 2 rows: 2 u { x: 1 } v { y: 1 } } } "
      "motions { name: 'm{number}' for_each { numbers { first: 8 last: 9 } sides: SIDE_LEFT } "
      "skin { bodies: 'c-{number}-{side}' drivers: ['r-{number}', 'c-{number-1}'] } } "
      "forces { name: '{side}' for_each { sides: [SIDE_RIGHT, SIDE_LEFT] } friction { bodies: '{side} lung' } }");
  ASSERT_TRUE(scene.ok()) << scene.status();
  ASSERT_EQ(scene->motions_size(), 2);
  EXPECT_EQ(scene->motions(1).name(), "m9");
  EXPECT_EQ(scene->motions(1).skin().bodies(0), "c-9-left");
  EXPECT_THAT(scene->motions(1).skin().drivers(), ElementsAre("r-9", "c-8"));
  ASSERT_EQ(scene->forces_size(), 2);
  EXPECT_EQ(scene->forces(0).friction().bodies(0), "right lung");
}

TEST(Repetition, BracesMeanNothingElsewhere) {
  EXPECT_THAT(NamesOf(ParseBody("name: '{number'")), ElementsAre("{number"));
}

TEST(Repetition, RefusesEmptySets) {
  EXPECT_EQ(RefusalOf(ParseBody("name: 'b'\n for_each {}")),
            "s:3:2: bodies[0].for_each: is empty: set numbers, sides or values");
  EXPECT_EQ(RefusalOf(ParseBody("name: 'b{number}' for_each {\n numbers { first: 3 last: 2 } }")),
            "s:3:2: bodies[0].for_each.numbers: first, 3, is above last, 2");
  EXPECT_THAT(RefusalOf(ParseBody("name: 'b{side}' for_each { sides: SIDE_UNSPECIFIED }")),
              HasSubstr("bodies[0].for_each.sides[0]: must be SIDE_RIGHT or SIDE_LEFT"));
  EXPECT_THAT(RefusalOf(ParseBody("name: 'b{number}' for_each { numbers { first: -1 last: 2 } }")),
              HasSubstr("bodies[0].for_each.numbers.first: -1 is outside 0 to 999"));
}

TEST(Repetition, RefusesLargeSets) {
  EXPECT_THAT(RefusalOf(ParseBody("name: 'b{number}' for_each { numbers { first: 0 last: 200 } }")),
              HasSubstr("bodies[0].for_each: makes 201 of one element; at most 200 are allowed"));
  const std::string long_text(2000, 'x');
  EXPECT_THAT(RefusalOf(ParseBody("name: '{value}{value}' for_each { values: '" + long_text + "' }")),
              HasSubstr("bodies[0].name: is longer than 1024 bytes when filled in"));
  std::string vertices;
  for (int i = 0; i < 20000; ++i) vertices += "vertices { x: 1 y: 1 z: 1 } ";
  EXPECT_THAT(RefusalOf(ParseElements(
                  "bodies { name: 'b{number}' role: ROLE_SEEN for_each { numbers { last: 99 } } polyhedron { " +
                  vertices + "} }")),
              HasSubstr("bodies[0]: for_each makes more than 16 MiB: repeat a smaller element"));
}

TEST(Repetition, RefusesTwoBodiesOfOneName) {
  EXPECT_EQ(
      RefusalOf(ParseBody("\nname: 'b' layer: '{value}' for_each { values: ['x', 'y'] }")),
      "s:2:1: bodies[0].name: its for_each makes two bodies named \"b\": write {number}, {side} or {value} in the "
      "name");
  EXPECT_THAT(RefusalOf(ParseElements("bodies { name: 'b2' " + kBall + "}\nbodies { name: 'b{number}' " + kBall +
                                      "for_each { numbers { first: 1 last: 2 } } }")),
              testing::AllOf(testing::StartsWith("s:3:10: bodies[1].name: there are two bodies named \"b2\""),
                             HasSubstr("the other is of bodies[0]: give one of them another name")));
}

TEST(Repetition, RefusesUnknownAndMisplacedWords) {
  EXPECT_THAT(
      RefusalOf(ParseBody("name: 'b{nummer}' for_each { numbers { last: 2 } }")),
      HasSubstr("bodies[0].name: there is no {nummer}: write {number}, {number-1}, {side}, {vertebra} or {value}"));
  EXPECT_THAT(RefusalOf(ParseBody("name: 'b{side}' for_each { numbers { last: 2 } }")),
              HasSubstr("bodies[0].name: says {side}, and its for_each has no sides"));
  EXPECT_THAT(RefusalOf(ParseBody("name: 'b{value}' for_each { numbers { last: 2 } }")), HasSubstr("has no values"));
  EXPECT_THAT(RefusalOf(ParseBody("name: 'b{number}' for_each { sides: SIDE_LEFT }")), HasSubstr("has no numbers"));
  EXPECT_THAT(RefusalOf(ParseBody("name: 'b{number' for_each { numbers { last: 2 } }")), HasSubstr("has no \"}\""));
  EXPECT_THAT(RefusalOf(ParseBody("name: '{vertebra}' for_each { numbers { first: 17 last: 18 } }")),
              HasSubstr("there is no vertebra 18: thoracic ones are 1 to 12, lumbar ones 13 to 17"));
}

TEST(Repetition, RefusesRepetitionsThatAreAllTheSame) {
  const std::string motion =
      "bodies { name: 'b' " + kBall + "}\nmotions { skin { bodies: 'b' drivers: 'c' } for_each { ";
  EXPECT_THAT(RefusalOf(ParseElements(motion + "numbers { first: 1 last: 2 } } }")),
              HasSubstr("motions[0].for_each: has numbers, and no text of the element says {number}"));
  EXPECT_THAT(RefusalOf(ParseElements(motion + "sides: [SIDE_LEFT, SIDE_RIGHT] } }")), HasSubstr("says {side}"));
  EXPECT_THAT(RefusalOf(ParseElements(motion + "values: ['x', 'y'] } }")), HasSubstr("says {value}"));
}

TEST(Repetition, RefusesValuesThatDoNotPair) {
  EXPECT_EQ(RefusalOf(ParseBody("name: '{value}' for_each { numbers { first: 1 last: 3 }\n values: ['x', 'y'] }")),
            "s:3:2: bodies[0].for_each.values: are 2 for 3 repetitions: give one for each");
}

TEST(Repetition, AnatomyComesFromTheSetAlone) {
  const std::string rib =
      "name: '{number}{side}' for_each { numbers { first: 1 last: 2 } sides: SIDE_LEFT } anatomy { ";
  EXPECT_THAT(RefusalOf(ParseBody(rib + "structure: STRUCTURE_RIB number: 1 }")),
              HasSubstr("bodies[0].anatomy.number: comes from for_each: leave it out"));
  EXPECT_THAT(RefusalOf(ParseBody(rib + "structure: STRUCTURE_RIB side: SIDE_LEFT }")),
              HasSubstr("bodies[0].anatomy.side: comes from for_each: leave it out"));
  EXPECT_THAT(RefusalOf(ParseBody("name: '{number}' for_each { numbers { first: 17 last: 18 } } anatomy { structure: "
                                  "STRUCTURE_RIB }")),
              HasSubstr("bodies[0].anatomy.number: 18 is outside 0 to 17"));
}

TEST(Repetition, ScenesThatAreSentAreResolvedToo) {
  v1::Scene scene = *ParseBody("name: 'b'");
  scene.mutable_bodies(0)->set_name("b{number}");
  scene.mutable_bodies(0)->mutable_for_each()->mutable_numbers()->set_last(3);
  ASSERT_TRUE(Resolve(&scene).ok());
  EXPECT_EQ(scene.bodies_size(), 4);
  scene.mutable_bodies(3)->mutable_for_each();
  EXPECT_EQ(std::string(Resolve(&scene).message()), "bodies[3].for_each: is empty: set numbers, sides or values");
}

}  // namespace
}  // namespace phrenic::schema
