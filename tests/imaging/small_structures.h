// Small DICOM RT Structure Sets, written by DCMTK to memory.
#ifndef PHRENIC_TESTS_IMAGING_SMALL_STRUCTURES_H_
#define PHRENIC_TESTS_IMAGING_SMALL_STRUCTURES_H_

#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/imaging/small_segmentation.h"

namespace phrenic::imaging {

struct SmallContour {
  std::vector<double> numbers;  // x y z of each vertex [mm]
  std::string type = "CLOSED_PLANAR";
  int stated = -1;  // number of points; -1: as many as there are
};

struct SmallRegion {
  int number = 1;
  std::string name;
  std::vector<SmallContour> contours;
};

// Returns the contour of a rectangle at a height [mm].
inline SmallContour Rectangle(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y0, z, x1, y0, z, x1, y1, z, x0, y1, z}};
}

// Returns a box: rectangles at heights 0, `step`, ... below `height` [mm].
inline std::vector<SmallContour> Box(double x0, double x1, double y0, double y1, double height, double step = 3) {
  std::vector<SmallContour> contours;
  for (double z = 0; z < height; z += step) contours.push_back(Rectangle(x0, x1, y0, y1, z));
  return contours;
}

// Returns a file's bytes.
inline std::string StructuresFile(const std::vector<SmallRegion>& regions) {
  using S = SmallSegmentation;
  DcmFileFormat file;
  DcmItem& data = *file.getDataset();
  S::Put(data, DCM_SOPClassUID, UID_RTStructureSetStorage);
  S::Put(data, DCM_SOPInstanceUID, "1.2.3.4711");
  S::Put(data, DCM_PatientName, "DOE^JANE");
  S::Put(data, DCM_PatientID, "ID4711");
  S::Put(data, DCM_Modality, "RTSTRUCT");
  for (const SmallRegion& region : regions) {
    DcmItem& named = S::Item(data, DCM_StructureSetROISequence, -2);
    S::Put(named, DCM_ROINumber, absl::StrCat(region.number));
    S::Put(named, DCM_ROIName, region.name);
    DcmItem& drawn = S::Item(data, DCM_ROIContourSequence, -2);
    S::Put(drawn, DCM_ReferencedROINumber, absl::StrCat(region.number));
    for (const SmallContour& contour : region.contours) {
      DcmItem& item = S::Item(drawn, DCM_ContourSequence, -2);
      S::Put(item, DCM_ContourGeometricType, contour.type);
      const int points = contour.stated >= 0 ? contour.stated : static_cast<int>(contour.numbers.size() / 3);
      S::Put(item, DCM_NumberOfContourPoints, absl::StrCat(points));
      S::Put(item, DCM_ContourData, Decimals(contour.numbers));
    }
  }
  return S::BytesOf(file);
}

}  // namespace phrenic::imaging

#endif  // PHRENIC_TESTS_IMAGING_SMALL_STRUCTURES_H_
