#include "server/imaging/dicom_segmentation.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/imaging/dicom_file.h"
#include "server/imaging/dicom_frames.h"
#include "server/imaging/dicom_pixels.h"
#include "server/imaging/dicom_text.h"
#include "server/imaging/rt_structures.h"

namespace phrenic::imaging {
namespace {

constexpr const char* kLabelMapSegmentation = "1.2.840.10008.5.1.4.1.1.66.7";  // newer than DCMTK 3.6.7

// What other DICOM objects are, in words, by their SOP class.
struct DicomKind {
  const char* sop_class;
  const char* words;
};
constexpr DicomKind kOtherKinds[] = {
    {UID_CTImageStorage, "a slice of a CT"},
    {UID_EnhancedCTImageStorage, "a CT"},
    {UID_MRImageStorage, "a slice of an MRI"},
    {UID_EnhancedMRImageStorage, "an MRI"},
    {UID_PositronEmissionTomographyImageStorage, "a slice of a PET"},
    {UID_SecondaryCaptureImageStorage, "a secondary capture"},
    {UID_RTDoseStorage, "an RT Dose"},
    {UID_SurfaceSegmentationStorage, "a Surface Segmentation (meshes)"},
    {UID_MediaStorageDirectoryStorage, "a DICOMDIR (a folder's table of contents)"},
};

std::string SopClassOf(DcmFileFormat& file) {
  std::string sop_class = TextOf(file.getDataset(), DCM_SOPClassUID);
  return sop_class.empty() ? TextOf(file.getMetaInfo(), DCM_MediaStorageSOPClassUID) : sop_class;
}

absl::Status CheckSopClass(const std::string& sop_class) {
  if (sop_class == UID_SegmentationStorage || sop_class == kLabelMapSegmentation) return absl::OkStatus();
  std::string kind = "another kind of DICOM object";
  for (const DicomKind& other : kOtherKinds) {
    if (sop_class == other.sop_class) kind = other.words;
  }
  return absl::InvalidArgumentError(absl::StrCat(
      "it is ", kind,
      ", not a DICOM Segmentation (SEG) of the thorax; segment the CT, for example by TotalSegmentator, or "
      "convert it in 3D Slicer, and save the labels as DICOM Segmentation or NIfTI"));
}

// Returns what the code of a segment's type means, followed by its modifier (laterality), which may be at the type or
// at the anatomic region.
std::string MeaningOf(DcmItem& segment) {
  DcmItem* type = FirstItem(&segment, DCM_SegmentedPropertyTypeCodeSequence);
  DcmItem* region = FirstItem(&segment, DCM_AnatomicRegionSequence);
  std::string modifier = TextOf(FirstItem(type, DCM_SegmentedPropertyTypeModifierCodeSequence), DCM_CodeMeaning);
  if (modifier.empty()) modifier = TextOf(FirstItem(region, DCM_AnatomicRegionModifierSequence), DCM_CodeMeaning);
  const std::string meaning = TextOf(type, DCM_CodeMeaning);
  return meaning.empty() || modifier.empty() ? meaning : absl::StrCat(meaning, " ", modifier);
}

void ReadSegments(DcmDataset& dataset, LabelVolume& volume) {
  DcmSequenceOfItems* segments = nullptr;
  if (dataset.findAndGetSequence(DCM_SegmentSequence, segments).bad() || segments == nullptr) return;
  Utf8 in_utf8(dataset);
  DcmObject* next = nullptr;
  while ((next = segments->nextInContainer(next)) != nullptr) {
    auto& segment = static_cast<DcmItem&>(*next);
    Uint16 number = 0;
    if (segment.findAndGetUint16(DCM_SegmentNumber, number).bad() || number == 0) continue;
    volume.names.emplace(number, in_utf8(TextOf(&segment, DCM_SegmentLabel)));
    volume.meanings.emplace(number, in_utf8(MeaningOf(segment)));
  }
}

// A segment with two frames at one place has several volumes, such as points in time.
absl::Status CheckSingle(const DicomFrames& frames, const SliceStack& stack) {
  std::set<std::pair<int, int>> taken;
  for (std::size_t f = 0; f < frames.segments.size(); ++f) {
    if (taken.emplace(frames.segments[f], stack.slice_of[f]).second) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("frame ", f + 1,
                     " is at the place of another frame of its segment; export a single point in time as a "
                     "segmentation of its own"));
  }
  return absl::OkStatus();
}

// Returns the frames' indices by segment number, so that of overlapping segments the highest is written last.
std::vector<int> BySegment(const DicomFrames& frames) {
  std::vector<int> order(frames.segments.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return frames.segments[a] < frames.segments[b]; });
  return order;
}

