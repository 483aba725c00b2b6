#include "server/session/uploads.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/crypto/secret.h"
#include "server/crypto/sha256.h"
#include "server/imaging/label_file.h"
#include "server/mesh/units.h"
#include "server/meshio/formats.h"

namespace phrenic::session {
namespace {

constexpr std::ptrdiff_t kMostPending = 16;  // of one owner
constexpr std::size_t kMostPendingInAll = 256;
constexpr absl::Duration kAbandoned = absl::Minutes(10);  // without a chunk: others may take the room

// What the files of a list, of one owner or of all, have in sum.
struct Sum {
  std::ptrdiff_t files = 0;
  std::int64_t bytes = 0;
};

template <typename Files, typename Counts>
Sum SumOf(const Files& files, const Counts& counts) {
  Sum sum;
  for (const auto& each : files) {
    if (!counts(each)) continue;
    ++sum.files;
    sum.bytes += each.file.size;
  }
  return sum;
}

absl::Status NoRoom(std::int64_t most) {
  return absl::ResourceExhaustedError(absl::StrCat(
      "size: the files of others leave no room in the ", most,
      " bytes that all uploads may have (--max-uploads-mb): delete files that you do not need, or try later"));
}

bool IsSurfaceName(const std::string& name) {
  const auto& formats = meshio::Formats();
  return std::any_of(formats.begin(), formats.end(), [&](const meshio::Format& format) {
    return absl::EndsWith(absl::AsciiStrToLower(name), std::string(format.ending));
  });
}

// Parses a surface; of a label volume, checks the format alone.
absl::StatusOr<Uploads::Finished> Checked(const Uploads::Held& held, const std::string& bytes, double unit_mm) {
  if (held.kind == Uploads::Kind::kLabels) {
    absl::Status labels =
        imaging::IsArchive(bytes) ? absl::OkStatus() : imaging::CheckLabelFormat(held.file.name, bytes);
    if (!labels.ok()) return labels;
    return Uploads::Finished{held.file, std::nullopt};
  }
  auto surface = meshio::ParseSurface(held.file.name, bytes, kMillimetre * unit_mm);
  if (!surface.ok()) return surface.status();
  return Uploads::Finished{held.file, *std::move(surface)};
}

}  // namespace

absl::StatusOr<std::string> Uploads::Held::Bytes() const {
  std::string bytes(static_cast<std::size_t>(spool->size()), '\0');
  if (absl::Status status = spool->Read(0, bytes.data(), bytes.size()); !status.ok()) return status;
  return bytes;
}

Uploads::Uploads(const Limits& limits, std::string spool_folder)
    : limits_(limits), spool_folder_(std::move(spool_folder)) {}

absl::Status Uploads::CheckFile(const std::string& name, std::int64_t size, Kind kind) const {
  constexpr std::size_t kLongestName = 255;
  if (name.size() > kLongestName) {
    return absl::InvalidArgumentError(
        absl::StrCat("name: has ", name.size(), " bytes; ", kLongestName, " are the most"));
  }
  if (kind == Kind::kSurface && !IsSurfaceName(name)) {
    return absl::InvalidArgumentError(
        absl::StrCat("name: the ending of \"", name, "\" is no known format; there are ", meshio::Endings()));
  }
  if (size <= 0) return absl::InvalidArgumentError(absl::StrCat("size: ", name, " is empty"));
  if (size <= limits_.upload_bytes) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrCat(
      "size: ", name, " has ", size, " bytes, and a file may have ", limits_.upload_bytes,
      " (--max-upload-mb); make the surface coarser, or write it in ", "a binary format (phrenic convert)"));
}

std::int64_t Uploads::QuotaOf(const std::string& owner) const {
  return owner.empty() ? limits_.uploads_bytes : std::min(limits_.uploads_bytes, limits_.uploads_bytes_of_user);
}

absl::Status Uploads::MakeRoomToBegin(const std::string& owner, std::int64_t size) {
  const auto own = [&owner](const Held& each) { return each.owner == owner; };
  for (auto oldest = std::find_if(pending_.begin(), pending_.end(), own); oldest != pending_.end();
       oldest = std::find_if(pending_.begin(), pending_.end(), own)) {
    const Sum sum = SumOf(pending_, own);
    if (sum.files < kMostPending && sum.bytes + size <= QuotaOf(owner)) break;
    pending_.erase(oldest);
  }
  const auto any = [](const Held&) { return true; };
  const auto full = [&] {
    const Sum sum = SumOf(pending_, any);
    return sum.files > 0 && (pending_.size() >= kMostPendingInAll || sum.bytes + size > limits_.uploads_bytes);
  };
  const auto abandoned = [now = absl::Now()](const Held& each) { return each.used + kAbandoned < now; };
  if (full()) pending_.remove_if(abandoned);
  if (full()) return NoRoom(limits_.uploads_bytes);
  const Sum others = SumOf(kept_, [&own](const Held& each) { return !own(each); });
  const bool fits =
      others.files == 0 || (others.files < limits_.uploads && others.bytes + size <= limits_.uploads_bytes);
  return fits ? absl::OkStatus() : NoRoom(limits_.uploads_bytes);
}

