#include "server/phantom/dicom/study.h"

#include <dcmtk/dcmdata/dcostrmb.h>

#include <algorithm>
#include <cmath>

#include "absl/numeric/int128.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/crypto/sha256.h"

namespace phrenic::phantom {
namespace {

constexpr const char* kDay = "19700101";
constexpr std::size_t kLongestText = 64;  // of VR LO [bytes]: not longer for readers that count bytes

// Returns the characters of a UTF-8 text that have room in an attribute.
std::string Shortened(std::string text) {
  std::size_t end = std::min(text.size(), kLongestText);
  const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80; };
  while (end > 0 && end < text.size() && continues(end)) --end;
  text.resize(end);
  std::replace(text.begin(), text.end(), '\\', '/');
  return text;
}

// Returns a time after midnight as VR TM has it.
std::string TimeOf(double seconds) {
  const long long milliseconds = std::llround(1e3 * seconds), minutes = milliseconds / 60000;
  return absl::StrFormat("%02d%02d%02d.%03d", minutes / 60 % 24, minutes % 60, milliseconds / 1000 % 60,
                         milliseconds % 1000);
}

std::string Decimal(absl::uint128 number) {
  std::string digits;
  for (; number != 0; number /= 10) digits.push_back(static_cast<char>('0' + static_cast<int>(number % 10)));
  return {digits.rbegin(), digits.rend()};
}

}  // namespace

std::string UidOf(std::string_view text) {
  const std::string hex = Sha256Hex(text);
  absl::uint128 number = 0;
  for (const char digit : hex.substr(0, 32)) {
    number = number * 16 + static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'a' + 10);
  }
  const absl::uint128 version = absl::uint128(0xF) << 76, variant = absl::uint128(0x3) << 62;
  number = (number & ~version & ~variant) | absl::uint128(0x8) << 76 | absl::uint128(0x2) << 62;
  return "2.25." + Decimal(number);
}

std::string DicomStudy::Uid(std::string_view what) const { return UidOf(absl::StrCat(key, "\n", std::string(what))); }

void Put(DcmItem& item, const DcmTagKey& attribute, const std::string& value) {
  item.putAndInsertString(DcmTag(attribute), value.c_str());
}

void Put(DcmItem& item, const DcmTagKey& attribute, int value) {
  item.putAndInsertUint16(DcmTag(attribute), static_cast<Uint16>(value));
}

void PutDecimals(DcmItem& item, const DcmTagKey& attribute, std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) absl::StrAppendFormat(&text, "%s%.8g", text.empty() ? "" : "\\", number);
  Put(item, attribute, text);
}

DcmItem& AddItem(DcmItem& parent, const DcmTagKey& sequence) {
  DcmItem* item = nullptr;
  parent.findOrCreateSequenceItem(DcmTag(sequence), item, -2);
  return *item;
}

void PutCode(DcmItem& parent, const DcmTagKey& sequence, const Code& code, const std::string& scheme) {
  DcmItem& item = AddItem(parent, sequence);
  Put(item, DCM_CodeValue, code.value);
  Put(item, DCM_CodingSchemeDesignator, scheme);
  Put(item, DCM_CodeMeaning, code.meaning);
}

void PutCommon(const DicomStudy& study, const DicomSeries& series, const std::string& sop_class,
               const std::string& instance, DcmItem& data) {
  Put(data, DCM_SpecificCharacterSet, "ISO_IR 192");
  Put(data, DCM_SOPClassUID, sop_class);
  Put(data, DCM_SOPInstanceUID, instance);
  for (const DcmTagKey& empty : {DCM_PatientName, DCM_PatientID, DCM_PatientBirthDate, DCM_PatientSex, DCM_StudyID,
                                 DCM_AccessionNumber, DCM_ReferringPhysicianName, DCM_PositionReferenceIndicator}) {
    data.insertEmptyElement(empty);
  }
  Put(data, DCM_StudyInstanceUID, study.Uid("study"));
  Put(data, DCM_StudyDate, kDay);
  Put(data, DCM_StudyTime, "000000");
  Put(data, DCM_StudyDescription, Shortened(study.description));
  Put(data, DCM_Modality, series.modality);
  Put(data, DCM_SeriesInstanceUID, study.Uid(series.name));
  Put(data, DCM_SeriesNumber, absl::StrCat(series.number));
  Put(data, DCM_SeriesDescription, Shortened(series.description));
  Put(data, DCM_SeriesDate, kDay);
  Put(data, DCM_SeriesTime, TimeOf(series.time));
  Put(data, DCM_ContentDate, kDay);
  Put(data, DCM_ContentTime, TimeOf(series.time));
  Put(data, DCM_FrameOfReferenceUID, study.FrameOfReference());
  Put(data, DCM_Manufacturer, "Phrenic");
  Put(data, DCM_ManufacturerModelName, "Phrenic phantom");
  Put(data, DCM_DeviceSerialNumber, "1");
  Put(data, DCM_SoftwareVersions, Shortened(study.software.empty() ? "unknown" : study.software));
}

absl::StatusOr<std::string> BytesOf(DcmFileFormat& file) {
  constexpr E_TransferSyntax kTransfer = EXS_LittleEndianExplicit;
  constexpr std::size_t kHeader = 1 << 16;  // preamble, meta information, and lengths that change
  file.getDataset()->chooseRepresentation(kTransfer, nullptr);
  std::string bytes(file.getDataset()->calcElementLength(kTransfer, EET_ExplicitLength) + kHeader, '\0');
  DcmOutputBufferStream stream(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  file.transferInit();
  const OFCondition written = file.write(stream, kTransfer, EET_ExplicitLength, nullptr);
  file.transferEnd();
  stream.flush();
  void* start = nullptr;
  offile_off_t length = 0;
  stream.flushBuffer(start, length);
  if (written.bad()) return absl::InternalError(absl::StrCat("a DICOM object cannot be written: ", written.text()));
  bytes.resize(static_cast<std::size_t>(length));
  return bytes;
}

}  // namespace phrenic::phantom
