// `phrenic inspect` and `phrenic convert`: surface files are checked, repaired and converted.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "client/files/whole_file.h"
#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr char kTetrahedron[] =
    "v 0.1 0 0\nv 50.7 0 0\nv 0 60 0\nv 0 0 70\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string Ras() { return WriteScratch("ras.obj", std::string("# 3D Slicer output. SPACE=RAS\n") + kTetrahedron); }

TEST(InspectCommand, JsonAndTextHaveTheSameNumbers) {
  const Outcome text = Phrenic({"inspect", Ras()});
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("frame                         RAS\n"));
  EXPECT_THAT(text.out, HasSubstr("x -50.70 to 0.00, y -60.00 to 0.00, z 0.00 to 70.00 mm")) << "in LPS";
  EXPECT_THAT(text.out, HasSubstr("volume                        35.420 ml\n"));
  EXPECT_THAT(text.out, EndsWith("To repair\n- nothing\n\nWhat a scene would refuse\n- nothing\n"));
  const auto json = Phrenic({"inspect", Ras(), "-o", "json"}).json();
  ASSERT_FALSE(json.is_discarded());
  EXPECT_EQ(json["triangles"], 4);
  EXPECT_EQ(json["components"][0]["genus"], 0);
  EXPECT_EQ(json["frame"], "RAS");
  EXPECT_NEAR(json["volume_ml"].get<double>(), 35.420, 0.001);
}

TEST(WholeFiles, ADeviceOrPipeIsWrittenToAndNotReplaced) {
  const std::string pipe = Scratch("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { std::getline(std::ifstream(pipe), read); });
  EXPECT_TRUE(WriteWhole(pipe, "text\n").ok());
  reader.join();
  EXPECT_EQ(read, "text");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(InspectCommand, TheUnitIsAppliedAndChecked) {
  const auto json = Phrenic({"inspect", Ras(), "--unit-mm", "10", "-o", "json"}).json();
  ASSERT_FALSE(json.is_discarded());
  EXPECT_NEAR(json["greatest_mm"][2].get<double>(), 700, 1e-9);
  EXPECT_EQ(Phrenic({"inspect", Ras(), "--unit-mm", "0"}).code, 2);
}

TEST(InspectCommand, InvalidFilesAreRejectedWithFileAndLine) {
  const Outcome missing = Phrenic({"inspect", "/nowhere/lung.stl"});
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.err, HasSubstr("/nowhere/lung.stl"));
  const Outcome bad =
      Phrenic({"inspect", WriteScratch("bad.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 1\n")});
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("bad.stl:4: a corner is written"));
  EXPECT_THAT(bad.out, IsEmpty());
}

TEST(ConvertCommand, AnyToAnyAndBackKeepsTheSurface) {
  const std::string first = Scratch("first.obj");
  ASSERT_EQ(Phrenic({"convert", Ras(), first}).code, 0);
  EXPECT_THAT(ReadAll(first), HasSubstr("v -50.7 0 0\n")) << "all digits, in LPS";
  for (const std::string ending : {".msh", ".ply", ".stl"}) {
    const std::string file = Scratch("there" + ending), back = Scratch("back.obj");
    const Outcome there = Phrenic({"convert", first, file});
    ASSERT_EQ(there.code, 0) << there.err;
    EXPECT_THAT(there.out, EndsWith(ending + ": 4 vertices, 4 triangles\n"));
    EXPECT_THAT(there.err, IsEmpty());
    ASSERT_EQ(Phrenic({"convert", file, back}).code, 0);
    if (ending == ".stl") {
      EXPECT_EQ(Phrenic({"compare", first, back, "--check", "hd_max=1e-5"}).code, 0) << "float32 in between";
    } else {
      EXPECT_EQ(ReadAll(back), ReadAll(first)) << ending;
    }
  }
}

