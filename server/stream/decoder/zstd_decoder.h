// Decompresses Zstandard frames (RFC 8878) by libzstd, with a context that is kept.
#ifndef PHRENIC_SERVER_STREAM_DECODER_ZSTD_DECODER_H_
#define PHRENIC_SERVER_STREAM_DECODER_ZSTD_DECODER_H_

#include <zstd.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace phrenic::stream {

// Has 0.2 MB. One thread at a time may use it.
class ZstdDecoder {
 public:
  // Decompresses one frame to `to`, which it fills exactly. Returns null, or what is wrong, as text that lives as long
  // as the process. Any bytes may be given. No bytes are an empty frame.
  const char* Decompress(std::string_view frame, std::span<std::uint8_t> to);

  // Returns the decompressed size that the frame states; nothing if it states none or is no frame.
  static std::optional<std::uint64_t> StatedSize(std::string_view frame);

 private:
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };

  std::unique_ptr<ZSTD_DCtx, Free> context_{ZSTD_createDCtx()};
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_ZSTD_DECODER_H_
