#include "client/files/part_file.h"

#include <cstdio>

#include "absl/strings/str_cat.h"
#include "client/files/whole_file.h"

namespace phrenic::client {

PartFile::PartFile(const std::string& file, bool keep)
    : device_(IsDevice(file)), file_(file), part_(device_ ? file : file + ".part"), keep_(keep && !device_) {
  if (keep_) ReadExistingPart();
  out_.open(part_, bytes_ > 0 ? std::ios::binary | std::ios::app : std::ios::binary | std::ios::trunc);
}

PartFile::~PartFile() {
  out_.close();
  if (!device_ && (!keep_ || damaged_)) std::remove(part_.c_str());
}

void PartFile::ReadExistingPart() {
  std::ifstream in(part_, std::ios::binary);
  std::string block(std::size_t{1} << 20, '\0');
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    hash_.Add({block.data(), static_cast<std::size_t>(in.gcount())});
    bytes_ += in.gcount();
  }
}

absl::Status PartFile::Write(const std::string& bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  hash_.Add(bytes);
  bytes_ += static_cast<std::int64_t>(bytes.size());
  return out_ ? absl::OkStatus() : Error();
}

absl::Status PartFile::Error() const {
  return absl::DataLossError(
      absl::StrCat("cannot write ", part_, ": check that its folder exists and that the disk is not full"));
}

absl::Status PartFile::Finish(const std::string& sha256) {
  out_.close();
  if (!out_) return Error();
  damaged_ = hash_.Hex() != sha256;
  if (damaged_) return absl::DataLossError(absl::StrCat(file_, " was damaged in transit: try again"));
  if (device_ || std::rename(part_.c_str(), file_.c_str()) == 0) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("cannot rename ", part_, " to ", file_));
}

}  // namespace phrenic::client
