#include "server/imaging/nifti_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/imaging/label_volume.h"
#include "server/meshio/bytes.h"

namespace phrenic::imaging {
namespace {

using meshio::ByteReader;

// Byte offsets of the fields in a version of the header.
struct Layout {
  std::size_t length, magic, dim, type, pixdim, data_at, slope, qform, quaternion, offset, srow, units;
  bool wide;  // 64-bit counts and reals
};
constexpr Layout kNifti1 = {348, 344, 40, 70, 76, 108, 112, 252, 256, 268, 280, 123, false};
constexpr Layout kNifti2 = {540, 4, 16, 12, 104, 168, 176, 344, 352, 376, 400, 500, true};

// Decodes header fields of either version and endianness.
class Fields {
 public:
  const Layout* at;

  Fields(std::string_view name, std::string_view bytes, std::endian order, const Layout& layout)
      : at(&layout), name_(name), bytes_(bytes), order_(order) {}

  template <typename T>
  T Get(std::size_t offset) const {
    T number{};
    ByteReader(name_, bytes_, offset, order_).Take(number);
    return number;
  }
  std::int64_t Count(std::size_t field, int index) const {
    return at->wide ? Get<std::int64_t>(field + 8 * index) : Get<std::int16_t>(field + 2 * index);
  }
  double Real(std::size_t field, int index) const {
    return at->wide ? Get<double>(field + 8 * index) : Get<float>(field + 4 * index);
  }
  std::int64_t Code(std::size_t field, int index) const {
    return at->wide ? Get<std::int32_t>(field + 4 * index) : Get<std::int16_t>(field + 2 * index);
  }
  absl::Status Error(std::size_t offset, const std::string& message) const {
    return ByteReader(name_, bytes_, offset).Error(message);
  }
  std::endian order() const { return order_; }

 private:
  std::string_view name_, bytes_;
  std::endian order_;
};

// Returns what the voxels of a type that is no integer are, by NIfTI's datatype code.
std::string_view TypeWords(int code) {
  switch (code) {
    case 1:
      return "single bits";
    case 16:
      return "float32 numbers";
    case 64:
      return "float64 numbers";
    case 1536:
      return "float128 numbers";
    case 128:
    case 2304:
      return "colours";
    default:
      return "no integers";
  }
}

// Determines version and endianness from the header's length and magic number.
absl::StatusOr<Fields> Recognise(std::string_view name, std::string_view bytes) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    for (const Layout* layout : {&kNifti1, &kNifti2}) {
      const Fields fields(name, bytes, order, *layout);
      if (bytes.size() < layout->length + 4 || fields.Get<std::int32_t>(0) != static_cast<int>(layout->length))
        continue;
      const std::string_view magic = bytes.substr(layout->magic, 4);
      if (magic.starts_with("ni")) {
        return fields.Error(layout->magic, "the voxels are in a second file (.img); save it as one file, .nii");
      }
      if (magic.substr(0, 3) == (layout->wide ? "n+2" : "n+1")) return fields;
    }
  }
  return absl::InvalidArgumentError(
      absl::StrCat(std::string(name),
                   ": not a NIfTI-1 or NIfTI-2 file, nor a DICOM file: its first bytes are not such a header; save the "
                   "segmentation as .nii, .nii.gz, DICOM Segmentation or RT Structure Set"));
}

absl::Status ReadSize(const Fields& fields, NiftiHeader& header) {
  const std::int64_t dimensions = fields.Count(fields.at->dim, 0);
  if (dimensions < 3 || dimensions > 7) {
    return fields.Error(fields.at->dim,
                        absl::StrCat("a volume has 3 dimensions, not ", dimensions, "; save one volume of labels"));
  }
  for (int k = 1; k <= dimensions; ++k) {
    const std::int64_t along = fields.Count(fields.at->dim, k);
    const bool valid = k <= 3 ? along >= 1 && along <= kMaxAlong : along == 1;
    if (!valid) {
      return fields.Error(fields.at->dim,
                          absl::StrCat("dimension ", k, " has ", along, " entries; ",
                                       k <= 3 ? "1 to 32767 are supported; crop it to the thorax"
                                              : "only a single volume is supported; save each as a file of its own"));
    }
    if (k <= 3) header.size[k - 1] = static_cast<int>(along);
  }
  if (header.voxels() > kMaxVoxels) {
    return fields.Error(fields.at->dim, absl::StrCat("more than ", kMaxVoxels, " voxels; crop to the thorax"));
  }
  return absl::OkStatus();
}

absl::Status ReadType(const Fields& fields, NiftiHeader& header) {
  header.type = fields.Get<std::int16_t>(fields.at->type);
  if (!WithIntegerOf(header.type, [&](auto number) { header.voxel_bytes = sizeof(number); })) {
    return fields.Error(fields.at->type,
                        absl::StrCat("voxels are ", std::string(TypeWords(header.type)), " (type code ", header.type,
                                     "), and labels are integers: save it as uint8, int16 or another integer type"));
  }
  const double slope = fields.Real(fields.at->slope, 0), intercept = fields.Real(fields.at->slope, 1);
  const bool plain = (slope == 0 && std::isfinite(intercept)) || (slope == 1 && intercept == 0);
  if (!plain) {
    return fields.Error(fields.at->slope,
                        "voxels are scaled (scl_slope, scl_inter), which labels must not be; save them unscaled");
  }
  const double start = fields.at->wide ? static_cast<double>(fields.Get<std::int64_t>(fields.at->data_at))
                                       : fields.Get<float>(fields.at->data_at);
  if (!(start >= static_cast<double>(header.length) && start < 1e9) || start != std::floor(start)) {
    return fields.Error(fields.at->data_at,
                        absl::StrCat("voxels cannot start at byte ", start, " (vox_offset); save the file again"));
  }
  header.data_at = static_cast<std::size_t>(start);
  return absl::OkStatus();
}

