// The verdict on a label volume: each finding comes with its cause, and goes with it.
#include "server/imaging/patient/readiness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "server/imaging/labels/label_map.h"
#include "server/imaging/patient/patient_scene.h"
#include "server/imaging/phantom.h"

namespace phrenic::imaging {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr auto kReady = v1::READINESS_VERDICT_READY, kWithCare = v1::READINESS_VERDICT_USABLE_WITH_CARE,
               kNotUsable = v1::READINESS_VERDICT_NOT_USABLE;

// A coarse phantom, with a sheet in form of a roof and a report of good numbers.
class ReadinessTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    map_ = *ReadLabelMap("totalsegmentator");
    whole_ = *MakePhantom(*FindPhantomBody("adult"), {6, 0, 0, 1}, map_);
  }
  void SetUp() override {
    volume_ = whole_;
    report_.mutable_diaphragm()->set_area_cm2(1000);
    report_.mutable_diaphragm()->set_extrapolated(0.1);
    for (int number = 1; number <= 12; ++number) {
      v1::PatientRib& rib = *report_.add_ribs();
      rib.set_body("rib-" + std::to_string(number) + "-left");
      rib.set_axis_degrees(50);
    }
    SetSheet(0.2, 0.19);
  }
  // A sheet of two domes, with its middle at another height [m].
  void SetSheet(double domes, double middle) {
    Mesh sheet;
    sheet.vertices.resize(3, 6);
    sheet.vertices << -0.1, -0.05, 0, 0.05, 0.1, 0, 0, 0, 0, 0, 0, 0.1, 0, domes, middle, domes, 0, middle;
    sheet.triangles.resize(3, 4);
    sheet.triangles << 0, 1, 2, 3, 1, 2, 3, 4, 5, 5, 5, 5;
    bodies_ = {{kMiddleBody, {}, sheet}};
  }
  // Removes the labels whose meaning fulfils the condition.
  void Remove(const std::function<bool(const v1::LabelMeaning&)>& gone) {
    for (const v1::LabelMeaning& label : map_.labels()) {
      if (gone(label)) std::replace(volume_.labels.begin(), volume_.labels.end(), Label(label.number()), Label(0));
    }
  }
  // Keeps the slices from `first` on, and drops `above` of the others.
  void Crop(int first, int above) {
    const auto slice = static_cast<std::ptrdiff_t>(volume_.size.x()) * volume_.size.y();
    volume_.labels.erase(volume_.labels.end() - above * slice, volume_.labels.end());
    volume_.labels.erase(volume_.labels.begin(), volume_.labels.begin() + first * slice);
    volume_.size.z() -= first + above;
    volume_.to_patient.translate(Eigen::Vector3d(0, 0, first));
  }
  v1::Readiness Judge() {
    Fallbacks fallbacks;
    const auto parts = FindParts(volume_, map_, fallbacks);
    EXPECT_TRUE(parts.ok()) << parts.status();
    return JudgeReadiness(volume_, *parts, bodies_, report_);
  }
  void ExpectOne(v1::ReadinessVerdict verdict, const std::vector<std::string>& words) {
    const v1::Readiness readiness = Judge();
    EXPECT_EQ(readiness.verdict(), verdict) << readiness.DebugString();
    ASSERT_EQ(readiness.findings_size(), 1) << readiness.DebugString();
    for (const std::string& word : words) EXPECT_THAT(readiness.findings(0).what(), HasSubstr(word));
    EXPECT_NE(readiness.findings(0).kind(), v1::FINDING_KIND_UNSPECIFIED);
    EXPECT_THAT(readiness.findings(0).what(), testing::ContainsRegex("; (use|label|check) "));
  }

  static v1::LabelMap map_;
  static LabelVolume whole_;
  LabelVolume volume_;
  std::vector<PatientBody> bodies_;
  v1::PatientReport report_;
};

v1::LabelMap ReadinessTest::map_;
LabelVolume ReadinessTest::whole_;

TEST_F(ReadinessTest, AWholeThoraxIsReady) {
  const v1::Readiness readiness = Judge();
  EXPECT_EQ(readiness.verdict(), kReady) << readiness.DebugString();
  EXPECT_THAT(readiness.findings(), IsEmpty());
}

TEST_F(ReadinessTest, ASlabIsNotUsable) {
  Crop(0, volume_.size.z() / 2);
  const v1::Readiness readiness = Judge();
  EXPECT_EQ(readiness.verdict(), kNotUsable);
  std::string all;
  for (const v1::ReadinessFinding& finding : readiness.findings()) all += finding.what() + "\n";
  EXPECT_THAT(all, AllOf(HasSubstr("lung"), HasSubstr("cut by the upper border"),
                         HasSubstr("ribs are missing (1 right"), HasSubstr("the border of the volume cuts rib-")));
  for (int i = 1; i < readiness.findings_size(); ++i) {
    EXPECT_LE(readiness.findings(i).verdict(), readiness.findings(i - 1).verdict()) << "the gravest first";
  }
}

