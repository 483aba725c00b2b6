#include "server/stream/codecs/zstd.h"

#include <zstd.h>

#include <memory>

#include "absl/strings/str_cat.h"

namespace phrenic::stream {
namespace {

constexpr int kLevel = 1;  // the residuals are noise: higher levels compress no better

constexpr int kSmallLevel = 19;  // a ninth smaller for a page's motion, and 50 times slower

struct Free {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

std::size_t Append(ZSTD_CCtx& context, int level, std::string_view bytes, std::string& compressed) {
  const std::size_t before = compressed.size();
  compressed.resize(before + ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compressCCtx(&context, compressed.data() + before, compressed.size() - before,
                                             bytes.data(), bytes.size(), level);
  compressed.resize(before + size);  // cannot fail: the buffer and the level are valid
  return size;
}

}  // namespace

std::size_t AppendCompressed(std::string_view bytes, std::string& compressed) {
  // A context has 0.5 MB: one per compressing thread.
  thread_local const std::unique_ptr<ZSTD_CCtx, Free> context(ZSTD_createCCtx());
  return Append(*context, kLevel, bytes, compressed);
}

std::string CompressSmall(std::string_view bytes) {
  // A context of this level has up to 90 MB.
  const std::unique_ptr<ZSTD_CCtx, Free> context(ZSTD_createCCtx());
  std::string compressed;
  Append(*context, kSmallLevel, bytes, compressed);
  return compressed;
}

absl::StatusOr<std::string> Decompress(std::string_view compressed, std::size_t size) {
  std::string bytes(size, '\0');
  const std::size_t got = ZSTD_decompress(bytes.data(), size, compressed.data(), compressed.size());
  if (ZSTD_isError(got))
    return absl::InvalidArgumentError(absl::StrCat("zstd: ", ZSTD_getErrorName(got), "; fetch the bytes again"));
  if (got != size) {
    return absl::InvalidArgumentError(
        absl::StrCat("zstd: ", got, " bytes instead of ", size, "; fetch the bytes again"));
  }
  return bytes;
}

}  // namespace phrenic::stream