absl::StatusOr<Uploads::Begun> Uploads::Begin(const Requester& by, const std::string& given, std::int64_t size,
                                              const std::string& sha256, Kind kind) {
  const std::string name = kind == Kind::kLabels ? kLabelsName : given;
  if (absl::Status status = CheckFile(name, size, kind); !status.ok()) return status;
  if (!sha256.empty() && sha256.size() != Sha256Hex("").size()) {
    return absl::InvalidArgumentError("sha256: is not the 64 hexadecimal digits of a SHA-256");
  }
  const Requester own{.owner = by.owner};
  absl::MutexLock lock(&mutex_);
  if (const auto kept = FindKept(own, sha256); kept != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, kept);
    return Begun{"", kept->file.size, kept->file};
  }
  for (const Held& pending : pending_) {
    const File& file = pending.file;
    const bool same = pending.owner == by.owner && !sha256.empty() && file.sha256 == sha256 && file.size == size;
    if (same) return Begun{pending.id, pending.spool->size(), file};
  }
  if (absl::Status status = record::CheckRoom(spool_folder_, size); !status.ok()) return status;
  if (absl::Status status = MakeRoomToBegin(by.owner, size); !status.ok()) return status;
  auto spool = record::SpoolFile::Open(spool_folder_);
  if (!spool.ok()) return spool.status();
  pending_.push_back({NewToken(), {sha256, name, size}, *std::move(spool), by.owner, absl::Now(), kind});
  return Begun{pending_.back().id, 0, pending_.back().file};
}

absl::StatusOr<std::int64_t> Uploads::Add(const Requester& by, const std::string& id, std::int64_t offset,
                                          std::string_view chunk) {
  absl::MutexLock lock(&mutex_);
  const auto pending = FindPending(by, id);
  if (pending == pending_.end()) return NoUpload(id);
  const std::int64_t received = pending->spool->size();
  if (offset < 0 || offset > received) {
    return absl::OutOfRangeError(absl::StrCat("offset: ", offset, " is not the next byte, ", received, " is"));
  }
  if (chunk.size() > kMostChunk) {
    return absl::InvalidArgumentError(absl::StrCat("chunk: ", chunk.size(), " bytes; ", kMostChunk, " are the most"));
  }
  if (offset + static_cast<std::int64_t>(chunk.size()) > pending->file.size) {
    return absl::OutOfRangeError(
        absl::StrCat("chunk: more bytes than the ", pending->file.size, " that were announced"));
  }
  const std::size_t known = std::min(chunk.size(), static_cast<std::size_t>(received - offset));
  if (absl::Status status = pending->spool->Append(chunk.substr(known)); !status.ok()) return status;
  pending->used = absl::Now();
  return pending->spool->size();
}

absl::StatusOr<Uploads::Finished> Uploads::Finish(const Requester& by, const std::string& id, double unit_mm) {
  Held pending;
  {
    absl::ReleasableMutexLock lock(&mutex_);
    const auto found = FindPending(by, id);
    if (found == pending_.end()) {
      lock.Release();
      return FinishedBefore(by, id, unit_mm);
    }
    if (found->spool->size() < found->file.size) {
      return absl::FailedPreconditionError(absl::StrCat("upload_id: ", found->spool->size(), " of ", found->file.size,
                                                        " bytes have arrived; send the others first"));
    }
    pending = std::move(*found);
    pending_.erase(found);
  }
  const auto bytes = pending.Bytes();
  if (!bytes.ok()) return bytes.status();
  const std::string sha256 = Sha256Hex(*bytes);
  if (!pending.file.sha256.empty() && pending.file.sha256 != sha256) {
    return absl::DataLossError(absl::StrCat(pending.file.name, " arrived damaged (its SHA-256 is ", sha256, " and not ",
                                            pending.file.sha256, "): send it again"));
  }
  pending.file.sha256 = sha256;
  auto finished = Checked(pending, *bytes, unit_mm);
  if (!finished.ok()) return finished;
  absl::MutexLock lock(&mutex_);
  if (absl::Status status = Keep(pending); !status.ok()) return status;
  return finished;
}

