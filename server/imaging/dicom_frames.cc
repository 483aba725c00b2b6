#include "server/imaging/dicom_frames.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"

namespace phrenic::imaging {
namespace {

constexpr double kAgree = 1e-3;      // orientations (components) and spacings (relative) of frames
constexpr double kSkew = 1e-2;       // of written unit vectors: length, cosine between them
constexpr double kMaxSpacing = 1e5;  // [mm]

// A frame's functional group and the shared one; either may be null.
struct FrameGroups {
  int frame;  // from 1
  DcmItem* own;
  DcmItem* shared;

  // Returns the macro's item, or null.
  DcmItem* Macro(const DcmTagKey& macro) const {
    for (DcmItem* group : {own, shared}) {
      DcmItem* item = nullptr;
      if (group != nullptr && group->findAndGetSequenceItem(macro, item).good()) return item;
    }
    return nullptr;
  }
  absl::Status Error(const std::string& problem) const {
    return absl::InvalidArgumentError(absl::StrCat("frame ", frame, ": ", problem));
  }
};

// Reads `count` numbers of an attribute. Returns false unless all are there and finite.
bool ReadNumbers(DcmItem* item, const DcmTagKey& attribute, int count, double* numbers) {
  for (int n = 0; n < count; ++n) {
    if (item == nullptr || item->findAndGetFloat64(attribute, numbers[n], n).bad() || !std::isfinite(numbers[n])) {
      return false;
    }
  }
  return true;
}

absl::StatusOr<SlicePlane> ReadPlane(const FrameGroups& groups) {
  Eigen::Matrix<double, 3, 2> cosines;
  if (!ReadNumbers(groups.Macro(DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient, 6, cosines.data())) {
    return groups.Error(
        "ImageOrientationPatient is missing or not numbers, so left and right are unknown; export a segmentation of "
        "a CT or MR volume");
  }
  const Eigen::Vector3d row = cosines.col(0), column = cosines.col(1);
  if (std::abs(row.norm() - 1) > kSkew || std::abs(column.norm() - 1) > kSkew || std::abs(row.dot(column)) > kSkew) {
    return groups.Error("ImageOrientationPatient is not two orthogonal unit vectors; export the segmentation again");
  }
  Eigen::Vector2d spacing;  // between rows, between columns (PS3.3, 10.7.1.3)
  if (!ReadNumbers(groups.Macro(DCM_PixelMeasuresSequence), DCM_PixelSpacing, 2, spacing.data()) ||
      spacing.minCoeff() <= 0 || spacing.maxCoeff() > kMaxSpacing) {
    return groups.Error("PixelSpacing is missing or not two lengths in mm; export the segmentation again");
  }
  return SlicePlane{spacing.y() * row.normalized(), spacing.x() * column.normalized()};
}

// Returns the stated distance of slices, else their thickness [mm]; 0 if neither is stated.
double ReadSliceSpacing(const FrameGroups& groups) {
  for (const DcmTagKey& attribute : {DCM_SpacingBetweenSlices, DCM_SliceThickness}) {
    double spacing = 0;
    if (!ReadNumbers(groups.Macro(DCM_PixelMeasuresSequence), attribute, 1, &spacing)) continue;
    if (spacing > 0 && spacing <= kMaxSpacing) return spacing;
  }
  return 0;
}

bool AgreeIn(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kAgree * a.norm();
}

absl::Status AddFrame(const FrameGroups& groups, bool label_map, DicomFrames& frames) {
  const absl::StatusOr<SlicePlane> plane = ReadPlane(groups);
  if (!plane.ok()) return plane.status();
  if (frames.positions.empty()) {
    frames.plane = *plane;
    frames.spacing = ReadSliceSpacing(groups);
  }
  if (!AgreeIn(frames.plane.along_row, plane->along_row) || !AgreeIn(frames.plane.along_column, plane->along_column)) {
    return groups.Error(
        "its orientation or pixel spacing is not that of the first frame; resample the segmentation to one grid, for "
        "example in 3D Slicer");
  }
  Eigen::Vector3d position;
  if (!ReadNumbers(groups.Macro(DCM_PlanePositionSequence), DCM_ImagePositionPatient, 3, position.data())) {
    return groups.Error("ImagePositionPatient is missing or not numbers; export a segmentation of a CT or MR volume");
  }
  Uint16 segment = 0;
  DcmItem* identification = groups.Macro(DCM_SegmentIdentificationSequence);
  const bool known = identification != nullptr &&
                     identification->findAndGetUint16(DCM_ReferencedSegmentNumber, segment).good() && segment > 0;
  if (!label_map && !known) {
    return groups.Error("ReferencedSegmentNumber is missing or 0; export the segmentation again");
  }
  frames.positions.push_back(position);
  frames.segments.push_back(label_map ? 0 : segment);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<DicomFrames> ReadDicomFrames(DcmItem& dataset, int frames, bool label_map) {
  DcmItem* shared = nullptr;
  if (dataset.findAndGetSequenceItem(DCM_SharedFunctionalGroupsSequence, shared).bad()) shared = nullptr;
  DcmSequenceOfItems* own = nullptr;
  if (dataset.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, own).bad() || own == nullptr ||
      own->card() != static_cast<unsigned long>(frames)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "PerFrameFunctionalGroupsSequence has ", own == nullptr ? 0 : own->card(), " items, but NumberOfFrames is ",
        frames, ", so the frames' places are unknown; export a segmentation of a CT or MR volume"));
  }
  DicomFrames read;
  DcmObject* group = nullptr;
  for (int f = 1; f <= frames; ++f) {
    group = own->nextInContainer(group);  // getItem(f) would walk from the first one
    absl::Status status = AddFrame({f, static_cast<DcmItem*>(group), shared}, label_map, read);
    if (!status.ok()) return status;
  }
  return read;
}

}  // namespace phrenic::imaging
