// Parses DICOM files in memory by DCMTK (https://dcmtk.org), within bounds that hostile files cannot exceed.
#ifndef PHRENIC_SERVER_IMAGING_DICOM_FILE_H_
#define PHRENIC_SERVER_IMAGING_DICOM_FILE_H_

#include <memory>
#include <string_view>

#include "absl/status/statusor.h"

class DcmFileFormat;

namespace phrenic::imaging {

// True if the file is DICOM by its content: "DICM" at byte 128 (PS3.10, 7.1).
bool IsDicom(std::string_view bytes);

struct DicomFileDeleter {
  void operator()(DcmFileFormat* file) const;
};
using DicomFile = std::unique_ptr<DcmFileFormat, DicomFileDeleter>;

// Parses a file of any transfer syntax that DCMTK knows, also deflated. Values of more than 4 kB stay in `bytes`, which
// must outlive the result, until they are asked for. A value is allocated only if the file has its bytes. Bounds:
// nested sequences, elements, time to sort elements, size of inflated data. Messages of DCMTK, which may quote a
// patient's data, are disabled. INVALID_ARGUMENT with problem and remedy, and no value of the file. Thread-safe.
absl::StatusOr<DicomFile> ParseDicom(std::string_view bytes);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DICOM_FILE_H_
