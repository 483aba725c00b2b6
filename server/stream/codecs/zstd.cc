#include "server/stream/codecs/zstd.h"

#include <zstd.h>

#include <memory>

#include "absl/strings/str_cat.h"

namespace phrenic::stream {
namespace {

constexpr int kLevel = 1;  // the residuals are noise: higher levels compress no better

struct Free {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

}  // namespace

std::size_t AppendCompressed(std::string_view bytes, std::string& compressed) {
  // A context has 0.5 MB: one per compressing thread.
  thread_local const std::unique_ptr<ZSTD_CCtx, Free> context(ZSTD_createCCtx());
  const std::size_t before = compressed.size();
  compressed.resize(before + ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compressCCtx(context.get(), compressed.data() + before, compressed.size() - before,
                                             bytes.data(), bytes.size(), kLevel);
  compressed.resize(before + size);  // cannot fail: the buffer and the level are valid
  return size;
}

absl::StatusOr<std::string> Decompress(std::string_view compressed, std::size_t size) {
  std::string bytes(size, '\0');
  const std::size_t got = ZSTD_decompress(bytes.data(), size, compressed.data(), compressed.size());
  if (ZSTD_isError(got)) return absl::InvalidArgumentError(absl::StrCat("zstd: ", ZSTD_getErrorName(got)));
  if (got != size) return absl::InvalidArgumentError(absl::StrCat("zstd: ", got, " bytes instead of ", size));
  return bytes;
}

}  // namespace phrenic::stream
