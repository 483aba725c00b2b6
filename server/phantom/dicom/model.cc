// Surfaces of a phantom as encapsulated documents.
#include "absl/strings/str_cat.h"
#include "server/phantom/dicom/objects.h"

namespace phrenic::phantom {

absl::StatusOr<std::string> WriteModel(const DicomStudy& study, ModelFormat format, const std::string& model,
                                       double time, int phase) {
  const bool stl = format == ModelFormat::kStl;
  const std::string kind = stl ? "STL" : "OBJ";
  DcmFileFormat file;
  DcmItem& data = *file.getDataset();
  const DicomSeries series = {absl::StrCat(kind, " ", phase), "M3D", (stl ? 200 : 300) + phase,
                              absl::StrCat("Surfaces, phase ", phase), time};
  PutCommon(study, series, stl ? UID_EncapsulatedSTLStorage : UID_EncapsulatedOBJStorage,
            study.Uid(series.name + ", instance"), data);
  Put(data, DCM_InstanceNumber, "1");
  Put(data, DCM_BurnedInAnnotation, "NO");
  Put(data, DCM_AcquisitionDateTime, "");
  Put(data, DCM_DocumentTitle, absl::StrCat("Surfaces of a simulated breath, phase ", phase));
  data.insertEmptyElement(DCM_ConceptNameCodeSequence);
  Put(data, DCM_MIMETypeOfEncapsulatedDocument, stl ? "model/stl" : "model/obj");
  PutCode(data, DCM_MeasurementUnitsCodeSequence, {"mm", "mm"}, "UCUM");
  Put(data, DCM_ModelModification, "NO");
  Put(data, DCM_ModelMirroring, "NO");
  Put(data, DCM_ContentDescription, "Closed surfaces, LPS, mm");
  std::string padded = model;
  if (padded.size() % 2 == 1) padded.push_back(stl ? '\0' : '\n');
  data.putAndInsertUint32(DCM_EncapsulatedDocumentLength, static_cast<Uint32>(model.size()));
  data.putAndInsertUint8Array(DCM_EncapsulatedDocument, reinterpret_cast<const Uint8*>(padded.data()), padded.size());
  return BytesOf(file);
}

}  // namespace phrenic::phantom