// Returns the sform: voxel index to RAS.
Eigen::Affine3d SformOf(const Fields& fields) {
  Eigen::Affine3d to_ras = Eigen::Affine3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      to_ras.matrix()(row, column) = fields.Real(fields.at->srow, 4 * row + column);
    }
  }
  return to_ras;
}

// Returns the qform: rotation by the unit quaternion (a, b, c, d), voxel spacing, and offset.
Eigen::Affine3d QformOf(const Fields& fields) {
  const auto q = [&](int k) { return fields.Real(fields.at->quaternion, k); };
  const double a = std::sqrt(std::max(0.0, 1 - q(0) * q(0) - q(1) * q(1) - q(2) * q(2)));
  Eigen::Vector3d spacing;
  for (int k = 0; k < 3; ++k) spacing[k] = fields.Real(fields.at->pixdim, k + 1);
  if (fields.Real(fields.at->pixdim, 0) < 0) spacing.z() = -spacing.z();
  Eigen::Affine3d to_ras = Eigen::Affine3d::Identity();
  to_ras.linear() = Eigen::Quaterniond(a, q(0), q(1), q(2)).normalized().toRotationMatrix() * spacing.asDiagonal();
  for (int k = 0; k < 3; ++k) to_ras.translation()[k] = fields.Real(fields.at->offset, k);
  return to_ras;
}

// Returns the header's unit of length [mm].
double UnitOf(const Fields& fields) {
  const int code =
      fields.at->wide ? fields.Get<std::int32_t>(fields.at->units) : fields.Get<std::uint8_t>(fields.at->units);
  return (code & 7) == 1 ? 1e3 : (code & 7) == 3 ? 1e-3 : 1.0;
}

absl::Status ReadOrientation(const Fields& fields, NiftiHeader& header) {
  const bool qform = fields.Code(fields.at->qform, 0) > 0, sform = fields.Code(fields.at->qform, 1) > 0;
  if (!qform && !sform) {
    return fields.Error(fields.at->qform,
                        "neither sform nor qform is set, so left and right are unknown; save it with its orientation");
  }
  header.to_ras = sform ? SformOf(fields) : QformOf(fields);
  header.to_ras.matrix().topRows<3>() *= UnitOf(fields);
  if (!IsVoxelFrame(header.to_ras)) {
    return fields.Error(sform ? fields.at->srow : fields.at->quaternion,
                        absl::StrCat("the orientation is not an affine frame with ", kVoxelFrameRule,
                                     "; save it from a viewer that displays it"));
  }
  return absl::OkStatus();
}

}  // namespace

bool HasNiftiMark(std::string_view start) {
  for (const Layout* layout : {&kNifti1, &kNifti2}) {
    const std::string_view magic = start.substr(std::min(start.size(), layout->magic), 3);
    if (magic == "ni1" || magic == "ni2" || magic == (layout->wide ? "n+2" : "n+1")) return true;
  }
  return false;
}

absl::StatusOr<NiftiHeader> ParseNiftiHeader(std::string_view name, std::string_view bytes) {
  const absl::StatusOr<Fields> fields = Recognise(name, bytes);
  if (!fields.ok()) return fields.status();
  NiftiHeader header;
  header.order = fields->order();
  header.length = fields->at->length + 4;
  if (absl::Status status = ReadSize(*fields, header); !status.ok()) return status;
  if (absl::Status status = ReadType(*fields, header); !status.ok()) return status;
  if (absl::Status status = ReadOrientation(*fields, header); !status.ok()) return status;
  return header;
}

std::string NiftiHeaderBytes(const NiftiLayout& layout) {
  using meshio::AppendBytes;
  constexpr int kHeader = 348, kMillimetres = 2, kScanner = 1;
  std::string bytes;
  const auto pad = [&bytes](std::size_t to) { bytes.resize(to, '\0'); };
  AppendBytes(bytes, std::int32_t{kHeader});
  pad(40);
  for (const int along : layout.dimensions) AppendBytes(bytes, static_cast<std::int16_t>(along));
  pad(68);
  for (const int number : {layout.intent, layout.type, layout.bits}) {
    AppendBytes(bytes, static_cast<std::int16_t>(number));
  }
  pad(76);
  AppendBytes(bytes, 1.0F);
  for (const double along : layout.spacing) AppendBytes(bytes, static_cast<float>(along));
  pad(108);
  AppendBytes(bytes, static_cast<float>(kHeader + 4 + layout.extension));
  pad(123);
  bytes.push_back(kMillimetres);
  pad(254);
  AppendBytes(bytes, std::int16_t{kScanner});
  pad(280);
  const Eigen::Affine3d to_ras = Eigen::Scaling(kRasToLps) * layout.to_patient;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) AppendBytes(bytes, static_cast<float>(to_ras.matrix()(row, column)));
  }
  pad(344);
  bytes.append("n+1\0", 4);
  bytes.append(layout.extension == 0 ? "\0\0\0\0" : "\1\0\0\0", 4);
  return bytes;
}

}  // namespace phrenic::imaging
