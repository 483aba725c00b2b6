// Decompresses Zstandard frames (RFC 8878) without libzstd, so that browsers run the same code as the server: Debian
// has libzstd for WebAssembly neither compiled nor as a package of its sources. tests/fuzz/zstd.cc compares it with
// libzstd.
#ifndef PHRENIC_SERVER_STREAM_DECODER_ZSTD_DECODER_H_
#define PHRENIC_SERVER_STREAM_DECODER_ZSTD_DECODER_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "server/stream/decoder/zstd_tables.h"

namespace phrenic::stream {

// Decodes all of the format but dictionaries; skips the checksum. Has 0.2 MB. One thread at a time may use it.
class ZstdDecoder {
 public:
  // Decompresses one frame to `to`, which it fills exactly. Returns null, or what is wrong, as text that lives as long
  // as the process. Any bytes may be given. No bytes are an empty frame.
  const char* Decompress(std::string_view frame, std::span<std::uint8_t> to);

  // Returns the decompressed size that the frame states; nothing if it states none or is no frame.
  static std::optional<std::uint64_t> StatedSize(std::string_view frame);

 private:
  static constexpr std::size_t kLargestBlock = 128 << 10;

  // A code that sequences use, and whether a former block of the frame has set it.
  struct SequenceCode {
    FseTable table;
    bool known = false;
  };

  const char* DecompressBlocks(ByteSpan blocks, bool checksum);
  // Both read a part of a compressed block and remove it from `block`.
  const char* ReadLiterals(ByteSpan& block);
  const char* ReadHuffmanLiterals(ByteSpan& block);
  const char* ReadSequences(ByteSpan block);
  const char* ReadCode(unsigned mode, int which, ByteSpan& block, SequenceCode& code);
  const char* Execute(ByteSpan stream, std::uint32_t count);
  std::uint32_t OffsetOf(std::uint32_t value, bool no_literals);
  bool CopyLiterals(std::size_t count);
  bool CopyMatch(std::size_t offset, std::size_t count);
  bool Append(ByteSpan bytes);

  std::span<std::uint8_t> to_;
  std::size_t done_ = 0;  // bytes of `to_`
  HuffmanTable huffman_;
  std::array<SequenceCode, 3> codes_;  // literal lengths, offsets, match lengths
  std::array<std::uint32_t, 3> offsets_ = {1, 4, 8};
  ByteSpan literals_;  // of the block that are not copied yet
  std::array<std::uint8_t, kLargestBlock> buffer_;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_ZSTD_DECODER_H_
