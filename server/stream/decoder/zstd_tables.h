// Decoding tables of Zstandard: finite state entropy (FSE) and Huffman codes (RFC 8878, 4.1 and 4.2).
#ifndef PHRENIC_SERVER_STREAM_DECODER_ZSTD_TABLES_H_
#define PHRENIC_SERVER_STREAM_DECODER_ZSTD_TABLES_H_

#include <array>
#include <cstdint>
#include <span>

#include "server/stream/decoder/zstd_bits.h"

namespace phrenic::stream {

// A table of an FSE code with at most 2^9 states.
struct FseTable {
  struct State {
    std::uint16_t next;  // smallest next state
    std::uint8_t bits;   // that are added to it
    std::uint8_t symbol;
  };
  std::array<State, 512> states;
  unsigned log = 0;  // of the number of states

  // A table of the normalised counts, of which -1 is a probability below 1. Requires: counts sum to 2^log, -1 as 1.
  void Make(std::span<const std::int16_t> counts, unsigned accuracy);
  // A table of one symbol that takes no bits.
  void MakeOne(std::uint8_t symbol);
  // Reads a description. Returns its bytes, or 0 if it is invalid. `symbols`: number of symbols that may have a count.
  std::size_t Read(ByteSpan bytes, unsigned max_accuracy, std::size_t symbols);

  std::uint8_t symbol(std::uint32_t state) const { return states[state].symbol; }
  std::uint32_t Next(std::uint32_t state, BackwardBits& bits) const {
    return states[state].next + bits.Read(states[state].bits);
  }
};

// A Huffman code of bytes with at most 11 bits.
class HuffmanTable {
 public:
  // Reads a description. Returns its bytes, or 0 if it is invalid; the table is then empty.
  std::size_t Read(ByteSpan bytes);
  bool empty() const { return log_ == 0; }
  // Decodes one stream into `to`. False unless the stream has exactly so many symbols.
  bool Decode(ByteSpan stream, std::span<std::uint8_t> to) const;
  // Decodes four streams of which the first three have `to.size() + 3) / 4` symbols, and the last the rest.
  bool DecodeFour(ByteSpan streams, std::span<std::uint8_t> to) const;

 private:
  struct Code {
    std::uint8_t symbol, bits;
  };
  static constexpr unsigned kLongest = 11;

  bool Make(std::array<std::uint8_t, 256>& weights, std::size_t count);

  std::array<Code, 1 << kLongest> codes_;
  unsigned log_ = 0;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_ZSTD_TABLES_H_
