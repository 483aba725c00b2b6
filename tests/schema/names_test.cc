#include "server/schema/names.h"

#include <gtest/gtest.h>

namespace phrenic::schema {
namespace {

const std::vector<std::string> kNames = {"cube-springs", "sheet-2d", "thorax", "thorax-patient"};

TEST(NearestName, IsWithinHalfOfTheLetters) {
  EXPECT_EQ(NearestName("thorx", kNames), "thorax");
  EXPECT_EQ(NearestName("Thorax", kNames), "thorax");
  EXPECT_EQ(NearestName("shet-2d", kNames), "sheet-2d");
  EXPECT_EQ(NearestName("lung", kNames), "");
}

TEST(NearestName, CountsExchangedNeighboursOnceAndNoCase) {
  EXPECT_EQ(NearestName("rnu", {"run", "set"}), "run");
  EXPECT_EQ(NearestName("RUN", {"run", "set"}), "run");
  EXPECT_EQ(NearestName("nru", {"run", "set"}), "") << "two changes of three letters";
  EXPECT_EQ(NearestName("THORAX-P", kNames), "thorax-patient");
}

TEST(NearestName, IsTheOnlyOneWithThatPrefix) {
  EXPECT_EQ(NearestName("cu", kNames), "cube-springs");
  EXPECT_EQ(NearestName("thorax-", kNames), "thorax-patient");
  EXPECT_EQ(NearestName("c", kNames), "") << "a letter says too little";
}

TEST(NearestName, IsEmptyIfThereIsNone) {
  EXPECT_EQ(NearestName("", kNames), "");
  EXPECT_EQ(NearestName("thorax", {}), "");
  EXPECT_EQ(NearestName(std::string(1000, 'x'), kNames), "");
}

TEST(ThereAre, NamesTheNearestFirst) {
  EXPECT_EQ(ThereAre("thorx", kNames),
            "; did you mean thorax? There are cube-springs, sheet-2d, thorax, thorax-patient");
  EXPECT_EQ(ThereAre("lung", {"cube"}), "; there are cube");
  EXPECT_EQ(ThereAre("lung", {}), "; there are none");
}

}  // namespace
}  // namespace phrenic::schema
