// Studies of many people that are interrupted and go on.
#include "server/fit/kept_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "server/fit/motion_study.h"
#include "tests/fit/synthetic_person.h"

namespace phrenic::fit {
namespace {

std::vector<StudyCase> ThreePeople() {
  return {{"a", SyntheticPerson(200)}, {"b", SyntheticPerson(210, 0.014)}, {"c", SyntheticPerson(220, 0.009)}};
}

TEST(KeptFit, IsTheFitBitForBit) {
  const auto fit = FitMotion(GeneratedLungs(), SyntheticPerson(150), {});
  ASSERT_TRUE(fit.ok()) << fit.status();
  const std::string bytes = KeepFit(*fit);
  const auto again = ReadKeptFit(bytes);
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(KeepFit(*again), bytes);
  EXPECT_EQ(again->held_out.mean, fit->held_out.mean);
  EXPECT_EQ(again->person.responses, fit->person.responses);
  EXPECT_EQ(again->parameters[3].name, fit->parameters[3].name);
  EXPECT_EQ(again->registered.lungs[kLeft].scale, fit->registered.lungs[kLeft].scale);
}

TEST(KeptFit, ThatIsCutOrLongerIsNoFit) {
  const std::string bytes = KeepFit(*FitMotion(GeneratedLungs(), SyntheticPerson(110), {}));
  for (size_t size = 0; size < bytes.size(); size += 997) EXPECT_FALSE(ReadKeptFit(bytes.substr(0, size))) << size;
  EXPECT_FALSE(ReadKeptFit(bytes + "x"));
}

TEST(MotionStudyOfThree, GoesOnAfterAnInterruptionWithTheSameNumbers) {
  std::map<std::string, std::string> kept;
  int found = 0;
  const KeptFits keep = {[&](const StudyCase& each) -> std::optional<MotionFit> {
                           if (!kept.contains(each.name)) return std::nullopt;
                           ++found;
                           return ReadKeptFit(kept[each.name]);
                         },
                         [&](const StudyCase& each, const MotionFit& fit) {
                           kept[each.name] = KeepFit(fit);
                           return absl::OkStatus();
                         }};
  const auto interrupted = StudyMotion(
      GeneratedLungs(), ThreePeople(), {}, [&](double done, auto) { return done < 0.5; }, keep);
  EXPECT_EQ(interrupted.status().code(), absl::StatusCode::kCancelled);
  ASSERT_EQ(kept.size(), 1u);
  const auto resumed = StudyMotion(GeneratedLungs(), ThreePeople(), {}, {}, keep);
  const auto whole = StudyMotion(GeneratedLungs(), ThreePeople(), {});
  ASSERT_TRUE(resumed.ok() && whole.ok());
  EXPECT_EQ(found, 1);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(resumed->people[i].fit.held_out.mean, whole->people[i].fit.held_out.mean);
    EXPECT_EQ(resumed->people[i].from_one_number->p95, whole->people[i].from_one_number->p95);
  }
  EXPECT_EQ(resumed->together.mean, whole->together.mean);
}

TEST(MotionStudyOfThree, EndsIfAPersonCannotBeKept) {
  const KeptFits full = {{},
                         [](const StudyCase&, const MotionFit&) { return absl::DataLossError("the disk is full"); }};
  const auto study = StudyMotion(GeneratedLungs(), ThreePeople(), {}, {}, full);
  EXPECT_THAT(std::string(study.status().message()), testing::HasSubstr("a: the disk is full"));
}

}  // namespace
}  // namespace phrenic::fit
