#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string Refusal(std::string_view name, std::string_view value) {
  v1::Parameters parameters;
  const absl::Status status = SetParameter(name, value, &parameters);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(parameters.ByteSizeLong(), 0U) << "a refused value changed the parameters";
  return std::string(status.message());
}

TEST(SetParameter, SetsNumbers) {
  v1::Parameters parameters;
  ASSERT_EQ(SetParameter("breath_force", "1.5", &parameters), absl::OkStatus());
  EXPECT_EQ(parameters.breath_force(), 1.5);
  ASSERT_EQ(SetParameter("time_step", " 1e-3 ", &parameters), absl::OkStatus());
  EXPECT_EQ(parameters.time_step(), 1e-3);
  EXPECT_EQ(parameters.breath_force(), 1.5);
}

TEST(SetParameter, AcceptsSeveralWordsForSwitches) {
  for (const char* word : {"on", "true", "yes", "1", "ON", "True"}) {
    v1::Parameters parameters;
    ASSERT_EQ(SetParameter("apply_muscles", word, &parameters), absl::OkStatus()) << word;
    EXPECT_TRUE(parameters.apply_muscles()) << word;
  }
  for (const char* word : {"off", "false", "no", "0", "Off"}) {
    v1::Parameters parameters;
    ASSERT_EQ(SetParameter("apply_muscles", word, &parameters), absl::OkStatus()) << word;
    EXPECT_TRUE(parameters.has_apply_muscles()) << word;
    EXPECT_FALSE(parameters.apply_muscles()) << word;
  }
}

TEST(SetParameter, SetsChoicesByNameWithoutPrefix) {
  for (const char* word :
       {"semi_implicit_euler", "semi-implicit-euler", "SEMI_IMPLICIT_EULER", " semi_implicit_euler "}) {
    v1::Parameters parameters;
    ASSERT_EQ(SetParameter("integrator", word, &parameters), absl::OkStatus()) << word;
    EXPECT_EQ(parameters.integrator(), v1::INTEGRATOR_SEMI_IMPLICIT_EULER) << word;
  }
}

TEST(SetParameter, RefusesUnknownChoicesAndListsThem) {
  EXPECT_THAT(Refusal("integrator", "magic"),
              StartsWith("integrator: there is no \"magic\"; did you mean static? There are semi_implicit_euler"));
  for (const char* word : {"unspecified", "INTEGRATOR_SEMI_IMPLICIT_EULER", "1", ""}) {
    EXPECT_THAT(Refusal("integrator", word), HasSubstr("there are semi_implicit_euler")) << word;
  }
}

TEST(SetParameter, NamesTheRange) {
  EXPECT_EQ(Refusal("breath_force", "21"), "breath_force: 21 is outside 0 to 20");
  EXPECT_EQ(Refusal("time_step", "0"), "time_step: 0 is outside 1e-07 to 0.1 s");
}

TEST(SetParameter, RefusesTextThatIsNotANumber) {
  EXPECT_EQ(Refusal("breath_length", "long"), "breath_length: \"long\" is not a number; allowed is 0.5 to 30 s");
  EXPECT_THAT(Refusal("breath_length", ""), HasSubstr("is not a number"));
  EXPECT_THAT(Refusal("breath_length", "4 s"), HasSubstr("is not a number"));
  EXPECT_THAT(Refusal("breath_length", "nan"), HasSubstr("is not a finite number"));
  EXPECT_THAT(Refusal("breath_length", "inf"), HasSubstr("is not a finite number"));
  EXPECT_EQ(Refusal("apply_links", "maybe"), "apply_links: \"maybe\" is neither on nor off");
}

TEST(SetParameter, SuggestsTheNearestName) {
  const std::string refusal = Refusal("breth_force", "1");
  EXPECT_THAT(refusal, StartsWith("there is no parameter \"breth_force\"; did you mean breath_force?"));
  for (const char* name : {"time_step", "breath_length", "rib_motion", "elasticity", "apply_muscles", "apply_links"}) {
    EXPECT_THAT(refusal, HasSubstr(name));
  }
}

TEST(SetParameter, SuggestsNothingIfNoNameIsNear) {
  EXPECT_THAT(Refusal("q", "1"), StartsWith("there is no parameter \"q\"; there are breath_length, "));
  EXPECT_LT(Refusal(std::string(100000, 'x'), "1").size(), 1200U);  // the list of all names
}

}  // namespace
}  // namespace phrenic::schema
