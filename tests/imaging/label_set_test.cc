// Label files of one patient become one volume, whatever program wrote them; files that contradict each other are
// refused.
#include "server/imaging/labels/label_set.h"

#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>

#include "absl/strings/str_cat.h"
#include "server/imaging/gzip.h"
#include "server/imaging/label_file.h"
#include "server/imaging/labels/label_archive.h"
#include "server/imaging/labels/label_input.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/mask.h"
#include "server/imaging/nifti.h"
#include "server/imaging/phantom.h"

namespace phrenic::imaging {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using Files = std::map<std::string, LabelVolume>;

const v1::LabelMap& Common() {
  static const v1::LabelMap map = *ReadLabelMap(kNamesMap);
  return map;
}

const LabelVolume& Whole() {
  static const LabelVolume whole = [] {
    LabelVolume volume = *MakePhantom(*FindPhantomBody("adult"), {6, 0, 0, 1}, Common());
    volume.names.clear();
    return volume;
  }();
  return whole;
}

// Returns the volume with other numbers; labels that become 0 are left out.
LabelVolume Renumbered(const std::function<int(const v1::LabelMeaning&)>& number) {
  std::vector<Label> becomes(65536);
  for (const v1::LabelMeaning& label : Common().labels()) {
    becomes[label.number()] = static_cast<Label>(number(label));
  }
  LabelVolume volume = Whole();
  for (Label& label : volume.labels) label = becomes[label];
  return volume;
}

// Returns the labels of another map alone, with its numbers.
LabelVolume By(const std::string& map) {
  const v1::LabelMap other = *ReadLabelMap(map);
  return Renumbered([&other](const v1::LabelMeaning& label) {
    for (const v1::LabelMeaning& own : other.labels()) {
      if (own.name() == label.name()) return own.number();
    }
    return 0;
  });
}

// Returns a mask of one label.
LabelVolume Alone(const std::string& name) {
  return Renumbered([&name](const v1::LabelMeaning& label) { return label.name() == name ? 1 : 0; });
}

absl::StatusOr<LabelVolume> Merge(const Files& files) {
  LabelSet set;
  for (const auto& [name, volume] : files) {
    if (absl::Status status = set.Add(name, volume, ""); !status.ok()) return status;
  }
  return set.Finish();
}

// Returns the voxels of each structure.
std::map<std::string, std::size_t> Voxels(const LabelVolume& volume) {
  std::vector<std::string> remarks;
  LabelVolume united = volume;
  const v1::LabelMap map = UniteLabels(Resolve(WithCommonNames(Common()), volume, remarks), united);
  const std::map<Label, Extent> extents = Extents(united);
  std::map<std::string, std::size_t> voxels;
  for (const v1::LabelMeaning& label : map.labels()) {
    const auto extent = extents.find(static_cast<Label>(label.number()));
    if (extent != extents.end()) voxels[label.name()] = extent->second.voxels;
  }
  return voxels;
}

std::string Tar(const std::map<std::string, std::string>& files) {
  std::string bytes(std::size_t{64} << 20, '\0');
  std::size_t used = 0;
  archive* tar = archive_write_new();
  archive_write_set_format_ustar(tar);
  archive_write_open_memory(tar, bytes.data(), bytes.size(), &used);
  for (const auto& [name, content] : files) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_write_header(tar, entry);
    archive_write_data(tar, content.data(), content.size());
    archive_entry_free(entry);
  }
  archive_write_close(tar);
  archive_write_free(tar);
  bytes.resize(used);
  return bytes;
}

std::string Nifti(const LabelVolume& volume) { return Deflate(WriteNifti(volume)); }

TEST(LabelSet, AFileForEachStructureIsTheWholeVolume) {
  Files files;
  for (const v1::LabelMeaning& label : Common().labels()) {
    LabelVolume alone = Alone(label.name());
    if (!Extents(alone).empty()) files.emplace("case 12/" + label.name() + ".nii.gz", std::move(alone));
  }
  const absl::StatusOr<LabelVolume> merged = Merge(files);
  ASSERT_TRUE(merged.ok()) << merged.status();
  LabelVolume named = Whole();
  for (const v1::LabelMeaning& label : Common().labels()) named.names[label.number()] = label.name();
  EXPECT_EQ(Voxels(*merged), Voxels(named));
  EXPECT_GT(Voxels(*merged).size(), 40U);
}

