#include "server/imaging/gzip.h"

#include <zlib.h>

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace phrenic::imaging {
namespace {

constexpr int kGzip = 15 + 16;             // zlib's windowBits for the gzip format
constexpr int kRaw = -15;                  // and for deflate data alone
constexpr std::size_t kPortion = 1 << 18;  // output buffer [bytes]

Bytef* Bytes(const char* text) { return reinterpret_cast<Bytef*>(const_cast<char*>(text)); }

// Limits an input to what zlib's counters hold.
uInt Portion(std::size_t bytes) { return static_cast<uInt>(std::min<std::size_t>(bytes, 1 << 30)); }

absl::StatusOr<std::string> InflateBy(int window_bits, std::string_view name, std::string_view bytes,
                                      std::size_t max_bytes) {
  z_stream stream{};
  inflateInit2(&stream, window_bits);
  std::string out, portion(std::min(kPortion, max_bytes + 1), '\0');
  int state = Z_OK;
  while (state == Z_OK && out.size() <= max_bytes) {
    const std::size_t taken = stream.total_in;
    stream.next_in = Bytes(bytes.data() + taken);
    stream.avail_in = Portion(bytes.size() - taken);
    stream.next_out = Bytes(portion.data());
    stream.avail_out = Portion(portion.size());
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(portion, 0, portion.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  const bool complete = out.size() > max_bytes;
  out.resize(std::min(out.size(), max_bytes));
  if (state == Z_STREAM_END || (state == Z_OK && complete)) return out;
  return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": the ", window_bits == kRaw ? "deflate" : "gzip",
                                                 " data is ", state == Z_BUF_ERROR ? "truncated" : "damaged", " after ",
                                                 out.size(), " uncompressed bytes; download the file again"));
}

}  // namespace

bool IsGzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

absl::StatusOr<std::string> Inflate(std::string_view name, std::string_view bytes, std::size_t max_bytes) {
  return InflateBy(kGzip, name, bytes, max_bytes);
}

absl::StatusOr<std::string> InflateRaw(std::string_view name, std::string_view bytes, std::size_t max_bytes) {
  return InflateBy(kRaw, name, bytes, max_bytes);
}

std::string Deflate(std::string_view bytes) {
  z_stream stream{};
  constexpr int kLevel = 6, kMemory = 8;
  deflateInit2(&stream, kLevel, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY);
  std::string out, portion(kPortion, '\0');
  int state = Z_OK;
  while (state == Z_OK) {
    const std::size_t taken = stream.total_in;
    stream.next_in = Bytes(bytes.data() + taken);
    stream.avail_in = Portion(bytes.size() - taken);
    stream.next_out = Bytes(portion.data());
    stream.avail_out = Portion(portion.size());
    state = deflate(&stream, stream.avail_in == bytes.size() - taken ? Z_FINISH : Z_NO_FLUSH);
    out.append(portion, 0, portion.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  return out;
}

}  // namespace phrenic::imaging
