#include "server/session/patient/patient_job.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/imaging/dicom_file.h"
#include "server/imaging/label_file.h"
#include "server/imaging/labels/label_map.h"
#include "server/mesh/units.h"
#include "server/meshio/meshio.h"
#include "server/session/patient/label_table.h"

namespace phrenic::session {
namespace {

constexpr std::int64_t kFirstBytes = 512;
constexpr double kReading = 0.05;           // share of the progress
constexpr double kSmallestProgress = 0.01;  // smallest change of progress that is reported
constexpr char kPatientName[] = "patient", kTitle[] = "A patient from a segmentation";  // of every patient's scene

absl::Status CheckVerdict(const v1::Readiness& readiness, bool anyway) {
  if (anyway || readiness.verdict() != v1::READINESS_VERDICT_NOT_USABLE) return absl::OkStatus();
  return absl::FailedPreconditionError(
      absl::StrCat("the volume is not usable, and no patient was made: ", readiness.findings(0).what(),
                   ". The report lists every finding; set `anyway` to make the patient nevertheless"));
}

}  // namespace

absl::StatusOr<imaging::LabelInput> ReadLabelUpload(const Uploads::Held& labels, const std::string& map,
                                                    const std::function<bool()>& stopped) {
  const bool plain = std::all_of(map.begin(), map.end(),
                                 [](char c) { return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '-'; });
  const absl::StatusOr<std::vector<imaging::MapFit>> maps =
      plain ? imaging::ReadMaps(map) : absl::NotFoundError("a name has letters, digits and \"-\"");
  if (!maps.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("map: there is no label map of this name; give one of ",
                                                   absl::StrJoin(imaging::InstalledLabelMaps(), ", ")));
  }
  const absl::StatusOr<std::string> bytes = labels.Bytes();
  if (!bytes.ok()) return bytes.status();
  return imaging::ParseLabelInput(Uploads::kLabelsName, *bytes, map, kMostVoxels, stopped);
}

std::string LabelFormat(const Uploads::Held& labels) {
  std::string start(static_cast<std::size_t>(std::min(kFirstBytes, labels.spool->size())), '\0');
  const absl::Status read = labels.spool->Read(0, start.data(), start.size());
  if (read.ok() && imaging::IsArchive(start)) return "archive";
  return read.ok() && imaging::IsDicom(start) ? "DICOM" : "NIfTI";
}

absl::StatusOr<imaging::Patient> PatientJob::Make(imaging::PatientProgress progress) const {
  absl::StatusOr<imaging::LabelInput> input =
      ReadLabelUpload(start_.labels, start_.request.map(), [&] { return !progress(0, "reading"); });
  if (!input.ok()) return input.status();
  const bool named = !start_.request.labels().empty();
  const auto map = ApplyLabels(named ? start_.request.labels() : input->meanings.labels(), input->volume);
  if (!map.ok()) return map.status();
  imaging::PatientOptions options;
  options.name = kPatientName;
  if (start_.request.has_vertices()) options.diaphragm.vertices = start_.request.vertices();
  if (start_.request.has_edge_length_mm()) options.edge_length = start_.request.edge_length_mm();
  return imaging::MakePatient(input->volume, *map, start_.pattern, options, [&](double done, std::string_view doing) {
    return progress(kReading + (1 - kReading) * done, doing);
  });
}

absl::Status PatientJob::UploadSurfaces(const std::vector<imaging::PatientBody>& bodies) {
  std::map<std::string, std::string> paths;  // of uploads, by that in the scene
  for (const imaging::PatientBody& body : bodies) {
    const std::string file = absl::StrCat(body.name, ".msh");
    const absl::StatusOr<std::string> bytes = meshio::Write(file, body.mesh, kMillimetre);
    if (!bytes.ok()) return bytes.status();
    absl::StatusOr<Uploads::Held> held = uploads_.Adopt(start_.by, file, *bytes);
    if (!held.ok()) return held.status();
    paths.emplace(absl::StrCat(kPatientName, "/", file), held->file.path());
    surfaces_.push_back(*std::move(held));
  }
  for (v1::Body& body : *scene_.mutable_bodies()) {
    if (const auto path = paths.find(body.file().path()); path != paths.end()) {
      body.mutable_file()->set_path(path->second);
    }
  }
  for (const Uploads::Held& surface : surfaces_) {
    if (uploads_.Hold(start_.by, surface.file.path()).ok()) continue;
    return absl::ResourceExhaustedError(
        "your uploaded files leave no room for the patient's surfaces; delete uploads that you do not need");
  }
  return absl::OkStatus();
}

absl::Status PatientJob::Run(jobs::Progress<v1::Patient> progress) {
  const auto tell = [&](double done, std::string_view doing) {
    return progress(done, [&](v1::Patient& message) {
      const bool changed = done >= message.progress() + kSmallestProgress || message.doing() != doing;
      message.set_doing(std::string(doing));
      return changed;
    });
  };
  if (!tell(0, "reading")) return absl::CancelledError("making the patient was cancelled");
  absl::StatusOr<imaging::Patient> patient = Make(tell);
  if (!patient.ok()) return patient.status();
  report_ = std::move(patient->report);
  absl::Status verdict = CheckVerdict(report_.readiness(), start_.request.anyway());
  if (!verdict.ok()) return verdict;
  scene_ = std::move(patient->scene);
  scene_.set_title(kTitle);
  return UploadSurfaces(patient->bodies);
}

void PatientJob::Finish(const absl::Status& status, absl::Time /*expires*/, v1::Patient& message) {
  message.set_doing("");
  if (report_.has_readiness()) *message.mutable_report() = std::move(report_);
  if (status.ok()) {
    *message.mutable_scene() = std::move(scene_);
  } else {
    surfaces_.clear();
  }
  start_.labels = {};
}

}  // namespace phrenic::session