// Four files of MOOSE, and four of CADS, with their own numbers, are the same structures.
TEST(LabelSet, FilesOfMooseAndCadsAreTheSameStructures) {
  const Files moose = {{"CT_Organs_0000.nii.gz", By("moose-organs")},
                       {"CT_Ribs_0000.nii.gz", By("moose-ribs")},
                       {"CT_VertebralBody_0000.nii.gz", By("moose-vertebrae")}};
  const Files cads = {{"scan_part_551.nii.gz", By("cads-551")},
                      {"scan_part_552.nii.gz", By("cads-552")},
                      {"scan_part_555.nii.gz", By("cads-555")},
                      {"scan_part_556.nii.gz", By("cads-556")}};
  const absl::StatusOr<LabelVolume> of_moose = Merge(moose), of_cads = Merge(cads);
  ASSERT_TRUE(of_moose.ok() && of_cads.ok()) << of_moose.status() << of_cads.status();
  std::map<std::string, std::size_t> expected = Voxels(*of_cads);
  EXPECT_EQ(expected.count("heart"), 1U);
  expected.erase("heart");
  EXPECT_EQ(Voxels(*of_moose), expected);
  EXPECT_GE(expected.size(), 24U + 15U + 2U);
  EXPECT_THAT(of_moose->remarks, Contains(HasSubstr("moose-vertebrae")));
}

TEST(LabelSet, SpellingsOfNamesAreOneStructure) {
  for (const char* file : {"Rib-left-7.nii.gz", "DOE_rib_7_L.nii.gz", "left rib 07.nii", "seventh_rib_left.nii.gz",
                           "s12/Rib7_Left_0000.nii.gz"}) {
    const absl::StatusOr<LabelVolume> merged = Merge({{file, Alone("rib_left_7")}});
    ASSERT_TRUE(merged.ok()) << merged.status();
    EXPECT_EQ(Voxels(*merged).count("rib_left_7"), 1U) << file;
  }
  const absl::StatusOr<LabelVolume> unknown = Merge({{"kidney_left.nii.gz", Alone("rib_left_7")}});
  EXPECT_THAT(unknown->remarks, Contains(HasSubstr("not known by their names or numbers: kidney_left.nii.gz")));
}

TEST(LabelSet, FilesOfDifferentGridsAreRefusedWithBothGrids) {
  LabelVolume shifted = Alone("rib_left_8");
  shifted.to_patient.pretranslate(Eigen::Vector3d(0, 0, 3));
  const absl::Status status = Merge({{"rib_left_7.nii", Alone("rib_left_7")}, {"rib_left_8.nii", shifted}}).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("rib_left_8.nii: has"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("resample this file"));
}

TEST(LabelSet, OneStructureInTwoFilesIsRefusedUnlessItIsTheSame) {
  const Files other = {{"a/liver.nii", Alone("liver")}, {"b/liver.nii", Alone("spleen")}};
  EXPECT_THAT(std::string(Merge(other).status().message()), HasSubstr("b/liver.nii: \"liver\" is in a/liver.nii too"));
  const absl::StatusOr<LabelVolume> same = Merge({{"a/liver.nii", Alone("liver")}, {"b/liver.nii", Alone("liver")}});
  ASSERT_TRUE(same.ok()) << same.status();
  EXPECT_EQ(Voxels(*same), Voxels(*Merge({{"liver.nii", Alone("liver")}})));
}

// A lung and its lobes, or a heart and its chambers, may both have files.
TEST(LabelSet, PartsCountBeforeTheWhole) {
  LabelVolume lung = Renumbered([](const v1::LabelMeaning& label) {
    return label.anatomy().structure() == v1::STRUCTURE_LUNG && label.anatomy().side() == v1::SIDE_LEFT ? 1 : 0;
  });
  LabelVolume lobe = lung;
  const Extent extent = Extents(lung).begin()->second;
  const std::size_t below = lung.Index({0, 0, (2 * extent.low.z() + extent.high.z()) / 3});
  std::fill(lobe.labels.begin(), lobe.labels.begin() + static_cast<std::ptrdiff_t>(below), Label{0});
  const absl::StatusOr<LabelVolume> merged = Merge({{"lung_left.nii", lung}, {"lung_upper_lobe_left.nii", lobe}});
  ASSERT_TRUE(merged.ok()) << merged.status();
  EXPECT_EQ(Voxels(*merged).count("lung_upper_lobe_left"), 1U);
  LabelVolume left = Alone("heart"), right = left;
  const std::size_t half = left.labels.size() / 2;
  std::fill(left.labels.begin(), left.labels.begin() + static_cast<std::ptrdiff_t>(half), Label{0});
  std::fill(right.labels.begin() + static_cast<std::ptrdiff_t>(half), right.labels.end(), Label{0});
  const Files chambers = {{"heart_atrium_left.nii", left}, {"heart_ventricle_right.nii", right}};
  EXPECT_EQ(Voxels(*Merge(chambers)), Voxels(*Merge({{"heart.nii", Alone("heart")}})));
}

