#include "server/fluoroscopy/picture_file.h"

#include <zlib.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/imaging/nifti_header.h"
#include "server/mesh/units.h"
#include "server/meshio/bytes.h"

namespace phrenic::fluoroscopy {
namespace {

constexpr double kBeside = 0.4;                       // smaller line integrals are those of rays beside the trunk
constexpr double kDarkest = 0.06, kBrightest = 0.98;  // parts of the rays that may be black and white
constexpr double kNarrowest = 0.2;                    // of a window

std::string BigEndian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::string Chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return absl::StrCat(BigEndian(static_cast<std::uint32_t>(data.size())), body,
                      BigEndian(static_cast<std::uint32_t>(sum)));
}

std::string Compressed(const std::string& bytes) {
  uLongf length = compressBound(static_cast<uLong>(bytes.size()));
  std::string compressed(length, '\0');
  compress(reinterpret_cast<Bytef*>(compressed.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
           static_cast<uLong>(bytes.size()));
  compressed.resize(length);
  return compressed;
}

}  // namespace

Window WindowOf(const Picture& sums) {
  std::vector<double> through;
  std::copy_if(sums.data(), sums.data() + sums.size(), std::back_inserter(through),
               [](double s) { return s > kBeside; });
  if (through.empty()) return {};
  std::sort(through.begin(), through.end());
  const auto at = [&](double part) { return through[static_cast<size_t>(part * static_cast<double>(through.size()))]; };
  const Window window{at(kDarkest), at(kBrightest)};
  if (window.high - window.low >= kNarrowest) return window;
  return {window.low - kNarrowest / 2, window.low + kNarrowest / 2};
}

std::string WritePng(const Picture& sums, const Window& window, bool dark_bones) {
  std::string rows;
  rows.reserve(static_cast<size_t>((2 * sums.cols() + 1) * sums.rows()));
  for (const auto& row : sums.rowwise()) {
    rows.push_back(0);  // no filter
    for (const double sum : row) {
      const double grey = std::clamp((sum - window.low) / (window.high - window.low), 0.0, 1.0);
      const auto level = static_cast<std::uint16_t>(std::lround(65535 * (dark_bones ? 1 - grey : grey)));
      rows.push_back(static_cast<char>(level >> 8));
      rows.push_back(static_cast<char>(level));
    }
  }
  const std::string header = BigEndian(static_cast<std::uint32_t>(sums.cols())) +
                             BigEndian(static_cast<std::uint32_t>(sums.rows())) + std::string("\x10\0\0\0\0", 5);
  return absl::StrCat("\x89PNG\r\n\x1a\n", Chunk("IHDR", header), Chunk("IDAT", Compressed(rows)), Chunk("IEND", ""));
}

std::string WriteNifti(const Picture& sums, const Projection& projection) {
  constexpr int kFloat32 = 16;
  const int size = static_cast<int>(sums.rows());
  const double pixel = kMillimetresAMetre * 2 * projection.half_width / size;
  Eigen::Affine3d to_patient = Eigen::Affine3d::Identity();
  to_patient.linear() << pixel * projection.right, -pixel * projection.up, projection.to_detector;
  to_patient.translation() = kMillimetresAMetre * projection.isocentre +
                             (0.5 - size / 2.0) * (to_patient.linear().col(0) + to_patient.linear().col(1));
  std::string bytes =
      imaging::NiftiHeaderBytes({{3, size, size, 1, 1, 1, 1, 1}, {pixel, pixel, 1}, to_patient, 0, kFloat32, 32, 0});
  for (const double sum : sums.reshaped<Eigen::RowMajor>()) meshio::AppendBytes(bytes, static_cast<float>(sum));
  return bytes;
}

}  // namespace phrenic::fluoroscopy
