// DICOM Segmentations of a phantom.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/phantom/dicom/objects.h"

namespace phrenic::phantom {
namespace {

constexpr std::array<std::uint8_t, 3> kGrey = {200, 200, 200};

// Returns the red, green and blue of "#a5483f"; grey for any other text.
std::array<std::uint8_t, 3> RgbOf(const std::string& color) {
  std::uint32_t number = 0;
  if (color.size() != 7 || color[0] != '#' || !absl::SimpleHexAtoi(color.substr(1), &number)) return kGrey;
  return {static_cast<std::uint8_t>(number >> 16), static_cast<std::uint8_t>(number >> 8),
          static_cast<std::uint8_t>(number)};
}

// Returns CIELab of D50 as DICOM stores it (PS3.3, C.10.7.1.1), from sRGB (IEC 61966-2-1, adapted by Bradford).
std::array<Uint16, 3> CieLab(const std::array<std::uint8_t, 3>& rgb) {
  std::array<double, 3> linear{};
  for (int c = 0; c < 3; ++c) {
    const double s = rgb[c] / 255.0;
    linear[c] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  }
  constexpr double kToXyz[3][3] = {{0.4360747, 0.3850649, 0.1430804},  // relative to the white point below
                                   {0.2225045, 0.7168786, 0.0606169},
                                   {0.0139322, 0.0971045, 0.7141733}};
  constexpr double kWhite[] = {0.96422, 1, 0.82521};
  std::array<double, 3> f{};
  for (int row = 0; row < 3; ++row) {
    double t = 0;
    for (int c = 0; c < 3; ++c) t += kToXyz[row][c] * linear[c] / kWhite[row];
    f[row] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  }
  const double l = 116 * f[1] - 16, a = 500 * (f[0] - f[1]), b = 200 * (f[1] - f[2]);
  const auto scaled = [](double value) { return static_cast<Uint16>(std::lround(std::clamp(value, 0.0, 65535.0))); };
  return {scaled(l * 65535 / 100), scaled((a + 128) * 65535 / 255), scaled((b + 128) * 65535 / 255)};
}

// The frames of a segmentation: segment by segment, slice by slice.
struct Frames {
  std::vector<std::pair<int, int>> at;  // segment number and slice
  std::vector<Uint8> bits;              // of all frames, the lowest bit first
};

void AddSegment(const Structure& structure, int number, DcmItem& data) {
  DcmItem& segment = AddItem(data, DCM_SegmentSequence);
  Put(segment, DCM_SegmentNumber, number);
  Put(segment, DCM_SegmentLabel, structure.name.substr(0, 64));
  Put(segment, DCM_SegmentAlgorithmType, "AUTOMATIC");
  Put(segment, DCM_SegmentAlgorithmName, "Phrenic phantom");
  PutCode(segment, DCM_SegmentedPropertyCategoryCodeSequence, {"123037004", "Anatomical Structure"});
  PutCode(segment, DCM_SegmentedPropertyTypeCodeSequence, CodeOf(structure.anatomy));
  if (const Code side = CodeOf(structure.anatomy.side()); !side.value.empty()) {
    DcmItem* type = nullptr;
    segment.findAndGetSequenceItem(DCM_SegmentedPropertyTypeCodeSequence, type);
    PutCode(*type, DCM_SegmentedPropertyTypeModifierCodeSequence, side);
  }
  const std::array<Uint16, 3> lab = CieLab(RgbOf(structure.color));
  segment.putAndInsertUint16Array(DCM_RecommendedDisplayCIELabValue, lab.data(), lab.size());
}

void AddDimension(const std::string& organisation, const DcmTagKey& pointer, const DcmTagKey& group,
                  const std::string& label, DcmItem& data) {
  DcmItem& index = AddItem(data, DCM_DimensionIndexSequence);
  Put(index, DCM_DimensionOrganizationUID, organisation);
  index.putAndInsertTagKey(DCM_DimensionIndexPointer, pointer);
  index.putAndInsertTagKey(DCM_FunctionalGroupPointer, group);
  Put(index, DCM_DimensionDescriptionLabel, label);
}

void AddGroups(const imaging::LabelVolume& volume, const Frames& frames, DcmItem& data) {
  const Eigen::Vector3d spacing = volume.Spacing();
  const Eigen::Matrix3d axes = volume.to_patient.linear() * spacing.cwiseInverse().asDiagonal();
  DcmItem& shared = AddItem(data, DCM_SharedFunctionalGroupsSequence);
  DcmItem& measures = AddItem(shared, DCM_PixelMeasuresSequence);
  PutDecimals(measures, DCM_PixelSpacing, {spacing.y(), spacing.x()});
  PutDecimals(measures, DCM_SliceThickness, {spacing.z()});
  PutDecimals(measures, DCM_SpacingBetweenSlices, {spacing.z()});
  PutDecimals(AddItem(shared, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient,
              {axes(0, 0), axes(1, 0), axes(2, 0), axes(0, 1), axes(1, 1), axes(2, 1)});
  for (const auto& [segment, k] : frames.at) {
    DcmItem& group = AddItem(data, DCM_PerFrameFunctionalGroupsSequence);
    DcmItem& content = AddItem(group, DCM_FrameContentSequence);
    const std::array<Uint32, 2> index = {static_cast<Uint32>(segment), static_cast<Uint32>(k + 1)};
    auto* values = new DcmUnsignedLong(DCM_DimensionIndexValues);  // the item owns it
    values->putUint32Array(index.data(), index.size());
    content.insert(values);
    const Eigen::Vector3d at = volume.to_patient * Eigen::Vector3d(0, 0, k);
    PutDecimals(AddItem(group, DCM_PlanePositionSequence), DCM_ImagePositionPatient, {at.x(), at.y(), at.z()});
    Put(AddItem(group, DCM_SegmentIdentificationSequence), DCM_ReferencedSegmentNumber, segment);
  }
}

// Packs the slices of each label that has voxels there. `number` has the segment of each label.
Frames PackFrames(const imaging::LabelVolume& volume, const std::map<imaging::Label, int>& number) {
  const std::size_t layer = static_cast<std::size_t>(volume.size.x()) * volume.size.y();
  std::map<std::pair<int, int>, std::vector<std::size_t>> inside;  // pixels of each segment in each slice
  for (std::size_t v = 0; v < volume.labels.size(); ++v) {
    if (volume.labels[v] == 0) continue;
    inside[{number.at(volume.labels[v]), static_cast<int>(v / layer)}].push_back(v % layer);
  }
  Frames frames;
  frames.bits.assign((inside.size() * layer + 15) / 16 * 2, 0);
  for (const auto& [at, pixels] : inside) {
    const std::size_t start = frames.at.size() * layer;
    for (const std::size_t pixel : pixels) {
      frames.bits[(start + pixel) / 8] |= static_cast<Uint8>(1U << (start + pixel) % 8);
    }
    frames.at.push_back(at);
  }
  return frames;
}

void PutImage(const imaging::LabelVolume& volume, const Frames& frames, DcmItem& data) {
  Put(data, DCM_ImageType, "DERIVED\\PRIMARY");
  Put(data, DCM_InstanceNumber, "1");
  Put(data, DCM_ContentLabel, "PHANTOM");
  Put(data, DCM_ContentDescription, "Structures of a simulated breath");
  data.insertEmptyElement(DCM_ContentCreatorName);
  Put(data, DCM_SamplesPerPixel, 1);
  Put(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  Put(data, DCM_NumberOfFrames, absl::StrCat(frames.at.size()));
  Put(data, DCM_Rows, volume.size.y());
  Put(data, DCM_Columns, volume.size.x());
  Put(data, DCM_BitsAllocated, 1);
  Put(data, DCM_BitsStored, 1);
  Put(data, DCM_HighBit, 0);
  Put(data, DCM_PixelRepresentation, 0);
  Put(data, DCM_LossyImageCompression, "00");
  Put(data, DCM_SegmentationType, "BINARY");
  data.putAndInsertUint8Array(DCM_PixelData, frames.bits.data(), frames.bits.size());
}

}  // namespace

absl::StatusOr<std::string> WriteSegmentation(const DicomStudy& study, const Structures& structures,
                                              const PhantomPhase& rendered, int phase) {
  DcmFileFormat file;
  DcmItem& data = *file.getDataset();
  const DicomSeries series = {absl::StrCat("segmentation ", phase), "SEG", 100 + phase,
                              absl::StrCat("Structures, phase ", phase), rendered.time};
  PutCommon(study, series, UID_SegmentationStorage, study.Uid(series.name + ", instance"), data);
  std::map<imaging::Label, int> number;
  for (std::size_t s = 0; s < structures.all.size(); ++s) {
    if (rendered.structures[s].labelled == 0) continue;
    const int next = static_cast<int>(number.size()) + 1;
    number[structures.all[s].number] = next;
    AddSegment(structures.all[s], next, data);
  }
  if (number.empty()) return absl::FailedPreconditionError("no structure has a voxel: make the spacing smaller");
  const Frames frames = PackFrames(rendered.labels, number);
  const std::string organisation = study.Uid(series.name + ", dimensions");
  Put(AddItem(data, DCM_DimensionOrganizationSequence), DCM_DimensionOrganizationUID, organisation);
  AddDimension(organisation, DCM_ReferencedSegmentNumber, DCM_SegmentIdentificationSequence, "Segment", data);
  AddDimension(organisation, DCM_ImagePositionPatient, DCM_PlanePositionSequence, "Slice", data);
  AddGroups(rendered.labels, frames, data);
  PutImage(rendered.labels, frames, data);
  return BytesOf(file);
}

}  // namespace phrenic::phantom