TEST(LabelSet, AnArchiveIsReadAsItsFiles) {
  const std::string liver = Nifti(Alone("liver")), ribs = Nifti(By("moose-ribs"));
  const std::string tar = Tar({{"liver.nii.gz", liver}, {"CT_Ribs.nii.gz", ribs}, {"notes.txt", "seen by K."}});
  ASSERT_TRUE(IsArchive(tar));
  const absl::StatusOr<LabelInput> input = ParseLabelInput("labels", tar, "");
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_EQ(input->meanings.labels_size(), 1 + 24 + 1);
  EXPECT_THAT(input->volume.remarks, Contains(HasSubstr("not label files: notes.txt")));
  EXPECT_THAT(std::string(ParseLabelInput("labels", Tar({{"a.txt", "a"}}), "").status().message()),
              HasSubstr("has no label file"));
  for (const std::size_t length : {std::size_t{700}, liver.size() / 2, tar.size() / 2}) {
    EXPECT_TRUE(absl::IsInvalidArgument(ParseLabelInput("labels", tar.substr(0, length), "").status())) << length;
  }
}

// Returns an uncompressed NIfTI file with another type of voxels.
std::string WithType(const LabelVolume& volume, int code) {
  constexpr std::size_t kTypeAt = 70;
  std::string bytes = WriteNifti(volume);
  bytes[kTypeAt] = static_cast<char>(code);
  bytes[kTypeAt + 1] = '\0';
  return bytes;
}

TEST(LabelSet, FilesThatAreLeftOutHaveTheirReason) {
  const std::string liver = Nifti(Alone("liver")), real = WithType(Alone("spleen"), 16);
  std::string nameless = WriteNifti(Alone("heart"));
  nameless.replace(344, 3, "???");
  const std::map<std::string, std::string> bad = {
      {"ct.nii", real},
      {"dose", Deflate(real)},
      {"heart.nii", nameless},
      {"rib.nii.gz", liver.substr(0, 9)},
      {"more.zip", std::string("PK\x03\x04", 4) + "..."},
      {"all.tgz", Deflate(Tar({{"liver.nii.gz", liver}}))},
      {"old.7z", "7z\xbc\xaf\x27\x1c..."},
      {"notes.txt.gz", Deflate("seen by K.")},
  };
  std::map<std::string, std::string> files = bad;
  files["liver.nii.gz"] = liver;
  const absl::StatusOr<LabelInput> input = ParseLabelInput("labels", Tar(files), "");
  ASSERT_TRUE(input.ok()) << input.status();
  const std::vector<std::string> reasons = {
      "left out: ct.nii, dose: byte 70: voxels are float32 numbers (type code 16), and labels are integers: save it as",
      "left out: heart.nii: not a NIfTI-1 or NIfTI-2 file",
      "left out: rib.nii.gz: the gzip data is truncated",
      "left out: more.zip: an archive among other files is not read; unpack it",
      "left out: all.tgz: is an archive compressed by gzip (.tar.gz, .tgz), which is not read; unpack it",
      "left out: old.7z: is a 7-Zip archive (.7z), which is not read; unpack it",
      "left out, because they are not label files: notes.txt.gz",
  };
  for (const std::string& reason : reasons) EXPECT_THAT(input->volume.remarks, Contains(HasSubstr(reason)));
  const std::string none(ParseLabelInput("labels", Tar(bad), "").status().message());
  EXPECT_THAT(none, HasSubstr("has no label file"));
  EXPECT_THAT(none, HasSubstr("; left out: ct.nii, dose: byte 70: voxels are float32 numbers"));
}

TEST(LabelSet, ProblemsWithoutEndAreToldTogether) {
  std::map<std::string, std::string> files = {{"liver.nii.gz", Nifti(Alone("liver"))}};
  for (int code = 100; code < 125; ++code) files[absl::StrCat(code, ".nii")] = WithType(Alone("spleen"), code);
  const absl::StatusOr<LabelInput> input = ParseLabelInput("labels", Tar(files), "");
  ASSERT_TRUE(input.ok()) << input.status();
  const std::vector<std::string>& remarks = input->volume.remarks;
  EXPECT_EQ(std::ranges::count_if(remarks, [](const std::string& each) { return each.starts_with("left out: "); }), 21);
  EXPECT_THAT(remarks, Contains(HasSubstr("120.nii, 121.nii, 122.nii, 123.nii, 124.nii: for other reasons")));
}

