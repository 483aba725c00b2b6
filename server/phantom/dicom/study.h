// What all DICOM objects of a phantom share: patient, study, equipment, frame of reference, unique identifiers.
#ifndef PHRENIC_SERVER_PHANTOM_DICOM_STUDY_H_
#define PHRENIC_SERVER_PHANTOM_DICOM_STUDY_H_

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/phantom/dicom/snomed.h"

namespace phrenic::phantom {

// Unique identifiers follow from `key`, so that the same phantom has the same ones on every machine. The patient has
// neither name nor number; dates that DICOM requires are 1970-01-01.
struct DicomStudy {
  std::string key;          // what the phantom was made of: scene, parameters, spacing
  std::string description;  // of the study; what exceeds 64 bytes of UTF-8 is cut off
  std::string software;     // version of Phrenic

  // Returns the identifier of something in the study.
  std::string Uid(std::string_view what) const;
  std::string FrameOfReference() const { return Uid("frame of reference"); }
};

// Returns a DICOM unique identifier "2.25.N" of a text: N is the first 122 bits of its SHA-256 as a UUID of version 8
// (PS3.5, B.2; RFC 9562).
std::string UidOf(std::string_view text);

// A series: one kind of object of one phase.
struct DicomSeries {
  std::string name;  // unique in the study: "segmentation 3"
  std::string modality;
  int number = 1;
  std::string description;
  double time = 0;  // of the phase after the first one [s]
};

// Sets an attribute. A value that the VR does not allow is a defect of this program.
void Put(DcmItem& item, const DcmTagKey& attribute, const std::string& value);
void Put(DcmItem& item, const DcmTagKey& attribute, int value);  // US
void PutDecimals(DcmItem& item, const DcmTagKey& attribute, std::initializer_list<double> numbers);
// Returns a new item of a sequence.
DcmItem& AddItem(DcmItem& parent, const DcmTagKey& sequence);
void PutCode(DcmItem& parent, const DcmTagKey& sequence, const Code& code, const std::string& scheme = "SCT");

// Sets patient, study, series, frame of reference, equipment and SOP instance.
void PutCommon(const DicomStudy& study, const DicomSeries& series, const std::string& sop_class,
               const std::string& instance, DcmItem& data);

// Returns the bytes of a file in explicit VR little endian. INTERNAL if DCMTK cannot write it.
absl::StatusOr<std::string> BytesOf(DcmFileFormat& file);

}  // namespace phrenic::phantom

#endif  // PHRENIC_SERVER_PHANTOM_DICOM_STUDY_H_
