#include "server/access/rules.h"

#include <iterator>
#include <map>
#include <string>

namespace phrenic::access {
namespace {

constexpr auto kNone = v1::ACCESS_ROLE_UNSPECIFIED;
constexpr auto kViewer = v1::ACCESS_ROLE_VIEWER;
constexpr auto kController = v1::ACCESS_ROLE_CONTROLLER;
constexpr auto kOwner = v1::ACCESS_ROLE_OWNER;
constexpr bool kChanges = true, kReads = false, kOpen = true;

// Columns as in Rule. The services also check that exports, studies, patients and uploads belong to the caller
// (AccessGuard::CheckOwns).
constexpr Rule kRules[] = {
    {"ServerService.GetServer", kNone, kNone, kReads, kOpen},
    {"AccessService.GetAccess", kNone, kNone, kReads, kOpen},
    {"AccessService.CreateLink", kNone, kOwner, kChanges},
    {"AccessService.ListLinks", kNone, kOwner, kReads},
    {"AccessService.RevokeLink", kNone, kOwner, kChanges},
    {"SceneService.ListScenes", kNone, kNone, kReads},
    {"SceneService.DescribeScene", kOwner, kNone, kReads},
    {"SessionService.CreateSession", kOwner, kNone, kChanges},
    {"SessionService.ForkSession", kOwner, kViewer, kChanges},
    {"SessionService.ListSessions", kNone, kNone, kReads},
    {"SessionService.GetSession", kNone, kViewer, kReads},
    {"SessionService.GetState", kNone, kViewer, kReads},
    {"SessionService.DeleteSession", kNone, kOwner, kChanges},
    {"SessionService.PlaySession", kNone, kController, kChanges},
    {"SessionService.PauseSession", kNone, kController, kChanges},
    {"SessionService.StepSession", kNone, kController, kChanges},
    {"SessionService.Advance", kNone, kController, kChanges},
    {"SessionService.ResetSession", kNone, kController, kChanges},
    {"SessionService.UpdateParameters", kNone, kController, kChanges},
    {"SessionService.PullSession", kNone, kController, kChanges},
    {"SessionService.SubmitAnswer", kNone, kViewer, kReads},  // changes no motion; one per pupil and question
    {"SessionService.ListAnswers", kNone, kOwner, kReads},
    {"SessionService.DeleteAnswers", kNone, kOwner, kChanges},
    {"ControlService.EnterSession", kNone, kController, kReads},  // repeated as a heartbeat
    {"ControlService.TakeControl", kNone, kController, kChanges},
    {"ControlService.HandControl", kNone, kController, kChanges},
    {"ControlService.ReleaseControl", kNone, kController, kChanges},
    {"ControlService.ShowCamera", kNone, kController, kReads},
    {"FrameService.GetGeometry", kNone, kViewer, kReads},
    {"FrameService.GetBasis", kNone, kViewer, kReads},
    {"FrameService.WatchFrames", kNone, kViewer, kReads},
    {"FrameService.AckFrames", kNone, kViewer, kReads, !kOpen, true},
    {"FrameService.GetForces", kNone, kViewer, kReads},
    {"SampleService.WatchSamples", kNone, kViewer, kReads},
    {"SampleService.ReadSamples", kNone, kViewer, kReads, !kOpen, true},  // it counts the costly calls itself
    {"TissueService.GetTissue", kNone, kViewer, kReads},
    {"TissueService.ReadTissue", kNone, kViewer, kReads},
    {"ReferenceService.GetReferences", kNone, kViewer, kReads},
    {"CompareService.Compare", kViewer, kNone, kReads},
    {"ExportService.ListFormats", kNone, kNone, kReads},
    {"ExportService.CreateExport", kNone, kController, kChanges},
    {"ExportService.WatchExport", kNone, kNone, kReads},
    {"ExportService.ListExports", kNone, kNone, kReads},
    {"ExportService.DeleteExport", kNone, kNone, kChanges},
    {"ExportService.DownloadExport", kNone, kNone, kChanges},
    {"UploadService.ListSurfaceFormats", kNone, kNone, kReads},
    {"UploadService.BeginUpload", kOwner, kNone, kChanges},
    {"UploadService.AddUploadChunk", kOwner, kNone, kReads},  // BeginUpload is audited
    {"UploadService.FinishUpload", kOwner, kNone, kChanges},
    {"UploadService.ListUploads", kOwner, kNone, kReads},
    {"UploadService.DeleteUpload", kOwner, kNone, kChanges},
    {"PatientService.InspectLabels", kOwner, kNone, kReads},
    {"PatientService.CreatePatient", kOwner, kNone, kChanges},
    {"PatientService.WatchPatient", kNone, kNone, kReads},
    {"PatientService.ListPatients", kNone, kNone, kReads},
    {"PatientService.DeletePatient", kNone, kNone, kChanges},
    {"StudyService.CreateStudy", kOwner, kNone, kChanges},
    {"StudyService.WatchStudy", kNone, kNone, kReads},
    {"StudyService.ListStudies", kNone, kNone, kReads},
    {"StudyService.DeleteStudy", kNone, kNone, kChanges},
    {"StudyService.GetStudyPage", kNone, kNone, kReads},
    {"StudyService.CheckPhysiology", kOwner, kNone, kReads},
    {"StudyService.RunBatch", kOwner, kNone, kReads},
    {"FitService.FitMotion", kOwner, kNone, kReads},
    {"FitService.StudyMotion", kOwner, kNone, kReads},
};

constexpr std::string_view kRoleNames[] = {"", "viewer", "controller", "owner", "admin"};

std::map<std::string, const Rule*, std::less<>> ByRequest() {
  std::map<std::string, const Rule*, std::less<>> found;
  for (const Rule& rule : kRules) {
    found[std::string("phrenic.v1.").append(rule.method.substr(rule.method.find('.') + 1)).append("Request")] = &rule;
  }
  return found;
}

}  // namespace

std::span<const Rule> Rules() { return kRules; }

const Rule* RuleOf(std::string_view request_type) {
  static const auto rules = ByRequest();
  const auto found = rules.find(request_type);
  return found == rules.end() ? nullptr : found->second;
}

std::string_view NameOf(v1::AccessRole role) {
  const auto index = static_cast<std::size_t>(role);
  return index < std::size(kRoleNames) ? kRoleNames[index] : "";
}

v1::AccessRole RoleOf(std::string_view name) {
  for (std::size_t i = 1; i < std::size(kRoleNames); ++i) {
    if (kRoleNames[i] == name) return static_cast<v1::AccessRole>(i);
  }
  return v1::ACCESS_ROLE_UNSPECIFIED;
}

}  // namespace phrenic::access
