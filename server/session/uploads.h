// Surface files that clients upload, identified by their content.
#ifndef PHRENIC_SERVER_SESSION_UPLOADS_H_
#define PHRENIC_SERVER_SESSION_UPLOADS_H_

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/meshio/meshio.h"
#include "server/record/spool_file.h"
#include "server/session/limits.h"

namespace phrenic::session {

// Keeps the most recently used files within the limits, in unnamed files that vanish when the server ends. Thread-safe.
class Uploads {
 public:
  struct File {
    std::string sha256, name;
    std::int64_t size = 0;
    std::string path() const { return std::string(kPrefix) + sha256; }
  };
  struct Begun {
    std::string id;             // empty if the server has the file already
    std::int64_t received = 0;  // [bytes]
    File file;
  };
  struct Finished {
    File file;
    meshio::Surface surface;  // [m]
  };
  // Keeps a file as long as this object exists, even if Uploads drops it.
  struct Held {
    std::string id;  // of its upload
    File file;
    std::shared_ptr<record::SpoolFile> spool;
    absl::StatusOr<std::string> Bytes() const;
  };
  static constexpr std::string_view kPrefix = "upload:";
  static constexpr std::size_t kMostChunk = std::size_t{4} << 20;  // [bytes]

  Uploads(const Limits& limits, std::string spool_folder);

  // Begin, Add and Finish an upload, with the errors of upload.proto. The oldest unfinished upload makes room for the
  // 17th. Clients that upload the same file at the same time share one upload: Add skips the bytes that it has, and
  // each client may finish it.
  absl::StatusOr<Begun> Begin(const std::string& name, std::int64_t size, const std::string& sha256)
      ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<std::int64_t> Add(const std::string& id, std::int64_t offset, std::string_view chunk)
      ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<Finished> Finish(const std::string& id, double unit_mm) ABSL_LOCKS_EXCLUDED(mutex_);
  std::vector<File> List() const ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status Delete(const std::string& path) ABSL_LOCKS_EXCLUDED(mutex_);

  // Returns the file of "upload:SHA256"; NOT_FOUND says to upload it again.
  absl::StatusOr<Held> Hold(const std::string& path) ABSL_LOCKS_EXCLUDED(mutex_);
  // Takes over a file of an earlier server, as if it had just been uploaded.
  absl::StatusOr<Held> Adopt(const std::string& name, std::string_view bytes) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the surface of "upload:SHA256" [m]; `unit` is the length of the file's unit [m]. The errors of Hold and of
  // the parser.
  absl::StatusOr<Mesh> Read(const std::string& path, double unit) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  absl::Status CheckFile(const std::string& name, std::int64_t size) const;
  absl::StatusOr<Finished> FinishedBefore(const std::string& id, double unit_mm) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status NoUpload(const std::string& id) const;
  std::list<Held>::iterator FindKept(std::string_view sha256) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::list<Held>::iterator FindPending(const std::string& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Keep(Held kept) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const Limits limits_;
  const std::string spool_folder_;
  mutable absl::Mutex mutex_;
  std::list<Held> kept_ ABSL_GUARDED_BY(mutex_);     // last used first
  std::list<Held> pending_ ABSL_GUARDED_BY(mutex_);  // oldest first
  int begun_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_UPLOADS_H_
