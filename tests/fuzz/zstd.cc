// Frames that the decoder and libzstd both decompress have the same bytes. The decoder refuses some that libzstd does
// not: damaged ones with bits too few or too many. The first two bytes are the size.
#include <zstd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "server/stream/decoder/zstd_decoder.h"

namespace {

// True if the bytes are one frame of data that libzstd decompresses to `to`.
bool LibzstdDecompresses(const std::uint8_t* frame, std::size_t size, std::vector<std::uint8_t>& to) {
  if (size < 5 || frame[0] != 0x28 || ZSTD_findFrameCompressedSize(frame, size) != size) return false;
  const std::size_t done = ZSTD_decompress(to.data(), to.size(), frame, size);
  return ZSTD_isError(done) == 0 && done == to.size();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static auto& decoder = *new phrenic::stream::ZstdDecoder();
  if (size < 2) return 0;
  std::vector<std::uint8_t> expected(data[0] + 256U * data[1]), got(expected.size(), 0xa5);
  const std::string_view frame(reinterpret_cast<const char*>(data) + 2, size - 2);
  const char* const problem = decoder.Decompress(frame, got);
  if (problem != nullptr || !LibzstdDecompresses(data + 2, size - 2, expected)) return 0;
  if (got != expected) std::abort();
  return 0;
}