TEST(ConvertCommand, UnitsAreConverted) {
  const std::string metres = Scratch("metres.ply");
  ASSERT_EQ(Phrenic({"convert", Ras(), metres, "--unit-mm", "10", "--out-unit-mm", "1000"}).code, 0);
  const auto json = Phrenic({"inspect", metres, "-o", "json"}).json();
  ASSERT_FALSE(json.is_discarded());
  EXPECT_NEAR(json["greatest_mm"][2].get<double>(), 0.7, 1e-12) << "read as millimetres";
  EXPECT_EQ(json["likely_unit"], "m");
}

TEST(ConvertCommand, LossesAreReported) {
  const std::string regions = WriteScratch(
      "regions.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"tendon\"\n$EndPhysicalNames\n"
      "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 5 5 5\n$EndNodes\n$Elements\n1\n1 2 2 7 1 1 2 3\n$EndElements\n");
  const Outcome stl = Phrenic({"convert", regions, Scratch("out.stl")});
  EXPECT_EQ(stl.code, 0);
  EXPECT_THAT(stl.err, HasSubstr("1 unused or duplicate vertices"));
  EXPECT_THAT(stl.err, HasSubstr("the region \"tendon\" is missing"));
  EXPECT_THAT(Phrenic({"convert", regions, Scratch("out.msh")}).err, IsEmpty());
  const Outcome unknown = Phrenic({"convert", regions, Scratch("out.step")});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr(".obj, .msh, .stl, .ply"));
}

TEST(ConvertCommand, AppliesTheChosenRepairs) {
  const std::string turned = WriteScratch("turned.obj",
                                          "v 0 0 0\nv 50 0 0\nv 0 60 0\nv 0 0 70\nv 0 0 70\n"
                                          "f 1 3 2\nf 1 2 4\nf 1 5 3\nf 2 4 3\n");
  const std::string out = Scratch("repaired.obj");
  const auto repairs = [&out] { return Phrenic({"inspect", out, "-o", "json"}).json()["repairs"].size(); };
  ASSERT_EQ(Phrenic({"convert", turned, out}).code, 0);
  EXPECT_EQ(repairs(), 3u) << "no repair by default: a double vertex, open edges, one reversed triangle";
  const Outcome welded = Phrenic({"convert", turned, out, "--repair", "weld,orient"});
  EXPECT_THAT(welded.err, HasSubstr("1 duplicate or unused vertices removed"));
  EXPECT_THAT(welded.err, HasSubstr("1 triangles reoriented"));
  EXPECT_EQ(repairs(), 0u);
  EXPECT_EQ(Phrenic({"convert", turned, out, "--repair", "magic"}).code, 2);
}

// A published lung surface with a fin inside.
TEST(ConvertCommand, ALungWithAFinIsRepaired) {
  const std::filesystem::path lungs = std::filesystem::path(PHRENIC_SHARED_DIR) / "data" / "thorax" / "lungs";
  const std::string lung = lungs / "inferior_lobe_of_right_lung_closed.obj";
  if (!std::filesystem::exists(lung)) GTEST_SKIP() << "no " << lung;
  const std::string out = Scratch("lung.obj");
  ASSERT_EQ(Phrenic({"convert", lung, out, "--repair", "all"}).code, 0);
  const auto json = Phrenic({"inspect", out, "-o", "json"}).json();
  EXPECT_EQ(json["triangles"], 8456);
  EXPECT_EQ(json["repairs"].size(), 0u);
  EXPECT_NEAR(json["volume_ml"].get<double>(), 691.6, 0.1);
}

TEST(CompareCommand, AcceptsEveryReadableFormat) {
  const std::string stl = Scratch("compared.stl");
  ASSERT_EQ(Phrenic({"convert", Ras(), stl}).code, 0);
  const Outcome same = Phrenic({"compare", Ras(), stl, "--check", "hd_max=1e-5"});
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_THAT(Phrenic({"compare", "--help"}).out, HasSubstr(".obj, .msh, .stl, .ply"));
}

}  // namespace
}  // namespace phrenic::client
