#include "server/stream/decoder/zstd_tables.h"

namespace phrenic::stream {
namespace {

constexpr unsigned kWeightsAccuracy = 6;
constexpr std::size_t kMostWeights = 255;  // that are written; one more follows from them

unsigned HighBit(std::uint32_t value) { return 31U - static_cast<unsigned>(std::countl_zero(value)); }

// Reads Huffman weights that are compressed by FSE, with two states in turn. Returns their number, 0 if invalid.
std::size_t ReadFseWeights(ByteSpan bytes, std::array<std::uint8_t, 256>& weights) {
  FseTable table;
  const std::size_t head = table.Read(bytes, kWeightsAccuracy, weights.size());
  BackwardBits bits;
  if (head == 0 || !bits.Start(bytes.subspan(head))) return 0;
  std::uint32_t state = bits.Read(table.log), other = bits.Read(table.log);
  bits.Reload();
  if (bits.Overflowed()) return 0;
  for (std::size_t count = 0; count + 1 < kMostWeights;) {
    weights[count++] = table.symbol(state);
    state = table.Next(state, bits);
    if (bits.Overflowed()) {
      weights[count++] = table.symbol(other);
      return count;
    }
    bits.Reload();
    std::swap(state, other);
  }
  return 0;
}

// Two weights a byte, the first in the high bits.
void ReadPlainWeights(ByteSpan bytes, std::size_t count, std::array<std::uint8_t, 256>& weights) {
  for (std::size_t i = 0; i < count; ++i) weights[i] = bytes[i / 2] >> (i % 2 == 0 ? 4 : 0) & 15;
}

}  // namespace

void FseTable::Make(std::span<const std::int16_t> counts, unsigned accuracy) {
  log = accuracy;
  const std::uint32_t size = 1U << log;
  std::uint32_t high = size;  // states from here on have symbols of probability below 1
  std::array<std::uint16_t, 256> next;
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
    next[symbol] = static_cast<std::uint16_t>(counts[symbol] < 0 ? 1 : counts[symbol]);
    if (counts[symbol] < 0) states[--high].symbol = static_cast<std::uint8_t>(symbol);
  }
  const std::uint32_t step = size / 2 + size / 8 + 3;
  std::uint32_t at = 0;
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
    for (std::int16_t i = 0; i < counts[symbol]; ++i) {
      states[at].symbol = static_cast<std::uint8_t>(symbol);
      do at = (at + step) & (size - 1);
      while (at >= high);
    }
  }
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t state = next[states[i].symbol]++;
    const unsigned bits = log - HighBit(state);
    states[i].bits = static_cast<std::uint8_t>(bits);
    states[i].next = static_cast<std::uint16_t>((state << bits) - size);
  }
}

void FseTable::MakeOne(std::uint8_t symbol) {
  log = 0;
  states[0] = {.next = 0, .bits = 0, .symbol = symbol};
}

std::size_t FseTable::Read(ByteSpan bytes, unsigned max_accuracy, std::size_t symbols) {
  ForwardBits bits(bytes);
  const unsigned accuracy = bits.Read(4) + 5;
  if (accuracy > max_accuracy) return 0;
  std::array<std::int16_t, 256> counts;
  std::size_t count = 0;
  std::int32_t left = 1 << accuracy;
  while (left > 0) {
    if (count == symbols || bits.bytes_read() > bytes.size()) return 0;
    // Values up to the number that remains: smaller ones take one bit less where that leaves codes for all.
    const unsigned width = HighBit(static_cast<std::uint32_t>(left) + 1) + 1;
    const std::int32_t low = (1 << (width - 1)) - 1, spare = (1 << width) - 2 - left;
    auto value = static_cast<std::int32_t>(bits.Read(width));
    if ((value & low) < spare) {
      bits.Unread(1);
      value &= low;
    } else if (value > low) {
      value -= spare;
    }
    counts[count++] = static_cast<std::int16_t>(value - 1);
    left -= value == 0 ? 1 : value - 1;
    if (value != 1) continue;
    for (std::uint32_t zeros = 3; zeros == 3;) {
      zeros = bits.Read(2);
      if (count + zeros > symbols) return 0;
      for (std::uint32_t i = 0; i < zeros; ++i) counts[count++] = 0;
    }
  }
  if (left != 0 || bits.bytes_read() > bytes.size()) return 0;
  Make({counts.data(), count}, accuracy);
  return bits.bytes_read();
}

std::size_t HuffmanTable::Read(ByteSpan bytes) {
  log_ = 0;
  if (bytes.empty()) return 0;
  std::array<std::uint8_t, 256> weights{};
  std::size_t size = bytes[0], count = 0;
  if (size < 128) {
    if (size >= bytes.size()) return 0;
    count = ReadFseWeights(bytes.subspan(1, size), weights);
  } else {
    count = size - 127;
    size = (count + 1) / 2;
    if (size >= bytes.size()) return 0;
    ReadPlainWeights(bytes.subspan(1), count, weights);
  }
  return count > 0 && Make(weights, count) ? size + 1 : 0;
}

bool HuffmanTable::Make(std::array<std::uint8_t, 256>& weights, std::size_t count) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (weights[i] > kLongest) return false;
    if (weights[i] > 0) sum += 1U << (weights[i] - 1);
  }
  if (sum == 0) return false;
  const unsigned log = HighBit(sum) + 1;
  const std::uint32_t left = (1U << log) - sum;  // of the last symbol
  if (log > kLongest || !std::has_single_bit(left)) return false;
  weights[count++] = static_cast<std::uint8_t>(HighBit(left) + 1);
  std::uint32_t at = 0;
  for (unsigned weight = 1; weight <= log; ++weight) {
    for (std::size_t symbol = 0; symbol < count; ++symbol) {
      if (weights[symbol] != weight) continue;
      const Code code = {.symbol = static_cast<std::uint8_t>(symbol),
                         .bits = static_cast<std::uint8_t>(log + 1 - weight)};
      for (std::uint32_t i = 0; i < 1U << (weight - 1); ++i) codes_[at++] = code;
    }
  }
  log_ = log;
  return true;
}

bool HuffmanTable::Decode(ByteSpan stream, std::span<std::uint8_t> to) const {
  BackwardBits bits;
  if (!bits.Start(stream)) return false;
  std::size_t i = 0;
  const auto one = [&] {
    const Code code = codes_[bits.Peek(log_)];
    bits.Take(code.bits);
    to[i++] = code.symbol;
  };
  while (i + 4 <= to.size()) {  // at most 44 bits
    bits.Reload();
    if (bits.Overflowed()) return false;
    one(), one(), one(), one();
  }
  bits.Reload();
  while (i < to.size()) one();
  bits.Reload();
  return bits.Finished();
}

bool HuffmanTable::DecodeFour(ByteSpan streams, std::span<std::uint8_t> to) const {
  constexpr std::size_t kSizes = 6;
  if (streams.size() < kSizes) return false;
  const std::size_t part = (to.size() + 3) / 4;
  if (3 * part > to.size()) return false;
  std::size_t at = kSizes;
  for (std::size_t i = 0; i < 4; ++i) {
    std::size_t size = streams.size() - at;
    if (i < 3) {
      const std::size_t stated = streams[2 * i] + 256U * streams[2 * i + 1];
      if (stated > size) return false;
      size = stated;
    }
    const std::size_t count = i < 3 ? part : to.size() - 3 * part;
    if (!Decode(streams.subspan(at, size), to.subspan(i * part, count))) return false;
    at += size;
  }
  return true;
}

}  // namespace phrenic::stream
