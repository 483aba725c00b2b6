#include "server/stream/decoder/zstd_decoder.h"

#include <algorithm>
#include <cstring>

namespace phrenic::stream {
namespace {

constexpr std::uint32_t kMagic = 0xFD2FB528;
constexpr std::size_t kBlockHead = 3, kChecksum = 4;

constexpr const char* kCutOff = "zstd: the frame is cut off";
constexpr const char* kDamaged = "zstd: the frame is damaged";
constexpr const char* kSize = "zstd: the frame has another size than it should";

// Little-endian. Requires: count <= 8 and that many bytes.
std::uint64_t NumberOf(ByteSpan bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= static_cast<std::uint64_t>(bytes[i]) << 8 * i;
  return value;
}

ByteSpan BytesOf(std::string_view text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

struct FrameHead {
  std::size_t size = 0;  // bytes of the head
  bool checksum = false;
  std::optional<std::uint64_t> content;  // bytes of the content
};

// Nothing if the bytes are not the start of a frame, or the frame needs a dictionary.
std::optional<FrameHead> ReadHead(ByteSpan bytes) {
  if (bytes.size() < 5 || NumberOf(bytes, 4) != kMagic) return std::nullopt;
  const unsigned descriptor = bytes[4];
  const bool single = (descriptor & 0x20) != 0;
  if ((descriptor & 8) != 0) return std::nullopt;
  constexpr std::array<std::size_t, 4> kDictionary = {0, 1, 2, 4}, kContent = {0, 2, 4, 8};
  const std::size_t dictionary = kDictionary[descriptor & 3];
  const std::size_t content = descriptor >> 6 == 0 && single ? 1 : kContent[descriptor >> 6];
  const std::size_t before = 5 + (single ? 0 : 1);
  FrameHead head{.size = before + dictionary + content, .checksum = (descriptor & 4) != 0, .content = {}};
  if (bytes.size() < head.size || NumberOf(bytes.subspan(before), dictionary) != 0) return std::nullopt;
  const std::uint64_t stated = NumberOf(bytes.subspan(before + dictionary), content);
  if (content > 0) head.content = stated + (content == 2 ? 256 : 0);
  return head;
}

// A length is a base and some bits more (RFC 8878, 3.1.1.3.2.1.1).
struct Length {
  std::uint32_t base;
  std::uint8_t bits;
};
constexpr std::size_t kLiteralCodes = 36, kOffsetCodes = 32, kMatchCodes = 53;

constexpr auto kLiteralLengths = [] {
  std::array<Length, kLiteralCodes> lengths{};
  constexpr std::array<std::uint8_t, 20> kBits = {1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
  for (std::uint32_t i = 0; i < 16; ++i) lengths[i] = {i, 0};
  std::uint32_t base = 16;
  for (std::size_t i = 0; i < kBits.size(); ++i) {
    lengths[16 + i] = {base, kBits[i]};
    base += 1U << kBits[i];
  }
  return lengths;
}();
static_assert(kLiteralLengths[24].base == 48 && kLiteralLengths[25].base == 64 && kLiteralLengths[35].base == 65536);

constexpr auto kMatchLengths = [] {
  std::array<Length, kMatchCodes> lengths{};
  constexpr std::array<std::uint8_t, 21> kBits = {1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
  for (std::uint32_t i = 0; i < 32; ++i) lengths[i] = {i + 3, 0};
  std::uint32_t base = 35;
  for (std::size_t i = 0; i < kBits.size(); ++i) {
    lengths[32 + i] = {base, kBits[i]};
    base += 1U << kBits[i];
  }
  return lengths;
}();
static_assert(kMatchLengths[42].base == 99 && kMatchLengths[43].base == 131 && kMatchLengths[52].base == 65539);

// The codes that a block may use without describing them (RFC 8878, 3.1.1.3.2.2).
constexpr std::array<std::int16_t, 36> kLiteralCounts = {4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1,  1,  2,  2,
                                                         2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1, -1, -1, -1, -1};
constexpr std::array<std::int16_t, 29> kOffsetCounts = {1, 1, 1, 1, 1, 1, 2, 2, 2, 1,  1,  1,  1,  1, 1,
                                                        1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1};
constexpr std::array<std::int16_t, 53> kMatchCounts = {1, 4, 3, 2, 2, 2, 2, 2, 2, 1, 1,  1,  1,  1,  1,  1,  1, 1,
                                                       1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,  1,  1,  1,  1,  1,  1, 1,
                                                       1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1, -1};

// What a code may be, by its index: literal lengths, offsets, match lengths.
struct CodeKind {
  std::size_t symbols;
  unsigned accuracy;
  std::span<const std::int16_t> counts;
  unsigned counts_accuracy;
};
constexpr std::array<CodeKind, 3> kKinds = {
    {{kLiteralCodes, 9, kLiteralCounts, 6}, {kOffsetCodes, 8, kOffsetCounts, 5}, {kMatchCodes, 9, kMatchCounts, 6}}};

}  // namespace

std::optional<std::uint64_t> ZstdDecoder::StatedSize(std::string_view frame) {
  const auto head = ReadHead(BytesOf(frame));
  return head.has_value() ? head->content : std::nullopt;
}

const char* ZstdDecoder::Decompress(std::string_view frame, std::span<std::uint8_t> to) {
  if (frame.empty()) return to.empty() ? nullptr : kSize;
  const ByteSpan bytes = BytesOf(frame);
  const auto head = ReadHead(bytes);
  if (!head.has_value()) return "zstd: the bytes are no frame, or one that needs a dictionary";
  if (head->content.has_value() && *head->content != to.size()) return kSize;
  to_ = to;
  done_ = 0;
  huffman_ = HuffmanTable();
  for (SequenceCode& code : codes_) code.known = false;
  offsets_ = {1, 4, 8};
  const char* const problem = DecompressBlocks(bytes.subspan(head->size), head->checksum);
  return problem == nullptr && done_ != to_.size() ? kSize : problem;
}

const char* ZstdDecoder::DecompressBlocks(ByteSpan blocks, bool checksum) {
  for (bool last = false; !last;) {
    if (blocks.size() < kBlockHead) return kCutOff;
    const auto head = static_cast<std::uint32_t>(NumberOf(blocks, kBlockHead));
    blocks = blocks.subspan(kBlockHead);
    last = (head & 1) != 0;
    const unsigned kind = head >> 1 & 3;
    const std::size_t size = head >> 3, taken = kind == 1 ? 1 : size;
    if (kind == 3 || size > kLargestBlock) return kDamaged;
    if (taken > blocks.size()) return kCutOff;
    ByteSpan block = blocks.first(taken);
    blocks = blocks.subspan(taken);
    if (kind == 0 && !Append(block)) return kSize;
    if (kind == 1) {
      if (size > to_.size() - done_) return kSize;
      std::fill_n(to_.begin() + static_cast<std::ptrdiff_t>(done_), size, block[0]);
      done_ += size;
    }
    if (kind != 2) continue;
    if (const char* problem = ReadLiterals(block)) return problem;
    if (const char* problem = ReadSequences(block)) return problem;
  }
  return blocks.size() == (checksum ? kChecksum : 0) ? nullptr : kDamaged;
}

const char* ZstdDecoder::ReadLiterals(ByteSpan& block) {
  if (block.empty()) return kCutOff;
  const unsigned kind = block[0] & 3, format = block[0] >> 2 & 3;
  if (kind >= 2) return ReadHuffmanLiterals(block);
  const std::size_t head = (format & 1) == 0 ? 1 : format == 1 ? 2 : 3;
  if (block.size() < head) return kCutOff;
  const std::size_t size = NumberOf(block, head) >> (head == 1 ? 3 : 4);
  const std::size_t taken = kind == 0 ? size : 1;
  block = block.subspan(head);
  if (size > kLargestBlock) return kDamaged;
  if (taken > block.size()) return kCutOff;
  literals_ = block.first(taken);
  if (kind == 1) {
    std::fill_n(buffer_.begin(), size, block[0]);
    literals_ = ByteSpan(buffer_).first(size);
  }
  block = block.subspan(taken);
  return nullptr;
}

const char* ZstdDecoder::ReadHuffmanLiterals(ByteSpan& block) {
  const unsigned kind = block[0] & 3, format = block[0] >> 2 & 3;
  const std::size_t head = format < 2 ? 3 : format + 2;
  const unsigned width = format < 2 ? 10 : format == 2 ? 14 : 18;
  if (block.size() < head) return kCutOff;
  const std::uint64_t sizes = NumberOf(block, head) >> 4, mask = (1U << width) - 1;
  const std::size_t size = sizes & mask, compressed = sizes >> width & mask;
  block = block.subspan(head);
  if (size > kLargestBlock) return kDamaged;
  if (compressed > block.size()) return kCutOff;
  ByteSpan streams = block.first(compressed);
  block = block.subspan(compressed);
  if (kind == 2) {
    const std::size_t described = huffman_.Read(streams);
    if (described == 0) return kDamaged;
    streams = streams.subspan(described);
  }
  const std::span<std::uint8_t> to(buffer_.data(), size);
  if (huffman_.empty()) return kDamaged;
  if (!(format == 0 ? huffman_.Decode(streams, to) : huffman_.DecodeFour(streams, to))) return kDamaged;
  literals_ = to;
  return nullptr;
}

const char* ZstdDecoder::ReadSequences(ByteSpan block) {
  if (block.empty()) return kCutOff;
  const std::size_t head = block[0] < 128 ? 1 : block[0] < 255 ? 2 : 3;
  if (block.size() < head) return kCutOff;
  std::uint32_t count = block[0];
  if (head == 2) count = (count - 128) * 256 + block[1];
  if (head == 3) count = static_cast<std::uint32_t>(NumberOf(block.subspan(1), 2)) + 0x7F00;
  block = block.subspan(head);
  if (count == 0) return block.empty() && CopyLiterals(literals_.size()) ? nullptr : kDamaged;
  if (block.empty()) return kCutOff;
  const unsigned modes = block[0];
  if ((modes & 3) != 0) return kDamaged;
  block = block.subspan(1);
  for (int which = 0; which < 3; ++which) {
    if (const char* problem = ReadCode(modes >> (6 - 2 * which) & 3, which, block, codes_[which])) return problem;
  }
  return Execute(block, count);
}

const char* ZstdDecoder::ReadCode(unsigned mode, int which, ByteSpan& block, SequenceCode& code) {
  const CodeKind& kind = kKinds[which];
  if (mode == 3) return code.known ? nullptr : kDamaged;
  code.known = false;
  std::size_t taken = 0;
  if (mode == 0) code.table.Make(kind.counts, kind.counts_accuracy);
  if (mode == 1) {
    if (block.empty()) return kCutOff;
    if (block[0] >= kind.symbols) return kDamaged;
    code.table.MakeOne(block[0]);
    taken = 1;
  }
  if (mode == 2) {
    taken = code.table.Read(block, kind.accuracy, kind.symbols);
    if (taken == 0) return kDamaged;
  }
  block = block.subspan(taken);
  code.known = true;
  return nullptr;
}

const char* ZstdDecoder::Execute(ByteSpan stream, std::uint32_t count) {
  BackwardBits bits;
  if (!bits.Start(stream)) return kDamaged;
  const auto& [literal, offset, match] = codes_;
  std::uint32_t l = bits.Read(literal.table.log), o = bits.Read(offset.table.log), m = bits.Read(match.table.log);
  for (std::uint32_t i = 0; i < count; ++i) {
    bits.Reload();
    const std::uint8_t far = offset.table.symbol(o);
    const std::uint32_t distance = (1U << far) + bits.Read(far);
    bits.Reload();
    const Length& matched = kMatchLengths[match.table.symbol(m)];
    const std::size_t matches = matched.base + bits.Read(matched.bits);
    const Length& copied = kLiteralLengths[literal.table.symbol(l)];
    const std::size_t literals = copied.base + bits.Read(copied.bits);
    if (i + 1 < count) {
      bits.Reload();
      l = literal.table.Next(l, bits);
      m = match.table.Next(m, bits);
      o = offset.table.Next(o, bits);
    }
    if (bits.Overflowed() || !CopyLiterals(literals) || !CopyMatch(OffsetOf(distance, literals == 0), matches)) {
      return kDamaged;
    }
  }
  bits.Reload();
  return bits.Finished() && CopyLiterals(literals_.size()) ? nullptr : kDamaged;
}

// Values of 1 to 3 repeat one of the last three offsets, or the one before it where no literals come first.
std::uint32_t ZstdDecoder::OffsetOf(std::uint32_t value, bool no_literals) {
  auto& [first, second, third] = offsets_;
  if (value > 3) {
    third = second, second = first, first = value - 3;
    return first;
  }
  const std::uint32_t which = value - 1 + (no_literals ? 1 : 0);
  if (which == 0) return first;
  const std::uint32_t offset = which == 1 ? second : which == 2 ? third : first - 1;
  if (which > 1) third = second;
  second = first, first = offset;
  return first;
}

bool ZstdDecoder::CopyLiterals(std::size_t count) {
  if (count > literals_.size() || !Append(literals_.first(count))) return false;
  literals_ = literals_.subspan(count);
  return true;
}

bool ZstdDecoder::CopyMatch(std::size_t offset, std::size_t count) {
  if (offset == 0 || offset > done_ || count > to_.size() - done_) return false;
  std::uint8_t* const at = to_.data() + done_;
  const std::uint8_t* const from = at - offset;
  if (offset >= count) {
    std::memcpy(at, from, count);
  } else {
    for (std::size_t i = 0; i < count; ++i) at[i] = from[i];  // repeats what it has written
  }
  done_ += count;
  return true;
}

bool ZstdDecoder::Append(ByteSpan bytes) {
  if (bytes.size() > to_.size() - done_) return false;
  if (!bytes.empty()) std::memcpy(to_.data() + done_, bytes.data(), bytes.size());
  done_ += bytes.size();
  return true;
}

}  // namespace phrenic::stream
