#include "server/meshio/msh_values.h"

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace phrenic::meshio {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::size_t Within(std::string_view bytes, std::size_t at) { return std::min(at, bytes.size()); }

}  // namespace

MshValues::MshValues(std::string_view name, std::string_view bytes, std::size_t at, bool binary)
    : name_(name), bytes_(bytes), at_(Within(bytes, at)), word_(at_), binary_(binary) {}

bool MshValues::TakeByteOrder() {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    std::int32_t one = 0;
    if (!ByteReader(name_, bytes_, at_, order).Take(one) || one != 1) continue;
    order_ = order;
    at_ += sizeof(one);
    return true;
  }
  return false;
}

std::string MshValues::Word() {
  word_ = Within(bytes_, bytes_.find_first_not_of(kBlanks, at_));
  at_ = Within(bytes_, bytes_.find_first_of(kBlanks, word_));
  return std::string(bytes_.substr(word_, at_ - word_));
}

std::string_view MshValues::Line() {
  word_ = Within(bytes_, bytes_.find_first_not_of(kBlanks, at_));
  at_ = Within(bytes_, bytes_.find('\n', word_));
  const std::string_view line = bytes_.substr(word_, at_ - word_);
  return line.substr(0, line.find_last_not_of(kBlanks) + 1);
}

bool MshValues::StartBlock() {
  if (!binary_) return true;
  const std::size_t end = bytes_.find_first_not_of(" \t\r", at_);
  if (end == std::string_view::npos || bytes_[end] != '\n') return false;
  at_ = end + 1;
  return true;
}

bool MshValues::TakeUntil(const std::string& end, std::string_view& text) {
  const std::size_t found = bytes_.find("\n" + end, at_);
  if (found == std::string_view::npos) return false;
  text = bytes_.substr(at_, found - at_);
  at_ = found + 1 + end.size();
  return true;
}

absl::Status MshValues::Error(const std::string& message) const {
  if (binary_) return ByteReader(name_, bytes_, at_).Error(message);
  const auto line = 1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(word_), '\n');
  return absl::InvalidArgumentError(absl::StrCat(std::string(name_), ":", line, ": ", message));
}

}  // namespace phrenic::meshio
