#include "client/python/decoder/frame_decoder.h"

#include <algorithm>
#include <exception>
#include <map>
#include <memory>
#include <string>

#include "server/stream/codecs/codec.h"

using phrenic::stream::Codec;
using phrenic::stream::Floats;

struct PhrenicDecoder {
  phrenic::stream::RestShape shape;
  std::map<std::int32_t, std::unique_ptr<Codec>> codecs;  // made when a frame first needs them
  std::string error;                                      // of the last call

  const Codec& Find(std::int32_t codec) {
    std::unique_ptr<Codec>& made = codecs[codec];
    if (made == nullptr) made = phrenic::stream::MakeCodec(static_cast<phrenic::v1::Codec>(codec), shape);
    return *made;
  }
  const char* Fail(std::string why) {
    error = std::move(why);
    return error.c_str();
  }
};

namespace {

Floats ColumnsAt(const float* numbers, std::int64_t columns) {
  return Eigen::Map<const Floats>(numbers, 3, static_cast<Eigen::Index>(columns));
}

bool AreBelow(const std::uint32_t* indices, std::int64_t count, std::int64_t limit) {
  return std::all_of(indices, indices + count, [limit](std::uint32_t index) { return index < limit; });
}

bool IsKnown(std::int32_t codec) {
  const auto rows = phrenic::stream::Codecs();
  return std::any_of(rows.begin(), rows.end(), [codec](const auto& row) { return row.codec == codec; });
}

}  // namespace

PhrenicDecoder* phrenic_decoder_make(const float* rest, std::int64_t vertices, const std::uint32_t* edges,
                                     std::int64_t edge_count) {
  if (!AreBelow(edges, 2 * edge_count, vertices)) return nullptr;
  try {
    auto decoder = std::make_unique<PhrenicDecoder>();
    decoder->shape.rest = ColumnsAt(rest, vertices);
    using Indices = Eigen::Matrix<std::uint32_t, 2, Eigen::Dynamic>;
    decoder->shape.edges = Eigen::Map<const Indices>(edges, 2, static_cast<Eigen::Index>(edge_count)).cast<int>();
    return decoder.release();
  } catch (const std::exception&) {
    return nullptr;
  }
}

const char* phrenic_decoder_set_basis(PhrenicDecoder* decoder, const float* shapes, std::int64_t count) {
  try {
    const Eigen::Index vertices = decoder->shape.rest.cols();
    decoder->codecs.erase(phrenic::v1::CODEC_BASIS);
    decoder->shape.shapes.clear();
    for (std::int64_t i = 0; i < count; ++i) {
      decoder->shape.shapes.push_back(ColumnsAt(shapes + 3 * vertices * i, vertices));
    }
    return nullptr;
  } catch (const std::exception& error) {
    return decoder->Fail(error.what());
  }
}

const char* phrenic_decoder_decode(PhrenicDecoder* decoder, std::int32_t codec, const char* bytes, std::int64_t size,
                                   float* positions) {
  try {
    if (!IsKnown(codec)) return decoder->Fail("this version does not know codec " + std::to_string(codec));
    const auto decoded = decoder->Find(codec).Decode({bytes, static_cast<std::size_t>(size)});
    if (!decoded.ok()) return decoder->Fail(std::string(decoded.status().message()));
    std::copy_n(decoded->data(), decoded->size(), positions);
    return nullptr;
  } catch (const std::exception& error) {
    return decoder->Fail(error.what());
  }
}

void phrenic_decoder_free(PhrenicDecoder* decoder) { delete decoder; }
