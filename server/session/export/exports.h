// The exports of a server: queued, a few running at a time, their files kept for a while.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORTS_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORTS_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/jobs/queue.h"
#include "server/schema/clock.h"
#include "server/session/export/export_job.h"
#include "server/session/limits.h"
#include "server/session/models.h"
#include "server/store/store.h"

namespace phrenic::session {

// Thread-safe. limits.exports threads of its own run the exports. The server owns one (service/server.cc). Exports step
// copies of a session's state, while the session goes on.
class Exports {
 public:
  using Start = ExportStart;
  using Seen = jobs::Queue<ExportJob>::Seen;

  // `clock` and `store` outlive it. A null store keeps nothing. Spool files are unnamed and lie in `spool_folder`.
  // `page_template` is the path of the viewer's offline.html.
  Exports(const Limits& limits, std::string spool_folder, const Clock& clock, store::Store* store = nullptr,
          std::string page_template = "");

  // Queues the exports of an earlier server again, which make the same files. `account_of` gives the present name of
  // the account that the record names. `lost` gets the reason why one could not be restored, by "export ID". Requires:
  // no other call was made yet.
  void Restore(const std::vector<store::SavedRecord>& records, Models& models,
               absl::FunctionRef<std::string(const std::string& account)> account_of,
               std::map<std::string, absl::Status>& lost);

  // Plans the export, queues it, and returns once the store has it on the disk. An empty id is chosen from the
  // session's. The errors of PlanExport and jobs::Queue::Add; at most limits.kept_exports are kept. RESOURCE_EXHAUSTED
  // if no export may go for it, or if the disk is full.
  absl::StatusOr<v1::Export> Add(const v1::CreateExportRequest& request, Start start);
  // The same as the methods of jobs::Queue.
  absl::StatusOr<Seen> Wait(const std::string& id, std::int64_t seen, absl::Duration longest) const {
    return queue_.Wait(id, seen, longest);
  }
  absl::Status Watch(const std::string& id, absl::FunctionRef<bool()> gone,
                     absl::FunctionRef<bool(v1::Export message)> write) const {
    return queue_.Watch(id, gone, write);
  }
  std::vector<v1::Export> List(const std::function<bool(const std::string& owner)>& visible = nullptr) const {
    return queue_.List(visible);
  }
  std::optional<std::string> OwnerOf(const std::string& id) const { return queue_.OwnerOf(id); }
  absl::Status Delete(const std::string& id) { return queue_.Delete(id); }
  // Returns the file of an export that is done; it lives as long as a caller holds it. FAILED_PRECONDITION before that.
  // The errors of jobs::Queue::Read; the message of a failed export has its problem.
  absl::StatusOr<std::shared_ptr<const record::SpoolFile>> File(const std::string& id) const;

 private:
  // RESOURCE_EXHAUSTED if the states of the exports that wait or run would be those of too many large scenes.
  absl::Status CheckVertices(const Model& model, const std::string& owner) const;
  // The errors of PlanExport, record::SpoolFile::Open and SaveExport.
  absl::StatusOr<std::shared_ptr<ExportJob>> MakeJob(const v1::CreateExportRequest& request, Start start) const;

  const std::int64_t vertices_;  // Limits::vertices
  const std::string spool_folder_;
  const std::string page_template_;
  const Clock& clock_;
  jobs::Queue<ExportJob> queue_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORTS_H_
