// Any bytes decoded by any codec give finite positions or an error: by the decoder that viewers have in WebAssembly.
// The first byte selects the codec.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/stream/codecs/decode.h"

namespace {

// A triangle strip with every kind of neighbour.
phrenic::stream::RestShape Strip() {
  constexpr int kVertices = 31;
  phrenic::stream::RestShape shape{.rest = phrenic::stream::Floats(3, kVertices), .edges = phrenic::Edges(2, 0)};
  for (int i = 0; i < kVertices; ++i) {
    shape.rest.col(i) = Eigen::Vector3f(0.01F * static_cast<float>(i), i % 2 == 0 ? 0.F : 0.02F, 0.F);
  }
  shape.edges.resize(2, 2 * kVertices - 3);
  for (int i = 0; i + 1 < kVertices; ++i) shape.edges.col(i) << i, i + 1;
  for (int i = 0; i + 2 < kVertices; ++i) shape.edges.col(kVertices - 1 + i) << i, i + 2;
  for (const float part : {0.1F, -0.5F}) shape.shapes.emplace_back(part * shape.rest.colwise().reverse());
  return shape;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static auto& decoder = *phrenic::stream::MakeDecoder(Strip()).release();
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto codecs = phrenic::stream::Codecs();
  const auto positions = phrenic::stream::DecodeBy(decoder, codecs[data[0] % codecs.size()].codec, bytes);
  if (positions.ok() && !positions->allFinite()) std::abort();
  return 0;
}
