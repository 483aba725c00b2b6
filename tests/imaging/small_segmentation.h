// Small DICOM Segmentations, written by DCMTK to memory.
#ifndef PHRENIC_TESTS_IMAGING_SMALL_SEGMENTATION_H_
#define PHRENIC_TESTS_IMAGING_SMALL_SEGMENTATION_H_

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dctk.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"

namespace phrenic::imaging {

inline std::string Decimals(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) absl::StrAppend(&text, text.empty() ? "" : "\\", number);
  return text;
}

struct SmallFrame {
  int segment = 1;
  Eigen::Vector3d position;           // [mm, LPS]
  std::vector<std::uint16_t> pixels;  // row by row
};

struct SmallSegmentation {
  std::string type = "BINARY", sop_class = UID_SegmentationStorage;
  int rows = 3, columns = 5, bits = 1;
  std::vector<double> orientation = {1, 0, 0, 0, 1, 0};
  std::vector<double> spacing = {2, 3};  // between rows, between columns
  double between_slices = 0;             // 0: not written
  std::vector<SmallFrame> frames;

  static DcmItem& Item(DcmItem& parent, const DcmTagKey& sequence, long number = 0) {
    DcmItem* item = nullptr;
    parent.findOrCreateSequenceItem(DcmTag(sequence), item, number);
    return *item;
  }
  static void Put(DcmItem& item, const DcmTagKey& attribute, const std::string& value) {
    item.putAndInsertString(DcmTag(attribute), value.c_str());
  }
  static void Put(DcmItem& item, const DcmTagKey& attribute, int value) {
    item.putAndInsertUint16(DcmTag(attribute), static_cast<Uint16>(value));
  }

  void AddGroups(DcmItem& data) const {
    DcmItem& shared = Item(data, DCM_SharedFunctionalGroupsSequence);
    DcmItem& measures = Item(shared, DCM_PixelMeasuresSequence);
    Put(measures, DCM_PixelSpacing, Decimals(spacing));
    if (between_slices > 0) Put(measures, DCM_SpacingBetweenSlices, Decimals({between_slices}));
    Put(Item(shared, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient, Decimals(orientation));
    for (const SmallFrame& frame : frames) {
      DcmItem& own = Item(data, DCM_PerFrameFunctionalGroupsSequence, -2);
      const Eigen::Vector3d& at = frame.position;
      Put(Item(own, DCM_PlanePositionSequence), DCM_ImagePositionPatient, Decimals({at.x(), at.y(), at.z()}));
      if (type == "LABELMAP") continue;
      Put(Item(own, DCM_SegmentIdentificationSequence), DCM_ReferencedSegmentNumber, frame.segment);
    }
  }

  void AddPixels(DcmItem& data) const {
    std::vector<std::uint16_t> all;
    for (const SmallFrame& frame : frames) all.insert(all.end(), frame.pixels.begin(), frame.pixels.end());
    if (bits == 16) {
      data.putAndInsertUint16Array(DCM_PixelData, all.data(), all.size());
      return;
    }
    const std::size_t pixels_in_byte = bits == 1 ? 8 : 1;
    std::vector<Uint8> bytes((all.size() + 2 * pixels_in_byte - 1) / (2 * pixels_in_byte) * 2, 0);
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (bits == 8) bytes[p] = static_cast<Uint8>(all[p]);
      if (bits == 1 && all[p] != 0) bytes[p / 8] |= static_cast<Uint8>(1 << p % 8);
    }
    data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), bytes.size());
  }

  // Fills a file; its segments are "liver" and, as a code alone, "Second rib" with the modifier "Left".
  void Fill(DcmFileFormat& file) const {
    DcmItem& data = *file.getDataset();
    Put(data, DCM_SOPClassUID, sop_class);
    Put(data, DCM_SOPInstanceUID, "1.2.3.4711");
    Put(data, DCM_PatientName, "DOE^JANE");
    Put(data, DCM_PatientID, "ID4711");
    Put(data, DCM_SegmentationType, type);
    Put(data, DCM_Rows, rows);
    Put(data, DCM_Columns, columns);
    Put(data, DCM_SamplesPerPixel, 1);
    Put(data, DCM_PhotometricInterpretation, "MONOCHROME2");
    Put(data, DCM_PixelRepresentation, 0);
    Put(data, DCM_BitsAllocated, bits);
    Put(data, DCM_BitsStored, bits);
    Put(data, DCM_HighBit, bits - 1);
    Put(data, DCM_NumberOfFrames, absl::StrCat(frames.size()));
    if (type == "FRACTIONAL") Put(data, DCM_MaximumFractionalValue, 100);
    DcmItem& liver = Item(data, DCM_SegmentSequence);
    Put(liver, DCM_SegmentNumber, 1);
    Put(liver, DCM_SegmentLabel, "liver");
    DcmItem& rib = Item(data, DCM_SegmentSequence, -2);
    Put(rib, DCM_SegmentNumber, 2);
    Put(rib, DCM_SegmentLabel, "Segment 2");
    DcmItem& code = Item(rib, DCM_SegmentedPropertyTypeCodeSequence);
    Put(code, DCM_CodeMeaning, "Second rib");
    Put(Item(code, DCM_SegmentedPropertyTypeModifierCodeSequence), DCM_CodeMeaning, "Left");
    AddGroups(data);
    AddPixels(data);
  }

  std::string Bytes(E_TransferSyntax transfer = EXS_LittleEndianExplicit) const {
    DcmFileFormat file;
    Fill(file);
    return BytesOf(file, transfer);
  }

  // Returns a file's bytes. RLE needs pixels of 8 bits.
  static std::string BytesOf(DcmFileFormat& file, E_TransferSyntax transfer = EXS_LittleEndianExplicit) {
    [[maybe_unused]] static const bool encodes = (DcmRLEEncoderRegistration::registerCodecs(), true);
    file.getDataset()->chooseRepresentation(transfer, nullptr);
    std::string buffer(1 << 20, '\0');
    DcmOutputBufferStream stream(buffer.data(), static_cast<offile_off_t>(buffer.size()));
    file.transferInit();
    file.write(stream, transfer, EET_UndefinedLength, nullptr);
    file.transferEnd();
    stream.flush();
    void* start = nullptr;
    offile_off_t length = 0;
    stream.flushBuffer(start, length);
    return buffer.substr(0, static_cast<std::size_t>(length));
  }
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_TESTS_IMAGING_SMALL_SEGMENTATION_H_
