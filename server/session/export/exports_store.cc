// Exports in a store, and back.
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/session/export/exports.h"
#include "server/session/saving.h"
#include "server/store/saved_state.h"

namespace phrenic::session {

absl::StatusOr<std::string> Exports::Record(const v1::CreateExportRequest& request, const Start& start) const {
  if (store_ == nullptr) return "";
  auto scene = SaveScene(*start.model, start.surfaces);
  if (!scene.ok()) return scene.status();
  v1::SavedExport saved;
  *saved.mutable_request() = request;
  *saved.mutable_scene() = *std::move(scene);
  *saved.mutable_parameters() = start.fork.parameters;
  saved.set_largest_stable_step(start.fork.stable_step);
  *saved.mutable_state() = store::Save(start.fork.state);
  saved.set_owner(start.owner);
  return saved.SerializeAsString();
}

void Exports::Forget(const std::string& id) const {
  if (store_ != nullptr) store_->Remove(kExportRecord, id);
}

absl::Status Exports::RestoreOne(Models& models, const store::SavedRecord& record, std::string& owner) {
  v1::SavedExport saved;
  if (!record.problem.ok()) return record.problem;
  if (!saved.ParseFromString(record.bytes)) return absl::DataLossError("what is in the store is no export");
  auto compiled = RestoreScene(saved.scene(), absl::StrCat("export ", record.id), models);
  if (!compiled.ok()) return compiled.status();
  auto state = store::Restore(*compiled->model, saved.state());
  if (!state.ok()) return state.status();
  owner = saved.owner();
  saved.mutable_request()->set_export_id(record.id);
  Session::Fork fork{saved.parameters(), *std::move(state), saved.largest_stable_step()};
  return Queue(saved.request(), {compiled->model, std::move(fork), std::move(compiled->surfaces), owner}).status();
}

void Exports::Restore(const std::vector<store::SavedRecord>& records, Models& models,
                      absl::FunctionRef<void(const std::string& id, const std::string& owner)> found,
                      std::map<std::string, absl::Status>& lost) {
  for (const store::SavedRecord& record : records) {
    if (record.kind != kExportRecord) continue;
    std::string owner;
    const absl::Status restored = RestoreOne(models, record, owner);
    if (restored.ok()) {
      found(record.id, owner);
    } else {
      lost[absl::StrCat(kExportRecord, " ", record.id)] = restored;
    }
  }
}

}  // namespace phrenic::session
