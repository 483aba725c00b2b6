#include "server/imaging/dicom_pixels.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dctk.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {
namespace {

absl::Status ErrorIn(const std::string& attribute, const std::string& problem) {
  return absl::InvalidArgumentError(absl::StrCat(attribute, " ", problem, "; export the segmentation again"));
}

// Returns the attribute, or 0 if it is missing.
unsigned Number(DcmItem& item, const DcmTagKey& attribute) {
  Uint16 number = 0;
  return item.findAndGetUint16(attribute, number).good() ? number : 0;
}

absl::Status ReadExtent(DcmDataset& dataset, DicomPixels& pixels) {
  if (Number(dataset, DCM_InConcatenationNumber) > 0 && Number(dataset, DCM_InConcatenationTotalNumber) != 1) {
    return absl::InvalidArgumentError(
        "it is one of several files of a concatenation; export the segmentation as a single file");
  }
  pixels.rows = Number(dataset, DCM_Rows);
  pixels.columns = Number(dataset, DCM_Columns);
  if (pixels.rows < 1 || pixels.columns < 1 || pixels.rows > kMaxAlong || pixels.columns > kMaxAlong) {
    return ErrorIn("Rows and Columns",
                   absl::StrCat("are ", pixels.rows, " and ", pixels.columns, ", not 1 to ", kMaxAlong));
  }
  Sint32 frames = 0;
  if (dataset.findAndGetSint32(DCM_NumberOfFrames, frames).bad() || frames < 1) {
    return ErrorIn("NumberOfFrames", "is missing or less than 1");
  }
  pixels.frames = frames;
  return absl::OkStatus();
}

absl::Status ReadSegmentationType(DcmDataset& dataset, DicomPixels& pixels) {
  OFString type;
  if (dataset.findAndGetOFString(DCM_SegmentationType, type).bad()) type.clear();
  pixels.label_map = type == "LABELMAP";
  const bool binary = type == "BINARY", fractional = type == "FRACTIONAL";
  if (!binary && !fractional && !pixels.label_map) {
    return ErrorIn("SegmentationType", "is not BINARY, FRACTIONAL or LABELMAP");
  }
  pixels.bits = static_cast<int>(Number(dataset, DCM_BitsAllocated));
  const bool valid = pixels.bits == 8 || (pixels.bits == 1 && binary) || (pixels.bits == 16 && pixels.label_map);
  if (!valid || Number(dataset, DCM_SamplesPerPixel) > 1) {
    return ErrorIn("BitsAllocated", absl::StrCat("is ", pixels.bits, ", which is not one of a ", type.c_str(),
                                                 " segmentation with one sample a pixel"));
  }
  if (fractional) {
    const unsigned most = Number(dataset, DCM_MaximumFractionalValue);
    if (most < 1 || most > 255) return ErrorIn("MaximumFractionalValue", "is missing or not 1 to 255");
    pixels.least = (most + 1) / 2;
  }
  if (pixels.label_map) pixels.background = Number(dataset, DCM_PixelPaddingValue);
  return absl::OkStatus();
}

// Decodes RLE. Refuses other encapsulated pixels.
absl::Status Decompress(DcmDataset& dataset, const DicomPixels& pixels) {
  const DcmXfer transfer(dataset.getOriginalXfer());
  if (!transfer.isEncapsulated()) return absl::OkStatus();
  if (transfer.getXfer() != EXS_RLELossless) {
    return absl::InvalidArgumentError(absl::StrCat("its pixels are compressed (", transfer.getXferName(),
                                                   "); save it uncompressed, for example by gdcmconv --raw"));
  }
  if (pixels.in_frame() > kMaxVoxels / pixels.frames) {
    return absl::InvalidArgumentError(
        absl::StrCat("its frames have more than ", kMaxVoxels, " voxels; crop the segmentation to the thorax"));
  }
  [[maybe_unused]] static const bool decodes = (DcmRLEDecoderRegistration::registerCodecs(), true);
  if (dataset.chooseRepresentation(EXS_LittleEndianExplicit, nullptr).bad()) {
    return ErrorIn("PixelData", "is not valid RLE");
  }
  return absl::OkStatus();
}

absl::Status FindPixels(DcmDataset& dataset, DicomPixels& pixels) {
  DcmElement* data = nullptr;
  const std::size_t needed = (pixels.in_frame() * pixels.frames * pixels.bits + 7) / 8;
  const bool found = dataset.findAndGetElement(DCM_PixelData, data).good();
  const std::size_t there = found ? data->getLength() : 0;
  if (there < needed) {
    return absl::InvalidArgumentError(absl::StrCat("PixelData has ", there, " bytes, ", needed,
                                                   " are declared; the file is truncated, download it again"));
  }
  Uint8* bytes = nullptr;
  Uint16* words = nullptr;
  const OFCondition read = pixels.bits == 16 ? data->getUint16Array(words) : data->getUint8Array(bytes);
  pixels.bytes = bytes;
  pixels.words = words;
  if (read.bad() || (bytes == nullptr && words == nullptr)) return ErrorIn("PixelData", "cannot be read");
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<DicomPixels> ReadDicomPixels(DcmDataset& dataset) {
  DicomPixels pixels;
  if (absl::Status status = ReadExtent(dataset, pixels); !status.ok()) return status;
  if (absl::Status status = ReadSegmentationType(dataset, pixels); !status.ok()) return status;
  if (absl::Status status = Decompress(dataset, pixels); !status.ok()) return status;
  if (absl::Status status = FindPixels(dataset, pixels); !status.ok()) return status;
  return pixels;
}

}  // namespace phrenic::imaging
