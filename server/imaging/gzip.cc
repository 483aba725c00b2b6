#include "server/imaging/gzip.h"

#include <zlib.h>

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace phrenic::imaging {
namespace {

constexpr int kGzip = 15 + 16;             // zlib's window bits for gzip alone
constexpr std::size_t kPortion = 1 << 18;  // [bytes]

Bytef* Bytes(const char* text) { return reinterpret_cast<Bytef*>(const_cast<char*>(text)); }

// Takes in at most as much as zlib's counters hold.
uInt Portion(std::size_t bytes) { return static_cast<uInt>(std::min<std::size_t>(bytes, 1 << 30)); }

}  // namespace

bool IsGzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

absl::StatusOr<std::string> Inflate(std::string_view name, std::string_view bytes, std::size_t most) {
  z_stream stream{};
  inflateInit2(&stream, kGzip);
  std::string out, portion(std::min(kPortion, most + 1), '\0');
  int state = Z_OK;
  while (state == Z_OK && out.size() <= most) {
    const std::size_t taken = stream.total_in;
    stream.next_in = Bytes(bytes.data() + taken);
    stream.avail_in = Portion(bytes.size() - taken);
    stream.next_out = Bytes(portion.data());
    stream.avail_out = Portion(portion.size());
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(portion, 0, portion.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  const bool enough = out.size() > most;
  out.resize(std::min(out.size(), most));
  if (state == Z_STREAM_END || (state == Z_OK && enough)) return out;
  return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": the gzip data is ",
                                                 state == Z_BUF_ERROR ? "cut off" : "damaged", " after ", out.size(),
                                                 " bytes of what it holds; fetch the file again"));
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
