#include "server/stream/decoder/zstd_decoder.h"

namespace phrenic::stream {

const char* ZstdDecoder::Decompress(std::string_view frame, std::span<std::uint8_t> to) {
  if (context_ == nullptr) return "memory is short";
  if (frame.empty()) return to.empty() ? nullptr : "zstd: the frame is cut off";
  if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
    return "zstd: the bytes are not one whole frame";
  }
  constexpr const char* kOtherSize = "zstd: the frame has another size than it should";
  if (StatedSize(frame).value_or(to.size()) != to.size()) return kOtherSize;
  const std::size_t size = ZSTD_decompressDCtx(context_.get(), to.data(), to.size(), frame.data(), frame.size());
  if (ZSTD_isError(size) != 0) return ZSTD_getErrorName(size);
  return size == to.size() ? nullptr : kOtherSize;
}

std::optional<std::uint64_t> ZstdDecoder::StatedSize(std::string_view frame) {
  const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) return std::nullopt;
  return size;
}

}  // namespace phrenic::stream
