#include "server/meshio/vtk_arrays.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "server/meshio/bytes.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

constexpr std::string_view kWhite = " \t\r\n";
constexpr std::size_t kTriple = 3, kQuadruple = 4;  // base64: bytes, characters

absl::Status Truncated() { return absl::InvalidArgumentError("an array ends early: the file is truncated or damaged"); }

// Reads bytes from the front of raw or base64 data.
class EncodedBytes {
 public:
  EncodedBytes(std::string_view from, bool base64) : from_(from), base64_(base64) {}

  // Decodes whole base64 groups: one call reads what the writer encoded at once.
  absl::StatusOr<std::string> Take(std::size_t count) {
    const std::size_t width = base64_ ? (count + kTriple - 1) / kTriple * kQuadruple : count;
    if (count > from_.size() || width > from_.size()) return Truncated();
    const std::string_view taken = from_.substr(0, width);
    from_.remove_prefix(width);
    if (!base64_) return std::string(taken);
    std::string bytes;
    if (!absl::Base64Unescape(absl::string_view(taken.data(), taken.size()), &bytes) || bytes.size() < count)
      return Truncated();
    bytes.resize(count);
    return bytes;
  }

 private:
  std::string_view from_;
  const bool base64_;
};

bool TakeWord(const VtkEncoding& encoding, ByteReader& reader, std::uint64_t& word) {
  if (encoding.wide_header) return reader.Take(word);
  std::uint32_t narrow = 0;
  const bool taken = reader.Take(narrow);
  word = narrow;
  return taken;
}

absl::StatusOr<std::vector<std::uint64_t>> TakeWords(std::size_t count, const VtkEncoding& encoding,
                                                     EncodedBytes& packed) {
  const auto bytes = packed.Take(count * (encoding.wide_header ? sizeof(std::uint64_t) : sizeof(std::uint32_t)));
  if (!bytes.ok()) return bytes.status();
  ByteReader reader("", *bytes, 0, encoding.order);
  std::vector<std::uint64_t> words(count);
  for (std::uint64_t& word : words) TakeWord(encoding, reader, word);
  return words;
}

absl::Status UnpackedTooLarge(const VtkEncoding& encoding) {
  return absl::InvalidArgumentError(
      absl::StrCat("an array declares an uncompressed size above ", encoding.max_unpacked,
                   " bytes, implausible for the file's size; save it without compression"));
}

// Reads an uncompressed array: its length in bytes, then the bytes.
absl::StatusOr<std::string> TakePlain(std::string_view from, bool base64, const VtkEncoding& encoding) {
  EncodedBytes header(from, base64);
  const auto length = TakeWords(1, encoding, header);
  if (!length.ok()) return length.status();
  if (length->front() > from.size()) return Truncated();
  const std::size_t word = encoding.wide_header ? sizeof(std::uint64_t) : sizeof(std::uint32_t);
  auto all = EncodedBytes(from, base64).Take(word + length->front());  // header and data are one base64 run
  if (all.ok()) all->erase(0, word);
  return all;
}

absl::Status Inflate(const std::string& block, std::size_t size, std::string& bytes) {
  const std::size_t before = bytes.size();
  bytes.resize(before + size);
  uLongf got = size;
  const int code = uncompress(reinterpret_cast<Bytef*>(bytes.data() + before), &got,
                              reinterpret_cast<const Bytef*>(block.data()), block.size());
  if (code == Z_OK && got == size) return absl::OkStatus();
  return absl::InvalidArgumentError("a compressed array does not inflate to its declared size: the file is damaged");
}

// Reads a zlib-compressed array. Header: number of blocks, uncompressed block size, uncompressed size of a partial last
// block or 0, compressed size of each block. Then the blocks.
absl::StatusOr<std::string> TakeCompressed(std::string_view from, bool base64, const VtkEncoding& encoding) {
  EncodedBytes start(from, base64), packed(from, base64);
  const auto head = TakeWords(3, encoding, start);
  if (!head.ok()) return head.status();
  const std::uint64_t blocks = (*head)[0], size = (*head)[1], last = (*head)[2];
  if (blocks == 0) return std::string();
  if (blocks > from.size() || last > size) return Truncated();
  const double unpacked_size =
      static_cast<double>(blocks - 1) * static_cast<double>(size) + static_cast<double>(last > 0 ? last : size);
  if (unpacked_size > static_cast<double>(encoding.max_unpacked)) return UnpackedTooLarge(encoding);
  const auto sizes = TakeWords(3 + blocks, encoding, packed);
  if (!sizes.ok()) return sizes.status();
  std::uint64_t total = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    if ((*sizes)[3 + block] > from.size()) return Truncated();
    total += (*sizes)[3 + block];
  }
  const auto data = packed.Take(total);
  if (!data.ok()) return data.status();
  std::string bytes;
  std::size_t at = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t unpacked = block + 1 == blocks && last > 0 ? last : size;
    const absl::Status status = Inflate(data->substr(at, (*sizes)[3 + block]), unpacked, bytes);
    if (!status.ok()) return status;
    at += (*sizes)[3 + block];
  }
  return bytes;
}

