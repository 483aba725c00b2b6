// What a store keeps of an export, from which a restarted server makes the same file again.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_SAVED_EXPORT_H_
#define PHRENIC_SERVER_SESSION_EXPORT_SAVED_EXPORT_H_

#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/export.pb.h"
#include "server/session/export/export_job.h"
#include "server/session/models.h"
#include "server/store/layout.h"

namespace phrenic::session {

inline constexpr char kExportRecord[] = "export";  // the kind in a store

// `start` holds the uploaded files again.
struct RestoredExport {
  v1::CreateExportRequest request;  // with the export's id
  ExportStart start;
};

// Returns a v1::SavedExport as bytes: the request, the scene, the parameters and the state. The errors of SaveScene.
// The uploaded files are in it.
absl::StatusOr<std::string> SaveExport(const v1::CreateExportRequest& request, const ExportStart& start);
// `account_of` gives the present name of the account that the record names, if an earlier version wrote it. DATA_LOSS
// if the record is no export; the errors of RestoreScene and of store::Restore. Compiles the scene on the calling
// thread. FAILED_PRECONDITION if the scene compiles to another model in this build.
absl::StatusOr<RestoredExport> RestoreExport(const store::SavedRecord& record, Models& models,
                                             absl::FunctionRef<std::string(const std::string& account)> account_of);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_SAVED_EXPORT_H_
