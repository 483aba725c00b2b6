#include "server/session/patient/patients.h"

#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/imaging/labels/label_map.h"
#include "server/session/patient/label_table.h"

namespace phrenic::session {
namespace {

constexpr char kPattern[] = "thorax";
constexpr int kMostNamed = 1000;  // labels of a request

}  // namespace

static_assert(static_cast<int>(jobs::State::kQueued) == v1::PATIENT_STATE_QUEUED);
static_assert(static_cast<int>(jobs::State::kRunning) == v1::PATIENT_STATE_RUNNING);
static_assert(static_cast<int>(jobs::State::kDone) == v1::PATIENT_STATE_DONE);
static_assert(static_cast<int>(jobs::State::kFailed) == v1::PATIENT_STATE_FAILED);

Patients::Patients(Models& models, Uploads& uploads, const Limits& limits, const Clock& clock)
    : models_(models),
      uploads_(uploads),
      queue_({.noun = {"patient", "patients", "a"},
              .threads = 1,
              .kept = limits.kept_exports,
              .share = limits.share,
              .lifetime = absl::Minutes(limits.export_minutes)},
             clock, jobs::Records("patient", nullptr)) {}

absl::StatusOr<v1::InspectLabelsResponse> Patients::Inspect(const v1::InspectLabelsRequest& request,
                                                            const Requester& by, const std::function<bool()>& stopped) {
  const auto labels = uploads_.Hold(by, request.path());
  if (!labels.ok()) return labels.status();
  const auto names = imaging::ReadLabelMap(imaging::kNamesMap);
  if (!names.ok()) return names.status();
  const auto input = ReadLabelUpload(*labels, request.map(), stopped);
  if (!input.ok()) return input.status();
  auto table = DescribeLabels(*input, imaging::WithCommonNames(*names));
  if (!table.ok()) return table;
  table->set_format(LabelFormat(*labels));
  return table;
}

absl::StatusOr<v1::Patient> Patients::Add(const v1::CreatePatientRequest& request, const Requester& by) {
  if (request.labels_size() > kMostNamed) {
    return absl::InvalidArgumentError(
        absl::StrCat("labels: ", request.labels_size(), " are named; ", kMostNamed, " are the most"));
  }
  auto labels = uploads_.Hold(by, request.path());
  if (!labels.ok()) return labels.status();
  auto pattern = models_.catalogue().Find(kPattern);
  if (!pattern.ok()) return pattern.status();
  Requester owner = {.owner = by.owner};
  v1::Patient message;
  message.set_doing("waiting for earlier patients");
  auto job = std::make_shared<PatientJob>(
      PatientStart{*std::move(labels), request, *std::move(pattern), std::move(owner)}, uploads_);
  return queue_.Add(by.owner, "", "patient", std::move(message), std::move(job));
}

}  // namespace phrenic::session
