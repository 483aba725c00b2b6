// Compares the encoded bytes of one frame and of one body's geometry with golden files (see proto/README.md). The
// viewer's tests read the same files.
#include "server/stream/frame.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "server/stream/encoder.h"
#include "server/stream/geometry.h"
#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic::stream {
namespace {

using Json = nlohmann::json;

std::string Golden(const std::string& name) {
  std::ifstream file(PHRENIC_SOURCE_DIR "/tests/golden/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_FALSE(text.str().empty()) << "tests/golden/" << name << " is missing";
  return text.str();
}

// Hexadecimal digits, 64 per line.
std::string Hex(const std::string& bytes) {
  const std::string digits = absl::BytesToHexString(bytes);
  std::string lines;
  for (std::size_t i = 0; i < digits.size(); i += 64) lines += digits.substr(i, 64) + "\n";
  return lines;
}

template <class Number>
Json Numbers(const std::string& bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

// All numbers are exact in float32, so that rounding cannot differ between languages.
Snapshot MakeSnapshot(const Model& model) {
  Snapshot snapshot{.sequence = 7,
                    .state = model.InitialState(),
                    .parameters = model.parameters,
                    .made = absl::FromUnixNanos(1'700'000'000'123'456'789)};
  snapshot.state.tick = 42;
  snapshot.state.time = 1.5;
  snapshot.state.phase = 0.25;
  snapshot.state.x << 0, 1.25, -0.5, 0, 0.125, 1, 0, -2.5, 0.0625;
  Pose& pose = snapshot.state.poses.emplace_back();
  pose.rotation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);  // w x y z
  pose.translation = {-0.25, 8, 1024};
  return snapshot;
}

Json Decode(const v1::Frame& frame) {
  Json json = {{"sequence", frame.sequence()},
               {"tick", frame.tick()},
               {"time", frame.time()},
               {"breath", frame.breath()},
               {"phase", frame.phase()},
               {"unixNanos", std::to_string(frame.unix_nanos())},
               {"positions", Numbers<float>(frame.positions())},
               {"poses", Numbers<float>(frame.poses())},
               {"probes", Json::array()},
               {"measures", Json::array()}};
  for (const v1::ProbeReading& probe : frame.probes()) {
    json["probes"].push_back({{"name", probe.name()},
                              {"x", probe.x()},
                              {"y", probe.y()},
                              {"z", probe.z()},
                              {"dx", probe.dx()},
                              {"dy", probe.dy()},
                              {"dz", probe.dz()}});
  }
  for (const v1::MeasureReading& reading : frame.measures()) {
    json["measures"].push_back({{"name", reading.name()}, {"value", reading.value()}, {"unit", reading.unit()}});
  }
  return json;
}

Json Decode(const v1::GetGeometryResponse& body) {
  return {{"bodyCount", body.body_count()},
          {"bodyIndex", body.body_index()},
          {"name", body.name()},
          {"layer", body.layer()},
          {"layerTitle", body.layer_title()},
          {"color", body.color()},
          {"opacity", body.opacity()},
          {"placement", static_cast<int>(body.placement())},
          {"pose", body.pose()},
          {"firstVertex", body.first_vertex()},
          {"restPositions", Numbers<float>(body.rest_positions())},
          {"triangles", Numbers<std::uint32_t>(body.triangles())},
          {"fixedVertices", Numbers<std::uint32_t>(body.fixed_vertices())}};
}

TEST(Golden, BytesOfAFrameAreThoseInTheFile) {
  const auto model = CompileText(Triangle("measures { name: 'height' highest { body: 'sheet' } }"));
  const Layout layout(*model);
  Encoder encoder(model, layout);
  const Bytes bytes = encoder.Encode(MakeSnapshot(*model), {});
  ASSERT_NE(bytes, nullptr);
  EXPECT_EQ(Hex(*bytes), Golden("frame.hex"));
}

TEST(Golden, BytesInTheFileAreTheFrameInTheFile) {
  v1::WatchFramesResponse response;
  std::string digits = Golden("frame.hex");
  std::erase_if(digits, absl::ascii_isspace);
  ASSERT_TRUE(response.ParseFromString(absl::HexStringToBytes(digits)));
  EXPECT_EQ(Decode(response.frame()), Json::parse(Golden("frame.json"))) << Decode(response.frame()).dump(2);
}

TEST(Golden, BytesOfABodyAreThoseInTheFile) {
  const auto model = CompileText(kTriangle);
  const v1::GetGeometryResponse body = MakeGeometry(*model, Layout(*model), 1);
  EXPECT_EQ(Hex(body.SerializeAsString()), Golden("geometry.hex"));
  EXPECT_EQ(Decode(body), Json::parse(Golden("geometry.json"))) << Decode(body).dump(2);
}

}  // namespace
}  // namespace phrenic::stream