void WriteFrames(const DicomPixels& pixels, const DicomFrames& frames, const SliceStack& stack, LabelVolume& volume) {
  std::size_t overlaps = 0;
  for (const int frame : BySegment(frames)) {
    Label* slice = volume.labels.data() + pixels.in_frame() * stack.slice_of[frame];
    const auto segment = static_cast<Label>(frames.segments[frame]);
    pixels.ForEachInside(frame, [&](std::size_t at, unsigned value) {
      if (slice[at] != 0) ++overlaps;
      slice[at] = pixels.label_map ? static_cast<Label>(value) : segment;
    });
  }
  if (overlaps == 0) return;
  volume.remarks.push_back(
      absl::StrCat("segments overlap in ", overlaps, " voxels; the segment with the higher number counts there"));
}

absl::StatusOr<LabelVolume> ReadSegmentation(DcmDataset& dataset, std::size_t max_voxels) {
  const absl::StatusOr<DicomPixels> pixels = ReadDicomPixels(dataset);
  if (!pixels.ok()) return pixels.status();
  const absl::StatusOr<DicomFrames> frames = ReadDicomFrames(dataset, pixels->frames, pixels->label_map);
  if (!frames.ok()) return frames.status();
  const absl::StatusOr<SliceStack> stack = StackSlices(frames->plane, frames->positions, frames->spacing);
  if (!stack.ok()) return stack.status();
  if (absl::Status status = CheckSingle(*frames, *stack); !status.ok()) return status;
  if (pixels->in_frame() > max_voxels / stack->slices) {
    const std::string problem =
        absl::StrCat("its volume has more than ", max_voxels, " voxels; crop the segmentation to the thorax");
    return max_voxels < kMaxVoxels ? absl::ResourceExhaustedError(problem) : absl::InvalidArgumentError(problem);
  }
  LabelVolume volume;
  volume.size = {static_cast<int>(pixels->columns), static_cast<int>(pixels->rows), stack->slices};
  volume.to_patient = stack->to_patient;
  volume.labels.assign(pixels->in_frame() * stack->slices, 0);
  WriteFrames(*pixels, *frames, *stack, volume);
  ReadSegments(dataset, volume);
  return volume;
}

}  // namespace

absl::StatusOr<LabelVolume> ParseDicomSegmentation(std::string_view name, std::string_view bytes,
                                                   std::size_t max_voxels) {
  const auto named = [name](const absl::Status& status) {
    return absl::Status(status.code(), absl::StrCat(std::string(name), ": ", std::string(status.message())));
  };
  const absl::StatusOr<DicomFile> file = ParseDicom(bytes);
  if (!file.ok()) return named(file.status());
  const std::string sop_class = SopClassOf(**file);
  const bool contours = sop_class == UID_RTStructureSetStorage;
  if (absl::Status status = contours ? absl::OkStatus() : CheckSopClass(sop_class); !status.ok()) return named(status);
  DcmDataset& dataset = *(*file)->getDataset();
  absl::StatusOr<LabelVolume> volume = contours ? ReadRtStructures(dataset) : ReadSegmentation(dataset, max_voxels);
  if (!volume.ok()) return named(volume.status());
  return volume;
}

}  // namespace phrenic::imaging
