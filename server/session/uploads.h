// Surface files that clients gave: kept by content, the last used ones as long as there is room.
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

// Any thread may call. Bytes lie in files without a name: nothing is left when the server ends.
class Uploads {
 public:
  struct File {
    std::string sha256, name;
    std::int64_t size = 0;
    std::string path() const { return std::string(kPrefix) + sha256; }
  };
  struct Begun {
    std::string id;             // empty where the file is there
    std::int64_t received = 0;  // [bytes]
    File file;
  };
  struct Finished {
    File file;
    meshio::Surface surface;  // in metres
  };
  // A file that is there as long as this is, whatever becomes of the others.
  struct Held {
    std::string id;  // under which it came
    File file;
    std::shared_ptr<record::SpoolFile> spool;
    absl::StatusOr<std::string> Bytes() const;
  };
  static constexpr std::string_view kPrefix = "upload:";
  static constexpr std::size_t kMostChunk = std::size_t{4} << 20;  // [bytes]

  Uploads(const Limits& limits, std::string spool_folder);

  // The errors of upload.proto. The oldest file that waits for its bytes makes room for another one past 16. Who brings
  // a file that another one is bringing shares its upload: bytes that are there are passed over, and each may finish
  // it.
  absl::StatusOr<Begun> Begin(const std::string& name, std::int64_t size, const std::string& sha256)
      ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<std::int64_t> Add(const std::string& id, std::int64_t offset, std::string_view chunk)
      ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<Finished> Finish(const std::string& id, double unit_mm) ABSL_LOCKS_EXCLUDED(mutex_);
  std::vector<File> List() const ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status Delete(const std::string& path) ABSL_LOCKS_EXCLUDED(mutex_);

  // NOT_FOUND says to upload it again.
  absl::StatusOr<Held> Hold(const std::string& path) ABSL_LOCKS_EXCLUDED(mutex_);
  // A file that an earlier server had is there again, as if it had just come.
  absl::StatusOr<Held> Adopt(const std::string& name, std::string_view bytes) ABSL_LOCKS_EXCLUDED(mutex_);
  // The surface of "upload:SHA256" in metres. NOT_FOUND says to upload it again; the parser's errors.
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
