// The contract of every reader. To add a kind of file, add a line to kSamples: a file in the fuzz corpus that holds the
// tetrahedron of Corners() and Faces(), written by gmsh or VTK if they support the kind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "server/meshio/meshio.h"
#include "tests/meshio/allocations.h"

namespace phrenic::meshio {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

struct Sample {
  const char* file;
  Frame frame = Frame::kUnspecified;
};

constexpr Sample kSamples[] = {
    {"meshio_obj/plain.obj"},
    {"meshio_obj/ras.obj", Frame::kRas},
    {"meshio_msh/gmsh_text_22.msh"},
    {"meshio_msh/gmsh_binary_22.msh"},
    {"meshio_msh/big_endian_22.msh"},
    {"meshio_msh/gmsh_text_41.msh"},
    {"meshio_msh/gmsh_binary_41.msh"},
    {"meshio_msh/blocks_41.msh"},
    {"meshio_stl/vtk_text.stl"},
    {"meshio_stl/vtk_binary.stl"},
    {"meshio_stl/solid_binary.stl"},
    {"meshio_stl/ras_text.stl", Frame::kRas},
    {"meshio_stl/ras_binary.stl", Frame::kRas},
    {"meshio_ply/vtk_text.ply"},
    {"meshio_ply/vtk_little.ply"},
    {"meshio_ply/vtk_big.ply"},
    {"meshio_ply/ras_text.ply", Frame::kRas},
    {"meshio_ply/ras_little.ply", Frame::kRas},
    {"meshio_ply/many_properties_text.ply", Frame::kLps},
    {"meshio_ply/many_properties_little.ply", Frame::kLps},
    {"meshio_ply/many_properties_big.ply", Frame::kLps},
    {"meshio_vtk/vtk_text_42.vtk"},
    {"meshio_vtk/vtk_binary_42.vtk"},
    {"meshio_vtk/vtk_text_51.vtk"},
    {"meshio_vtk/vtk_binary_51.vtk"},
    {"meshio_vtk/ras_text.vtk", Frame::kRas},
    {"meshio_vtk/ras_binary_51.vtk", Frame::kRas},
    {"meshio_vtk/lps_binary.vtk", Frame::kLps},
    {"meshio_vtp/text.vtp"},
    {"meshio_vtp/ras_text.vtp", Frame::kRas},
    {"meshio_vtp/base64.vtp"},
    {"meshio_vtp/base64_zlib.vtp"},
    {"meshio_vtp/appended.vtp"},
    {"meshio_vtp/appended_zlib.vtp", Frame::kLps},
    {"meshio_vtp/appended_base64_zlib.vtp"},
    {"meshio_vtp/big_endian.vtp"},
};

Points Corners() {
  Points corners(3, 4);
  corners << 0, 1.5, 0, 0, 0, 0, 2.25, 0, 0, 0, 0, -3;
  return corners;
}

Triangles Faces() {
  Triangles faces(3, 4);
  faces << 0, 0, 0, 1, 1, 3, 2, 3, 2, 1, 3, 2;
  return faces;
}

class Reader : public ::testing::TestWithParam<Sample> {
 protected:
  void SetUp() override {
    std::ifstream in(std::string(PHRENIC_SOURCE_DIR) + "/tests/fuzz/corpus/" + file_, std::ios::binary);
    bytes_ = std::string(std::istreambuf_iterator<char>(in), {});
    ASSERT_FALSE(bytes_.empty()) << file_;
  }

  // Expects a valid mesh or an error with a position, and no allocation out of proportion to the file.
  void ExpectMeshOrError(std::string_view bytes, const std::string& what) {
    (void)TakeLargestAllocation();
    const auto mesh = Parse(file_, bytes, 1.0);
    EXPECT_LT(TakeLargestAllocation(), 4096 + 64 * bytes_.size()) << what;
    if (mesh.ok()) {
      EXPECT_TRUE(Validate(*mesh).ok()) << what;
      ++meshes_;
    } else {
      EXPECT_THAT(std::string(mesh.status().message()), StartsWith(file_ + ":")) << what;
      ++errors_;
    }
  }

  const std::string file_ = GetParam().file;
  std::string bytes_;
  int meshes_ = 0, errors_ = 0;
};

TEST_P(Reader, GivesTheTetrahedronInLps) {
  const auto surface = ParseSurface(file_, bytes_, 1.0);
  ASSERT_TRUE(surface.ok()) << surface.status();
  EXPECT_EQ(surface->mesh.vertices, Corners());
  EXPECT_EQ(surface->mesh.triangles, Faces());
  EXPECT_EQ(surface->frame, GetParam().frame);
}

TEST_P(Reader, EveryTruncationGivesAValidMeshOrAnError) {
  for (std::size_t length = 0; length < bytes_.size(); ++length) {
    ExpectMeshOrError(std::string_view(bytes_).substr(0, length), absl::StrCat("the first ", length, " bytes"));
  }
  EXPECT_GT(errors_, 0);
}

TEST_P(Reader, EveryFlippedBitGivesAValidMeshOrAnError) {
  for (std::size_t at = 0; at < bytes_.size(); ++at) {
    for (const int flip : {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80, 0xff}) {
      std::string flipped = bytes_;
      flipped[at] = static_cast<char>(flipped[at] ^ flip);
      ExpectMeshOrError(flipped, absl::StrCat("byte ", at, " ^ ", flip));
    }
  }
  EXPECT_GT(errors_, 0);
  EXPECT_GT(meshes_, 0);
}

TEST_P(Reader, EveryRemovedOrInsertedByteGivesAValidMeshOrAnError) {
  for (std::size_t at = 0; at < bytes_.size(); ++at) {
    ExpectMeshOrError(std::string(bytes_).erase(at, 1), absl::StrCat("without byte ", at));
    for (const char extra : {'\0', '9', '\n', '\xff'}) {
      const std::string longer = std::string(bytes_).insert(at, 1, extra);
      ExpectMeshOrError(longer, absl::StrCat("a byte before ", at));
    }
  }
  EXPECT_GT(errors_, 0);
}

TEST_P(Reader, CoordinatesAreScaledAndTheExtensionsCaseDoesNotMatter) {
  const auto mesh = Parse(absl::AsciiStrToUpper(file_), bytes_, 0.5);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices, 0.5 * Corners());
}

INSTANTIATE_TEST_SUITE_P(Samples, Reader, ::testing::ValuesIn(kSamples), [](const auto& sample) {
  return absl::StrReplaceAll(sample.param.file, {{"/", "_"}, {".", "_"}});
});

class MshReader : public Reader {};

TEST_P(MshReader, KeepsNamedPhysicalSurfaces) {
  const auto mesh = Parse(file_, bytes_, 1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_EQ(mesh->regions.size(), 1U);
  EXPECT_THAT(mesh->regions.at("central tendon"), ElementsAre(0, 1, 2, 3));
}

INSTANTIATE_TEST_SUITE_P(Samples, MshReader, ::testing::ValuesIn(kSamples + 2, kSamples + 8), [](const auto& sample) {
  return absl::StrReplaceAll(sample.param.file, {{"/", "_"}, {".", "_"}});
});

}  // namespace
}  // namespace phrenic::meshio
