// Decoders of the codecs that need no rest shape: CODEC_RAW and CODEC_PLANES (proto/README.md specifies the bytes).
#ifndef PHRENIC_SERVER_STREAM_DECODER_PLAIN_DECODERS_H_
#define PHRENIC_SERVER_STREAM_DECODER_PLAIN_DECODERS_H_

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "server/stream/decoder/zstd_decoder.h"

namespace phrenic::stream {

// Returns null, or what is wrong with the bytes, as text that lives as long as the process. Writes finite positions, x
// y z per vertex [m]; after an error `to` is unspecified. Requires: the length of `to` is a multiple of 3. Thread-safe.
const char* DecodeRaw(std::string_view bytes, std::span<float> to);
// The same for CODEC_PLANES. `planes` is a buffer.
const char* DecodePlanes(std::string_view bytes, ZstdDecoder& zstd, std::vector<std::uint8_t>& planes,
                         std::span<float> to);

// True if no number is infinite or NaN.
bool AreFinite(std::span<const float> numbers);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_PLAIN_DECODERS_H_