absl::StatusOr<std::string> TakeBytes(const VtkArray& array, const VtkEncoding& encoding) {
  std::string_view from = array.text;
  bool base64 = true;
  if (array.format == "appended") {
    std::int64_t offset = 0;
    if (!ParseInteger(array.offset, offset) || offset < 0 ||
        offset > static_cast<std::int64_t>(encoding.appended.size())) {
      return absl::InvalidArgumentError("an array's offset is outside the appended data: the file is truncated");
    }
    from = encoding.appended.substr(static_cast<std::size_t>(offset));
    base64 = encoding.appended_base64;
  } else if (array.format != "binary") {
    return absl::InvalidArgumentError(absl::StrCat("unknown format ", Quoted(array.format), " of a data array"));
  }
  from.remove_prefix(base64 ? std::min(from.find_first_not_of(kWhite), from.size()) : 0);
  return encoding.compressed ? TakeCompressed(from, base64, encoding) : TakePlain(from, base64, encoding);
}

template <typename Raw, typename Number>
bool Convert(ByteReader reader, std::vector<Number>& numbers) {
  Raw raw{};
  while (reader.Take(raw)) {
    numbers.push_back(static_cast<Number>(raw));
    if (!std::isfinite(static_cast<double>(raw))) return false;
  }
  return reader.left() == 0;
}

// Return false if the type does not fit, a number is not finite, or bytes remain.
bool ConvertAs(std::string_view type, const ByteReader& reader, std::vector<double>& numbers) {
  if (type == "Float32") return Convert<float>(reader, numbers);
  return type == "Float64" && Convert<double>(reader, numbers);
}

bool ConvertAs(std::string_view type, const ByteReader& reader, std::vector<std::int64_t>& numbers) {
  if (type == "Int64" || type == "UInt64") return Convert<std::int64_t>(reader, numbers);
  if (type == "Int32") return Convert<std::int32_t>(reader, numbers);
  if (type == "UInt32") return Convert<std::uint32_t>(reader, numbers);
  if (type == "Int16") return Convert<std::int16_t>(reader, numbers);
  if (type == "UInt16") return Convert<std::uint16_t>(reader, numbers);
  if (type == "Int8") return Convert<std::int8_t>(reader, numbers);
  return type == "UInt8" && Convert<std::uint8_t>(reader, numbers);
}

bool ParseAs(std::string_view word, double& number) { return ParseNumber(word, number); }
bool ParseAs(std::string_view word, std::int64_t& number) { return ParseInteger(word, number); }

template <typename Number>
absl::StatusOr<std::vector<Number>> ReadText(std::string_view text) {
  std::vector<Number> numbers;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kWhite), text.size()));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(kWhite));
    Number number{};
    if (!ParseAs(word, number)) {
      return absl::InvalidArgumentError(absl::StrCat(Quoted(word), " is not a number of the array's type"));
    }
    numbers.push_back(number);
    text.remove_prefix(word.size());
  }
}

template <typename Number>
absl::StatusOr<std::vector<Number>> Read(const VtkArray& array, const VtkEncoding& encoding) {
  if (array.format == "ascii") return ReadText<Number>(array.text);
  const auto bytes = TakeBytes(array, encoding);
  if (!bytes.ok()) return bytes.status();
  std::vector<Number> numbers;
  if (ConvertAs(array.type, ByteReader("", *bytes, 0, encoding.order), numbers)) return numbers;
  return absl::InvalidArgumentError(absl::StrCat("an array has the unsuitable type ", Quoted(array.type),
                                                 ", a number that is not finite, or excess bytes"));
}

}  // namespace

absl::StatusOr<std::vector<double>> ReadDoubles(const VtkArray& array, const VtkEncoding& encoding) {
  return Read<double>(array, encoding);
}

absl::StatusOr<std::vector<std::int64_t>> ReadIntegers(const VtkArray& array, const VtkEncoding& encoding) {
  return Read<std::int64_t>(array, encoding);
}

}  // namespace phrenic::meshio