TEST_F(ReadinessTest, AnObliqueVolumeNamesThePatientsSide) {
  Crop(0, volume_.size.z() / 2);
  volume_.to_patient = Eigen::Affine3d(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX())) * volume_.to_patient;
  EXPECT_THAT(Judge().findings(0).what(), HasSubstr("upper border"));
}

TEST_F(ReadinessTest, MissingOrgansAskForCareAndAllOfThemRefuse) {
  Remove([](const auto& label) { return label.organ() == v1::ORGAN_HEART; });
  ExpectOne(kWithCare, {"no label for heart"});
  Remove([](const auto& label) { return label.organ() == v1::ORGAN_STOMACH; });
  ExpectOne(kWithCare, {"no label for heart:"});
  Remove([](const auto& label) { return label.organ() != v1::ORGAN_UNSPECIFIED; });
  ExpectOne(kNotUsable, {"heart, liver, stomach or spleen"});
}

TEST_F(ReadinessTest, MissingRibsCountUnlessTheyFloat) {
  const auto number = [](const v1::LabelMeaning& label) {
    return label.anatomy().structure() == v1::STRUCTURE_RIB ? label.anatomy().number() : 0;
  };
  Remove([&](const auto& label) { return number(label) > 10; });
  EXPECT_EQ(Judge().verdict(), kReady);
  Remove([&](const auto& label) { return number(label) == 3; });
  ExpectOne(kWithCare, {"3 right, 3 left"});
  Remove([&](const auto& label) { return number(label) >= 1 && number(label) < 4; });
  EXPECT_EQ(Judge().verdict(), kWithCare);
  Remove([&](const auto& label) { return number(label) == 5; });
  ExpectOne(kNotUsable, {"5 right"});
}

TEST_F(ReadinessTest, ExtrapolationAxesTowerAndAreaHaveThresholds) {
  report_.mutable_diaphragm()->set_extrapolated(0.26);
  ExpectOne(kWithCare, {"26 % of the diaphragm is extrapolated"});
  report_.mutable_diaphragm()->set_extrapolated(0.51);
  ExpectOne(kNotUsable, {"51 %"});
  report_.mutable_diaphragm()->set_extrapolated(0.1);
  report_.mutable_ribs(9)->set_axis_degrees(141);
  ExpectOne(kWithCare, {"rib-10-left 141"});
  for (int i = 0; i < 3; ++i) report_.mutable_ribs(i)->set_axis_degrees(10);
  ExpectOne(kNotUsable, {"rib-1-left 10"});
  for (v1::PatientRib& rib : *report_.mutable_ribs()) rib.set_axis_degrees(50);
  SetSheet(0.2, 0.21);
  ExpectOne(kWithCare, {"10 mm above its domes"});
  SetSheet(0.2, 0.28);
  ExpectOne(kNotUsable, {"80 mm above its domes", "heart"});
  SetSheet(0.2, 0.19);
  report_.mutable_diaphragm()->set_area_cm2(2000);
  ExpectOne(kWithCare, {"2000 cm2"});
}

// Programs make their own sentences of the facts, which are those of the sentence.
TEST_F(ReadinessTest, FactsAreThoseOfTheSentence) {
  report_.mutable_ribs(9)->set_axis_degrees(141);
  v1::ReadinessFinding finding = Judge().findings(0);
  EXPECT_EQ(finding.kind(), v1::FINDING_KIND_ODD_AXES);
  EXPECT_THAT(finding.parts(), testing::ElementsAre("rib-10-left"));
  EXPECT_THAT(finding.values(), testing::ElementsAre(141));
  report_.mutable_ribs(9)->set_axis_degrees(50);
  Remove([](const auto& label) { return label.organ() == v1::ORGAN_STOMACH || label.organ() == v1::ORGAN_SPLEEN; });
  finding = Judge().findings(0);
  EXPECT_EQ(finding.kind(), v1::FINDING_KIND_ORGANS_MISSING);
  EXPECT_THAT(finding.parts(), testing::ElementsAre("stomach-or-spleen"));
  volume_ = whole_;
  SetSheet(0.2, 0.28);
  finding = Judge().findings(0);
  EXPECT_EQ(finding.kind(), v1::FINDING_KIND_TOWER);
  EXPECT_NEAR(finding.values(0), 80, 1e-6);
  SetSheet(0.2, 0.19);
  Crop(0, volume_.size.z() / 2);
  const v1::Readiness slab = Judge();
  for (const v1::ReadinessFinding& each : slab.findings()) {
    if (each.kind() != v1::FINDING_KIND_LUNG_CUT) continue;
    EXPECT_THAT(each.what(), HasSubstr(each.parts(0)));
    EXPECT_EQ(each.parts(1), "upper");
    EXPECT_GT(each.values(0), 2);
  }
}

}  // namespace
}  // namespace phrenic::imaging
