#include "server/session/export/saved_export.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/session/saving.h"
#include "server/store/saved_state.h"

namespace phrenic::session {

absl::StatusOr<std::string> SaveExport(const v1::CreateExportRequest& request, const ExportStart& start) {
  auto scene = SaveScene(*start.model, start.surfaces);
  if (!scene.ok()) return scene.status();
  v1::SavedExport saved;
  *saved.mutable_request() = request;
  *saved.mutable_scene() = *std::move(scene);
  *saved.mutable_parameters() = start.fork.parameters;
  saved.set_largest_stable_step(start.fork.stable_step);
  *saved.mutable_state() = store::Save(start.fork.state);
  saved.set_owner(start.owner);
  saved.set_owner_qualified(true);
  return saved.SerializeAsString();
}

absl::StatusOr<RestoredExport> RestoreExport(const store::SavedRecord& record, Models& models,
                                             absl::FunctionRef<std::string(const std::string& account)> account_of) {
  v1::SavedExport saved;
  if (!saved.ParseFromString(record.bytes)) return absl::DataLossError("the record in the store is not an export");
  if (!saved.owner_qualified()) saved.set_owner(account_of(saved.owner()));
  auto compiled = RestoreScene(saved.scene(), absl::StrCat("export ", record.id), saved.owner(), models);
  if (!compiled.ok()) return compiled.status();
  auto state = store::Restore(*compiled->model, saved.state());
  if (!state.ok()) return state.status();
  saved.mutable_request()->set_export_id(record.id);
  Fork fork{saved.parameters(), *std::move(state), saved.largest_stable_step()};
  return RestoredExport{std::move(*saved.mutable_request()),
                        {compiled->model, std::move(fork), std::move(compiled->surfaces), saved.owner()}};
}

}  // namespace phrenic::session
