// CT image series of a phantom.
#include "absl/strings/str_cat.h"
#include "server/phantom/dicom/objects.h"

namespace phrenic::phantom {

absl::StatusOr<std::string> WriteCtSlice(const DicomStudy& study, const PhantomPhase& rendered, int phase, int k) {
  const imaging::LabelVolume& volume = rendered.labels;
  const Eigen::Vector3d spacing = volume.Spacing(), at = volume.to_patient * Eigen::Vector3d(0, 0, k);
  const Eigen::Matrix3d axes = volume.to_patient.linear() * spacing.cwiseInverse().asDiagonal();
  DcmFileFormat file;
  DcmItem& data = *file.getDataset();
  const DicomSeries series = {absl::StrCat("ct ", phase), "CT", 1 + phase, absl::StrCat("CT-like, phase ", phase),
                              rendered.time};
  PutCommon(study, series, UID_CTImageStorage, study.Uid(absl::StrCat(series.name, ", slice ", k)), data);
  Put(data, DCM_ImageType, "DERIVED\\PRIMARY\\AXIAL");
  Put(data, DCM_AcquisitionNumber, absl::StrCat(1 + phase));
  Put(data, DCM_InstanceNumber, absl::StrCat(k + 1));
  Put(data, DCM_PatientPosition, "HFS");
  Put(data, DCM_BodyPartExamined, "CHEST");
  data.insertEmptyElement(DCM_KVP);
  PutDecimals(data, DCM_PixelSpacing, {spacing.y(), spacing.x()});
  PutDecimals(data, DCM_SliceThickness, {spacing.z()});
  PutDecimals(data, DCM_SpacingBetweenSlices, {spacing.z()});
  PutDecimals(data, DCM_SliceLocation, {at.z()});
  PutDecimals(data, DCM_ImagePositionPatient, {at.x(), at.y(), at.z()});
  PutDecimals(data, DCM_ImageOrientationPatient,
              {axes(0, 0), axes(1, 0), axes(2, 0), axes(0, 1), axes(1, 1), axes(2, 1)});
  Put(data, DCM_SamplesPerPixel, 1);
  Put(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  Put(data, DCM_Rows, volume.size.y());
  Put(data, DCM_Columns, volume.size.x());
  Put(data, DCM_BitsAllocated, 16);
  Put(data, DCM_BitsStored, 16);
  Put(data, DCM_HighBit, 15);
  Put(data, DCM_PixelRepresentation, 1);
  Put(data, DCM_RescaleIntercept, "0");
  Put(data, DCM_RescaleSlope, "1");
  Put(data, DCM_RescaleType, "HU");
  Put(data, DCM_WindowCenter, "40\\-600");
  Put(data, DCM_WindowWidth, "400\\1500");
  const std::size_t layer = static_cast<std::size_t>(volume.size.x()) * volume.size.y();
  const std::vector<Uint16> pixels(rendered.ct.begin() + static_cast<std::ptrdiff_t>(k * layer),
                                   rendered.ct.begin() + static_cast<std::ptrdiff_t>((k + 1) * layer));
  data.putAndInsertUint16Array(DCM_PixelData, pixels.data(), pixels.size());
  return BytesOf(file);
}

}  // namespace phrenic::phantom
