// Bytes to residuals: two bits each, and an overflow of those that need more (proto/README.md).
#ifndef PHRENIC_SERVER_STREAM_DECODER_RESIDUALS_H_
#define PHRENIC_SERVER_STREAM_DECODER_RESIDUALS_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "server/stream/decoder/prediction.h"
#include "server/stream/decoder/zstd_decoder.h"

namespace phrenic::stream {

// Reads residuals of that many places; keeps its buffers. One thread at a time may use it. Allocates no more than the
// places require, whatever the bytes say.
class ResidualReader {
 public:
  // Reads the bytes. Returns null, or what is wrong, as text that lives as long as the process.
  const char* Read(std::string_view bytes, std::size_t places, ZstdDecoder& zstd);
  // Copies the residuals to `steps`, four values per place. Returns as Read. Requires: Read succeeded.
  const char* Unpack(PaddedSteps& steps) const;

 private:
  std::vector<std::uint8_t> pairs_;     // of bits, four a byte
  std::vector<std::uint8_t> overflow_;  // varints
  std::size_t places_ = 0;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_RESIDUALS_H_