absl::StatusOr<Uploads::Finished> Uploads::FinishedBefore(const Requester& by, const std::string& id,
                                                          double unit_mm) const {
  Held held;
  {
    absl::MutexLock lock(&mutex_);
    const auto kept = std::find_if(kept_.begin(), kept_.end(), [&](const Held& one) {
      return !id.empty() && one.id == id && one.owner == by.owner;
    });
    if (kept == kept_.end()) return NoUpload(id);
    held = *kept;
  }
  const auto bytes = held.Bytes();
  if (!bytes.ok()) return bytes.status();
  return Checked(held, *bytes, unit_mm);
}

absl::Status Uploads::Keep(Held& kept) {
  const std::string owner = kept.owner;
  for (const Held& same : kept_) {
    if (same.file.sha256 == kept.file.sha256) kept.spool = same.spool;
  }
  if (const auto same = FindKept({.owner = owner}, kept.file.sha256); same != kept_.end()) kept_.erase(same);
  kept_.push_front(kept);
  const auto own = [&owner](const Held& each) { return each.owner == owner; };
  const auto any = [](const Held&) { return true; };
  const std::ptrdiff_t files = owner.empty() ? limits_.uploads : std::min(limits_.uploads, limits_.uploads_of_user);
  for (;;) {
    const Sum mine = SumOf(kept_, own), all = SumOf(kept_, any);
    const bool fits = all.files <= limits_.uploads && all.bytes <= limits_.uploads_bytes;
    if (mine.files <= files && mine.bytes <= QuotaOf(owner) && fits) return absl::OkStatus();
    if (mine.files == 1) {
      if (fits || all.files == 1) return absl::OkStatus();  // one file is always kept
      kept_.pop_front();
      return NoRoom(limits_.uploads_bytes);
    }
    kept_.erase(std::next(std::find_if(kept_.rbegin(), kept_.rend(), own)).base());
  }
}

absl::Status Uploads::NoUpload(const std::string& id) const {
  return absl::NotFoundError(
      absl::StrCat("upload_id: there is no upload \"", id.substr(0, 64), "\" in progress; begin it again"));
}

// An administrator's own file comes before those of others.
Uploads::Files::iterator Uploads::FindKept(const Requester& by, std::string_view sha256) {
  const auto find = [&](bool others) {
    return std::find_if(kept_.begin(), kept_.end(), [&](const Held& kept) {
      return kept.file.sha256 == sha256 && (others || kept.owner == by.owner);
    });
  };
  const auto own = find(false);
  return own == kept_.end() && by.all_files ? find(true) : own;
}

Uploads::Files::iterator Uploads::FindPending(const Requester& by, const std::string& id) {
  return std::find_if(pending_.begin(), pending_.end(),
                      [&](const Held& pending) { return SameToken(pending.id, id) && pending.owner == by.owner; });
}

std::vector<Uploads::File> Uploads::List(const Requester& by) const {
  absl::MutexLock lock(&mutex_);
  std::vector<File> files;
  for (const Held& kept : kept_) {
    if (by.all_files || kept.owner == by.owner) files.push_back(kept.file);
  }
  return files;
}

absl::Status Uploads::Delete(const Requester& by, const std::string& path) {
  const std::string_view sha256 = std::string_view(path).substr(std::min(path.size(), kPrefix.size()));
  absl::MutexLock lock(&mutex_);
  const auto removed = kept_.remove_if(
      [&](const Held& kept) { return kept.file.sha256 == sha256 && (by.all_files || kept.owner == by.owner); });
  if (removed > 0) return absl::OkStatus();
  return absl::NotFoundError(absl::StrCat("path: there is no \"", path.substr(0, 80), "\" that belongs to you"));
}

absl::StatusOr<Uploads::Held> Uploads::Hold(const Requester& by, const std::string& path) {
  absl::MutexLock lock(&mutex_);
  const auto kept = FindKept(by, std::string_view(path).substr(std::min(path.size(), kPrefix.size())));
  if (kept == kept_.end()) {
    return absl::NotFoundError(
        absl::StrCat(path.substr(0, 80),
                     ": the server does not have this file, or has dropped it; upload it again (phrenic upload FILE)"));
  }
  kept_.splice(kept_.begin(), kept_, kept);
  return *kept;
}

absl::StatusOr<Uploads::Held> Uploads::Adopt(const Requester& by, const std::string& name, std::string_view bytes) {
  const std::string sha256 = Sha256Hex(bytes);
  if (auto there = Hold({.owner = by.owner}, absl::StrCat(std::string(kPrefix), sha256)); there.ok()) return there;
  auto spool = record::SpoolFile::Open(spool_folder_);
  if (!spool.ok()) return spool.status();
  if (absl::Status status = (*spool)->Append(bytes); !status.ok()) return status;
  Held held{"", {sha256, name, static_cast<std::int64_t>(bytes.size())}, *std::move(spool), by.owner};
  absl::MutexLock lock(&mutex_);
  Keep(held).IgnoreError();  // without room, those that hold it still have it
  return held;
}

}  // namespace phrenic::session
