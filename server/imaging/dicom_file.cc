#include "server/imaging/dicom_file.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/oflog/oflog.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "server/imaging/dicom_stream.h"

namespace phrenic::imaging {
namespace {

constexpr std::size_t kPreamble = 128;
constexpr Uint32 kLongestUid = 64;
constexpr Uint32 kCopied = 4096;  // longer values stay in the file's bytes until they are asked for

absl::Status CheckTransferSyntax(DcmFileFormat& file) {
  DcmElement* element = nullptr;
  OFString uid;
  if (file.getMetaInfo()->findAndGetElement(DCM_TransferSyntaxUID, element).bad()) return absl::OkStatus();
  // A longer value may be missing, if it is the one where reading failed.
  if (element->getLength() > kLongestUid || element->getOFString(uid, 0).bad() || uid.empty()) return absl::OkStatus();
  if (DcmXfer(uid.c_str()).getXfer() != EXS_Unknown) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "its transfer syntax is unknown; save it as Explicit VR Little Endian, for example by gdcmconv --raw");
}

}  // namespace

bool IsDicom(std::string_view bytes) { return bytes.size() >= kPreamble + 4 && bytes.substr(kPreamble, 4) == "DICM"; }

void DicomFileDeleter::operator()(DcmFileFormat* file) const { delete file; }

absl::StatusOr<DicomFile> ParseDicom(std::string_view bytes) {
  [[maybe_unused]] static const bool silent = (OFLog::configure(OFLogger::OFF_LOG_LEVEL), true);
  if (!dcmDataDict.isDictionaryLoaded()) {
    return absl::FailedPreconditionError(
        "DCMTK's data dictionary cannot be read; unset DCMDICTPATH, or install libdcmtk17 again");
  }
  DicomStream stream({bytes, nullptr});
  DicomFile file(new DcmFileFormat);
  file->transferInit();
  const OFCondition read = file->read(stream, EXS_Unknown, EGL_noChange, kCopied);
  file->transferEnd();
  if (!stream.problem().empty()) return absl::InvalidArgumentError(stream.problem());
  if (absl::Status status = CheckTransferSyntax(*file); !status.ok()) return status;
  if (read.bad()) {
    return absl::InvalidArgumentError(
        absl::StrCat("the DICOM file is truncated or damaged near byte ", stream.tell(), "; download it again"));
  }
  return file;
}

}  // namespace phrenic::imaging
