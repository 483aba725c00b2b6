#include <algorithm>
#include <array>

#include "server/stream/codecs/basis.h"
#include "server/stream/codecs/codec.h"
#include "server/stream/codecs/planes.h"
#include "server/stream/codecs/predicted.h"
#include "server/stream/codecs/raw.h"

namespace phrenic::stream {
namespace {

template <class Made>
std::unique_ptr<Codec> Make(const RestShape& shape) {
  return std::make_unique<Made>(shape);
}

constexpr std::array kCodecs = {
    CodecRow{v1::CODEC_RAW, "raw", Make<RawCodec>},
    CodecRow{v1::CODEC_PLANES, "planes", Make<PlanesCodec>},
    CodecRow{v1::CODEC_PREDICTED, "predicted", Make<PredictedCodec>},
    CodecRow{v1::CODEC_BASIS, "basis", Make<BasisCodec>},
};

}  // namespace

std::span<const CodecRow> Codecs() { return kCodecs; }

std::unique_ptr<Codec> MakeCodec(v1::Codec codec, const RestShape& shape) {
  const auto row =
      std::find_if(kCodecs.begin(), kCodecs.end(), [codec](const auto& each) { return each.codec == codec; });
  return (row == kCodecs.end() ? kCodecs.front() : *row).make(shape);
}

}  // namespace phrenic::stream
