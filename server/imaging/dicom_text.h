// Texts of DICOM data sets.
#ifndef PHRENIC_SERVER_IMAGING_DICOM_TEXT_H_
#define PHRENIC_SERVER_IMAGING_DICOM_TEXT_H_

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmdata/dctk.h>

#include <string>

namespace phrenic::imaging {

// Returns the first value of an attribute; empty if it is missing or `item` is null.
std::string TextOf(DcmItem* item, const DcmTagKey& attribute);

// Returns the first item of a sequence; null if it has none or `item` is null.
DcmItem* FirstItem(DcmItem* item, const DcmTagKey& sequence);

// Converts to UTF-8 from the character set of a data set. Texts are unchanged if it is unknown.
class Utf8 {
 public:
  explicit Utf8(DcmDataset& dataset);
  std::string operator()(const std::string& text);

 private:
  DcmSpecificCharacterSet characters_;
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DICOM_TEXT_H_
