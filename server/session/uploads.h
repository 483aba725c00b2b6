// Surface files and label volumes that clients upload, identified by their owner and their content.
#ifndef PHRENIC_SERVER_SESSION_UPLOADS_H_
#define PHRENIC_SERVER_SESSION_UPLOADS_H_

#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/meshio/meshio.h"
#include "server/record/spool_file.h"
#include "server/session/limits.h"
#include "server/session/requester.h"

namespace phrenic::session {

// Keeps each owner's most recently used files within the owner's quota, in unnamed files that vanish when the server
// ends. A file belongs to those who have sent its bytes: who only knows its hash does not get it, nor learns that the
// server has it. Owners of the same bytes share one file on the disk. Without accounts, all callers are one owner,
// whose quota is the whole. Thread-safe. The server owns one (service/server.cc). mutex_ guards the lists; a file is
// hashed and parsed without it.
class Uploads {
 public:
  struct File {
    std::string sha256, name;  // the hash in hexadecimal, the name as its sender gave it
    std::int64_t size = 0;     // [bytes]
    std::string path() const { return std::string(kPrefix) + sha256; }
  };
  enum class Kind { kSurface, kLabels };
  struct Begun {
    std::string id;             // 128 random bits; empty if the owner has the file already
    std::int64_t received = 0;  // [bytes]
    File file;
  };
  struct Finished {
    File file;
    std::optional<meshio::Surface> surface;  // [m]; nullopt of labels
  };
  // Keeps a file as long as this object exists, even if Uploads drops it. Copies share the file on the disk.
  struct Held {
    std::string id;  // of its upload; empty if adopted
    File file;
    std::shared_ptr<record::SpoolFile> spool;
    std::string owner = {};                  // Requester::owner
    absl::Time used = absl::InfinitePast();  // the beginning, or the last chunk, of an unfinished upload
    Kind kind = Kind::kSurface;
    // Reads the whole file into memory. The errors of record::SpoolFile::Read.
    absl::StatusOr<std::string> Bytes() const;
  };
  static constexpr std::string_view kPrefix = "upload:";
  static constexpr const char* kLabelsName = "labels";             // of every label volume: theirs may be a person's
  static constexpr std::size_t kMostChunk = std::size_t{4} << 20;  // [bytes]

  // Uses upload_bytes, uploads_bytes, uploads and their limits of a user.
  Uploads(const Limits& limits, std::string spool_folder);

  // Begin, Add and Finish an upload, with the errors of upload.proto. The owner's oldest unfinished upload makes room
  // for the 17th, and for one whose announced size exceeds the quota. RESOURCE_EXHAUSTED if the files of others leave
  // no room. Clients of one owner that upload the same file at the same time share one upload: Add skips the bytes that
  // it has, and each client may finish it. NOT_FOUND for an upload of another owner. An unfinished upload is abandoned
  // after 10 minutes without a chunk: then others may take its room. The limits count unfinished and finished uploads
  // separately. `unit_mm` is the length of the unit of a surface [mm]; of labels, Finish looks at the first bytes
  // alone.
  absl::StatusOr<Begun> Begin(const Requester& by, const std::string& name, std::int64_t size,
                              const std::string& sha256, Kind kind = Kind::kSurface) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<std::int64_t> Add(const Requester& by, const std::string& id, std::int64_t offset,
                                   std::string_view chunk) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<Finished> Finish(const Requester& by, const std::string& id, double unit_mm)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the files that the requester may name. The last used come first; an administrator sees those of all owners.
  std::vector<File> List(const Requester& by) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Deletes the requester's file; an administrator deletes it for every owner. Scenes that hold the file keep it.
  // NOT_FOUND if the requester has no such file.
  absl::Status Delete(const Requester& by, const std::string& path) ABSL_LOCKS_EXCLUDED(mutex_);

  // Returns the file of "upload:SHA256"; NOT_FOUND, which is the same for the file of another owner, says to upload it.
  // The file counts as used now.
  absl::StatusOr<Held> Hold(const Requester& by, const std::string& path) ABSL_LOCKS_EXCLUDED(mutex_);
  // Takes over a file of an earlier server, as if its owner had just uploaded it. If there is no room, the caller gets
  // the file, and no one can name it. The errors of record::SpoolFile.
  absl::StatusOr<Held> Adopt(const Requester& by, const std::string& name, std::string_view bytes)
      ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  using Files = std::list<Held>;

  // INVALID_ARGUMENT for a surface's name that is too long or has an unknown ending, and for an empty file;
  // RESOURCE_EXHAUSTED for a file above limits.upload_bytes.
  absl::Status CheckFile(const std::string& name, std::int64_t size, Kind kind) const;
  // Parses a file whose upload another client, or an earlier call, has finished. NOT_FOUND if no such upload exists.
  absl::StatusOr<Finished> FinishedBefore(const Requester& by, const std::string& id, double unit_mm) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns NOT_FOUND.
  absl::Status NoUpload(const std::string& id) const;
  // Returns the requester's file, or for an administrator another owner's; the end if neither exists.
  Files::iterator FindKept(const Requester& by, std::string_view sha256) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Compares ids in constant time; the end if the owner has no such upload.
  Files::iterator FindPending(const Requester& by, const std::string& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Drops unfinished uploads of this owner, and then abandoned ones, until one more fits. RESOURCE_EXHAUSTED.
  absl::Status MakeRoomToBegin(const std::string& owner, std::int64_t size) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Keeps a file, sharing the bytes that another owner has sent as well, and drops others of its owner, until the quota
  // and the limits hold. RESOURCE_EXHAUSTED if the files of others leave no room.
  absl::Status Keep(Held& kept) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // [bytes]; an empty owner has limits.uploads_bytes.
  std::int64_t QuotaOf(const std::string& owner) const;

  const Limits limits_;
  const std::string spool_folder_;
  mutable absl::Mutex mutex_;
  Files kept_ ABSL_GUARDED_BY(mutex_);     // last used first
  Files pending_ ABSL_GUARDED_BY(mutex_);  // oldest first
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_UPLOADS_H_
