#include "server/imaging/dicom_text.h"

namespace phrenic::imaging {

std::string TextOf(DcmItem* item, const DcmTagKey& attribute) {
  OFString text;
  if (item == nullptr || item->findAndGetOFString(attribute, text).bad()) return "";
  return {text.c_str(), text.length()};
}

DcmItem* FirstItem(DcmItem* item, const DcmTagKey& sequence) {
  DcmItem* first = nullptr;
  return item != nullptr && item->findAndGetSequenceItem(sequence, first).good() ? first : nullptr;
}

Utf8::Utf8(DcmDataset& dataset) {
  if (DcmSpecificCharacterSet::isConversionAvailable()) {
    characters_.selectCharacterSet(dataset);
  }
}

std::string Utf8::operator()(const std::string& text) {
  OFString converted;
  if (!characters_ || characters_.convertString(text.data(), text.size(), converted).bad()) return text;
  return {converted.c_str(), converted.length()};
}

}  // namespace phrenic::imaging