TEST(LabelSet, ArchivesThatAreNotReadAreNamed) {
  const std::string tgz = Deflate(Tar({{"liver.nii.gz", Nifti(Alone("liver"))}}));
  const std::map<std::string, std::string> archives = {{tgz, ".tar.gz"},         {"7z\xbc\xaf\x27\x1c", ".7z"},
                                                       {"Rar!\x1a\x07", ".rar"}, {"BZh91AY", "bzip2"},
                                                       {"\xfd\x37zXZ", "xz"},    {"\x28\xb5\x2f\xfd", "Zstandard"}};
  for (const auto& [bytes, format] : archives) {
    for (const absl::Status& status : {ParseLabelInput("scan", bytes, "").status(), CheckLabelFormat("scan", bytes)}) {
      EXPECT_TRUE(absl::IsInvalidArgument(status)) << format;
      EXPECT_THAT(std::string(status.message()), HasSubstr(format));
      EXPECT_THAT(std::string(status.message()), HasSubstr("unpack it and give the files or their folder, or pack"));
    }
  }
}

// The bytes that follow a header in an archive need no memory before the header is judged.
TEST(LabelSet, AnUncompressedFileInAnArchiveHasTheLimitsOfOthers) {
  const std::string liver = WriteNifti(Alone("liver"));
  const std::size_t voxels = Whole().labels.size();
  const std::string longer = Tar({{"liver.nii", liver + std::string(std::size_t{3} << 20, 'x')}});
  ASSERT_TRUE(ParseLabelInput("labels", longer, "", voxels).ok());
  const absl::Status many = ParseLabelInput("labels", longer, "", voxels - 1).status();
  EXPECT_TRUE(absl::IsResourceExhausted(many)) << many;
  EXPECT_THAT(std::string(many.message()),
              HasSubstr(absl::StrCat("liver.nii: has ", voxels, " voxels of 2 bytes, more than ", voxels - 1)));
  const std::string padded = Tar({{"liver.nii.gz", Nifti(Alone("liver")) + std::string(4 * voxels, 'x')}});
  const absl::Status large = ParseLabelInput("labels", padded, "", voxels).status();
  EXPECT_TRUE(absl::IsResourceExhausted(large)) << large;
  EXPECT_THAT(std::string(large.message()), HasSubstr(absl::StrCat("is unpacked to more than ", 4 * voxels, " bytes")));
}

TEST(LabelSet, ReadingAnArchiveEndsWhenItIsNotWantedAnyMore) {
  const std::string liver = Nifti(Alone("liver"));
  int asked = 0;
  const auto stopped = [&asked] { return ++asked > 1; };
  const auto input = ParseLabelInput("labels", Tar({{"a.nii", liver}, {"b.nii", liver}}), "", kMaxVoxels, stopped);
  EXPECT_TRUE(absl::IsCancelled(input.status())) << input.status();
  EXPECT_EQ(asked, 2);
}

TEST(LabelSet, AFolderAndFilesWithTheirOwnMapsAreRead) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "label_set";
  std::filesystem::create_directories(folder / "model");
  const auto write = [&folder](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return (folder / name).string();
  };
  write("heart.nii.gz", Nifti(Alone("heart")));
  const std::string ribs = write("model/out.nii.gz", Nifti(By("moose-ribs")));
  write("readme.txt", "text");
  write("ct.nii", WithType(Alone("heart"), 64));
  const absl::StatusOr<LabelInput> all = ReadLabelInput({folder.string()}, {});
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_EQ(all->meanings.labels_size(), 1 + 25);
  EXPECT_THAT(all->volume.remarks, Contains(HasSubstr("ct.nii: byte 70: voxels are float64 numbers")));
  const absl::StatusOr<LabelInput> chosen = ReadLabelInput({folder.string()}, {"", {{"out.nii.gz", "moose-ribs"}}});
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_EQ(chosen->meanings.SerializeAsString(), all->meanings.SerializeAsString());
  EXPECT_THAT(std::string(ReadLabelInput({ribs}, {"", {{"x.nii", "cads-555"}}}).status().message()),
              HasSubstr("x.nii=cads-555: no label file"));
  EXPECT_TRUE(absl::IsNotFound(ReadLabelInput({(folder / "model").string(), "/nowhere.nii"}, {}).status()));
  const std::string packed = write("more.tar", Tar({{"liver.nii.gz", Nifti(Alone("liver"))}}));
  EXPECT_THAT(std::string(ReadLabelInput({ribs, packed}, {}).status().message()),
              HasSubstr("more.tar: an archive among other files is not read; unpack it, or give it alone"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace phrenic::imaging
