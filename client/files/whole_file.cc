#include "client/files/whole_file.h"

#include <cstdio>
#include <fstream>

#include "absl/strings/str_cat.h"

namespace phrenic::client {

absl::Status WriteWhole(const std::string& file, const std::string& bytes) {
  const std::string part = file + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (out && std::rename(part.c_str(), file.c_str()) == 0) return absl::OkStatus();
  }
  std::remove(part.c_str());
  return absl::DataLossError(absl::StrCat("cannot write ", file, ": is the folder there, and the disk not full?"));
}

}  // namespace phrenic::client
