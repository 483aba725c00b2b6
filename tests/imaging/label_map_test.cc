// Labels are known by their name, by its words, or by the words of their code.
#include "server/imaging/labels/label_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace phrenic::imaging {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Returns the resolved number of a name in the shipped map; 0 if it is not there.
int NumberOf(const v1::LabelMap& map, const std::string& name) {
  for (const v1::LabelMeaning& label : map.labels()) {
    if (label.name() == name) return label.number();
  }
  return 0;
}

TEST(LabelMap, NamesThenWordsThenMeaningsAreKnown) {
  LabelVolume volume;
  volume.names = {{1, "spleen"},    {2, "Lung, upper lobe (left)"},
                  {3, "Segment 3"}, {4, "Segment 4"},
                  {5, "T12"},       {6, "Liver tumour"},
                  {7, "Segment 7"}, {8, "Segment 8"},
                  {9, "heart"}};
  volume.meanings = {{3, "Second rib Left"},          {4, "Middle lobe of right lung"}, {5, "T12 vertebra"},
                     {7, "Lower lobe of lung Right"}, {8, "Twelfth rib Right"},         {9, "Liver"}};
  std::vector<std::string> remarks;
  const v1::LabelMap map = Resolve(*ReadLabelMap("totalsegmentator"), volume, remarks);
  EXPECT_EQ(map.labels_size(), 8);
  EXPECT_EQ(NumberOf(map, "spleen"), 1);
  EXPECT_EQ(NumberOf(map, "lung_upper_lobe_left"), 2);
  EXPECT_EQ(NumberOf(map, "rib_left_2"), 3);
  EXPECT_EQ(NumberOf(map, "lung_middle_lobe_right"), 4);
  EXPECT_EQ(NumberOf(map, "vertebrae_T12"), 5);
  EXPECT_EQ(NumberOf(map, "lung_lower_lobe_right"), 7);
  EXPECT_EQ(NumberOf(map, "rib_right_12"), 8);
  EXPECT_EQ(NumberOf(map, "heart"), 9) << "the name counts, not the code";
  EXPECT_EQ(NumberOf(map, "liver"), 0) << "a tumour is not the liver";
  EXPECT_THAT(remarks, IsEmpty());
}

TEST(LabelMap, WithoutAKnownNameNumbersCountAndARemarkSaysSo) {
  LabelVolume volume;
  volume.names = {{5, "Leber"}};
  std::vector<std::string> remarks;
  const v1::LabelMap map = Resolve(*ReadLabelMap("totalsegmentator"), volume, remarks);
  EXPECT_EQ(NumberOf(map, "liver"), 5);
  EXPECT_THAT(remarks, ElementsAre(HasSubstr("none of the file's label names")));
}

// The shipped map has no two names of the same words.
TEST(LabelMap, EveryShippedNameIsKnownByItsWords) {
  const v1::LabelMap map = *ReadLabelMap("totalsegmentator");
  LabelVolume volume;
  for (const v1::LabelMeaning& label : map.labels()) {
    std::string spoken = label.name();
    for (char& c : spoken) c = c == '_' ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    volume.names[label.number() + 1000] = spoken;
  }
  std::vector<std::string> remarks;
  const v1::LabelMap resolved = Resolve(map, volume, remarks);
  ASSERT_EQ(resolved.labels_size(), map.labels_size());
  for (int l = 0; l < map.labels_size(); ++l) EXPECT_EQ(resolved.labels(l).number(), map.labels(l).number() + 1000);
}

TEST(LabelMap, WordsOfFileNamesAreAmongOthers) {
  const v1::LabelMap map = WithCommonNames(*ReadLabelMap(kNamesMap));
  EXPECT_EQ(LabelOfFile(map, "case-12_CT_Rib-left-07"), "rib_left_7");
  EXPECT_EQ(LabelOfFile(map, "fab vertebrae t12"), "vertebra_t12");
  EXPECT_EQ(LabelOfFile(map, "Upper lobe of lung L"), "upper_lobe_lung_left");
  EXPECT_EQ(LabelOfFile(map, "heart_atrium_left"), "heart_atrium_left") << "longer names count before shorter ones";
  EXPECT_EQ(LabelOfFile(map, "liver_and_spleen"), "") << "two structures";
  EXPECT_EQ(LabelOfFile(map, "kidney_left"), "");
  EXPECT_EQ(LabelOfFile(map, ""), "");
}

TEST(LabelMap, LabelsOfOneStructureAreUnited) {
  LabelVolume volume;
  volume.names = {{3, "heart_atrium_left"}, {4, "Heart ventricle R"}, {9, "Myocardium"}, {5, "liver"}};
  volume.labels = {0, 3, 4, 9, 5, 7};
  std::vector<std::string> remarks;
  const v1::LabelMap map = Resolve(*ReadLabelMap(kNamesMap), volume, remarks);
  EXPECT_EQ(map.labels_size(), 4);
  EXPECT_TRUE(HasRepeatedNames(map));
  const v1::LabelMap united = UniteLabels(map, volume);
  EXPECT_EQ(united.labels_size(), 2);
  EXPECT_FALSE(HasRepeatedNames(united));
  const auto heart = static_cast<Label>(NumberOf(united, "heart"));
  EXPECT_THAT(volume.labels, ElementsAre(0, heart, heart, heart, 5, 7));
}

}  // namespace
}  // namespace phrenic::imaging
