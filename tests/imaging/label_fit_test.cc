// The numbers of a volume tell which program made it: by the sizes and the places of what they mean.
#include "server/imaging/labels/label_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "server/imaging/labels/label_map.h"
#include "server/imaging/phantom.h"

namespace phrenic::imaging {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// Returns a phantom with the numbers of a map, and no names.
LabelVolume NumberedBy(const std::string& map) {
  LabelVolume volume = *MakePhantom(*FindPhantomBody("adult"), {6, 0, 0, 1}, *ReadLabelMap(map));
  volume.names.clear();
  return volume;
}

class LabelFit : public testing::TestWithParam<const char*> {};

TEST_P(LabelFit, NumbersTellTheirProgram) {
  std::vector<std::string> remarks;
  const absl::StatusOr<MapFit> fit = ChooseMap(NumberedBy(GetParam()), "labels", "", remarks);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->name, GetParam());
  EXPECT_GT(fit->agree, 5 * fit->differ);
  EXPECT_THAT(remarks, ElementsAre(HasSubstr(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Programs, LabelFit,
                         testing::Values("totalsegmentator", "vista3d", "moose-vertebrae", "cads-552"));

TEST(LabelMaps, WordsOfTheFileDecideBetweenEqualNumbers) {
  const LabelVolume ribs = NumberedBy("cads-555");
  std::vector<std::string> remarks;
  EXPECT_EQ(ChooseMap(ribs, "clin_CT_Ribs_0000", "", remarks)->name, "moose-ribs");
  EXPECT_EQ(ChooseMap(ribs, "scan_part_555", "", remarks)->name, "cads-555");
  EXPECT_NE(ChooseMap(ribs, "CT_Organs", "", remarks)->name, "moose-organs") << "a word does not make ribs organs";
}

TEST(LabelMaps, AnotherProgramsMapIsReadAndTheBetterOneNamed) {
  std::vector<std::string> remarks;
  const absl::StatusOr<MapFit> fit = ChooseMap(NumberedBy("vista3d"), "labels", "totalsegmentator", remarks);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->name, "totalsegmentator");
  EXPECT_THAT(remarks, ElementsAre(HasSubstr("fit another better: vista3d")));
  remarks.clear();
  EXPECT_EQ(ChooseMap(NumberedBy("moose-ribs"), "labels", "moose", remarks)->name, "moose-ribs");
  EXPECT_THAT(remarks, IsEmpty());
}

TEST(LabelMaps, AnUnknownMapIsRefusedWithTheKnownOnes) {
  std::vector<std::string> remarks;
  const absl::Status status = ChooseMap(NumberedBy("moose-ribs"), "labels", "mooze", remarks).status();
  EXPECT_TRUE(absl::IsNotFound(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("vista3d, cads-551"));
}

// Every shipped map has a program, valid meanings, no number twice, and names that the common map knows.
TEST(LabelMaps, ShippedMapsNameKnownStructures) {
  const v1::LabelMap common = *ReadLabelMap(kNamesMap);
  std::set<std::string> names;
  for (const v1::LabelMeaning& label : common.labels()) names.insert(label.name());
  for (const std::string& map : InstalledLabelMaps()) {
    const v1::LabelMap read = *ReadLabelMap(map);
    EXPECT_FALSE(read.tool().empty()) << map;
    std::set<int> numbers;
    const v1::LabelMap renamed = WithNamesOf(common, read);
    for (const v1::LabelMeaning& label : renamed.labels()) {
      EXPECT_TRUE(numbers.insert(label.number()).second) << map << " " << label.number();
      EXPECT_TRUE(names.contains(label.name())) << map << " " << label.name();
      EXPECT_NE(label.what_case(), v1::LabelMeaning::WHAT_NOT_SET) << map << " " << label.name();
    }
  }
}

// VISTA3D's numbers by the dictionary of its repository.
TEST(LabelMaps, Vista3dHasItsOwnNumbers) {
  const v1::LabelMap map = *ReadLabelMap("vista3d");
  const std::map<std::string, int> expected = {{"liver", 1},
                                               {"spleen", 3},
                                               {"stomach", 12},
                                               {"lung_upper_lobe_left", 28},
                                               {"lung_lower_lobe_right", 32},
                                               {"vertebrae_L5", 33},
                                               {"vertebrae_T12", 38},
                                               {"vertebrae_T1", 49},
                                               {"rib_left_1", 63},
                                               {"rib_right_12", 86},
                                               {"costal_cartilages", 114},
                                               {"heart", 115},
                                               {"sternum", 122}};
  for (const v1::LabelMeaning& label : map.labels()) {
    const auto known = expected.find(label.name());
    if (known == expected.end()) continue;
    EXPECT_EQ(label.number(), known->second) << label.name();
  }
  EXPECT_EQ(map.labels_size(), 3 + 5 + 17 + 24 + 3);
}

}  // namespace
}  // namespace phrenic::imaging
