// Decodes golden bytes of each codec (see proto/README.md) and compares the positions bit by bit. The viewer's tests
// read the same file. Compressed bytes may differ between versions of zstd; decoded positions may not.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "absl/strings/escaping.h"
#include "server/mesh/topology.h"
#include "server/stream/codecs/codec.h"

namespace phrenic::stream {
namespace {

using Json = nlohmann::json;

Floats Positions(const Json& numbers) {
  const auto values = numbers.get<std::vector<float>>();
  return Eigen::Map<const Floats>(values.data(), 3, static_cast<Eigen::Index>(values.size() / 3));
}

TEST(Golden, PositionsOfEachCodecAreThoseInTheFile) {
  std::ifstream file(PHRENIC_SOURCE_DIR "/tests/golden/codecs.json");
  const Json golden = Json::parse(file);
  const auto corners = golden["triangles"].get<std::vector<int>>();
  const Triangles triangles =
      Eigen::Map<const Triangles>(corners.data(), 3, static_cast<Eigen::Index>(corners.size() / 3));
  RestShape shape{.rest = Positions(golden["rest"]), .edges = TriangleEdges(triangles)};
  const auto predicted = MakeCodec(v1::CODEC_PREDICTED, shape);
  for (const Json& each : golden["shapes"]) {
    const auto decoded = predicted->Decode(absl::HexStringToBytes(each["bytes"].get<std::string>()));
    ASSERT_TRUE(decoded.ok()) << decoded.status();
    shape.shapes.emplace_back(*decoded - shape.rest);
    EXPECT_EQ(shape.shapes.back(), Positions(each["displacements"]));
  }
  std::set<v1::Codec> pinned;
  for (const Json& encoding : golden["encodings"]) {
    v1::Codec named = v1::CODEC_UNSPECIFIED;
    ASSERT_TRUE(v1::Codec_Parse(encoding["codec"].get<std::string>(), &named));
    pinned.insert(named);
    const auto codec = MakeCodec(named, shape);
    const auto decoded = codec->Decode(absl::HexStringToBytes(encoding["bytes"].get<std::string>()));
    ASSERT_TRUE(decoded.ok()) << decoded.status();
    EXPECT_EQ(*decoded, Positions(encoding["positions"])) << encoding["codec"];
    const auto again = codec->Encode(Positions(golden["positions"]),
                                     1e-3 * encoding.value("maxErrorMm", golden["maxErrorMm"].get<double>()));
    ASSERT_TRUE(again.ok()) << again.status();
    EXPECT_EQ(*codec->Decode(*again), *decoded) << encoding["codec"];
  }
  EXPECT_EQ(pinned.size(), Codecs().size()) << "a codec has no golden bytes in the file";
}

}  // namespace
}  // namespace phrenic::stream
