#include "server/session/uploads.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/mesh/units.h"
#include "server/meshio/formats.h"
#include "server/schema/sha256.h"

namespace phrenic::session {
namespace {

constexpr std::size_t kMostPending = 16;

bool IsSurfaceName(const std::string& name) {
  const auto& formats = meshio::Formats();
  return std::any_of(formats.begin(), formats.end(), [&](const meshio::Format& format) {
    return absl::EndsWith(absl::AsciiStrToLower(name), std::string(format.ending));
  });
}

}  // namespace

absl::StatusOr<std::string> Uploads::Held::Bytes() const {
  std::string bytes(static_cast<std::size_t>(spool->size()), '\0');
  if (absl::Status status = spool->Read(0, bytes.data(), bytes.size()); !status.ok()) return status;
  return bytes;
}

Uploads::Uploads(const Limits& limits, std::string spool_folder)
    : limits_(limits), spool_folder_(std::move(spool_folder)) {}

absl::Status Uploads::CheckFile(const std::string& name, std::int64_t size) const {
  if (!IsSurfaceName(name)) {
    return absl::InvalidArgumentError(
        absl::StrCat("name: the ending of \"", name, "\" is no known format; there are ", meshio::Endings()));
  }
  if (size <= 0) return absl::InvalidArgumentError(absl::StrCat("size: ", name, " is empty"));
  if (size <= limits_.upload_bytes) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrCat(
      "size: ", name, " has ", size, " bytes, and a file may have ", limits_.upload_bytes,
      " (--max-upload-mb); make the surface coarser, or write it in ", "a binary format (phrenic convert)"));
}

absl::StatusOr<Uploads::Begun> Uploads::Begin(const std::string& name, std::int64_t size, const std::string& sha256) {
  if (absl::Status status = CheckFile(name, size); !status.ok()) return status;
  absl::MutexLock lock(&mutex_);
  if (const auto kept = FindKept(sha256); kept != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, kept);
    return Begun{"", kept->file.size, kept->file};
  }
  for (const Held& pending : pending_) {
    const File& file = pending.file;
    const bool same = !sha256.empty() && file.sha256 == sha256 && file.size == size;
    if (same) return Begun{pending.id, pending.spool->size(), file};
  }
  if (absl::Status status = record::CheckRoom(spool_folder_, size); !status.ok()) return status;
  auto spool = record::SpoolFile::Open(spool_folder_);
  if (!spool.ok()) return spool.status();
  if (pending_.size() >= kMostPending) pending_.pop_front();
  pending_.push_back({absl::StrCat("u", ++begun_), {sha256, name, size}, *std::move(spool)});
  return Begun{pending_.back().id, 0, pending_.back().file};
}

absl::StatusOr<std::int64_t> Uploads::Add(const std::string& id, std::int64_t offset, std::string_view chunk) {
  absl::MutexLock lock(&mutex_);
  const auto pending = FindPending(id);
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
  return pending->spool->size();
}

absl::StatusOr<Uploads::Finished> Uploads::Finish(const std::string& id, double unit_mm) {
  Held pending;
  {
    absl::MutexLock lock(&mutex_);
    const auto found = FindPending(id);
    if (found == pending_.end()) return FinishedBefore(id, unit_mm);
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
  auto surface = meshio::ParseSurface(pending.file.name, *bytes, kMillimetre * unit_mm);
  if (!surface.ok()) return surface.status();
  absl::MutexLock lock(&mutex_);
  Keep(pending);
  return Finished{pending.file, *std::move(surface)};
}

absl::StatusOr<Uploads::Finished> Uploads::FinishedBefore(const std::string& id, double unit_mm) const {
  const auto kept = std::find_if(kept_.begin(), kept_.end(), [&id](const Held& one) { return one.id == id; });
  if (kept == kept_.end()) return NoUpload(id);
  const auto bytes = kept->Bytes();
  if (!bytes.ok()) return bytes.status();
  auto surface = meshio::ParseSurface(kept->file.name, *bytes, kMillimetre * unit_mm);
  if (!surface.ok()) return surface.status();
  return Finished{kept->file, *std::move(surface)};
}

void Uploads::Keep(Held kept) {
  if (const auto same = FindKept(kept.file.sha256); same != kept_.end()) kept_.erase(same);
  kept_.push_front(std::move(kept));
  std::int64_t bytes = 0;
  int files = 0;
  for (auto file = kept_.begin(); file != kept_.end();) {
    bytes += file->file.size;
    const bool stays = files == 0 || (bytes <= limits_.uploads_bytes && files < limits_.uploads);
    ++files;
    file = stays ? std::next(file) : kept_.erase(file);
  }
}

absl::Status Uploads::NoUpload(const std::string& id) const {
  return absl::NotFoundError(
      absl::StrCat("upload_id: there is no upload \"", id.substr(0, 64), "\" in progress; begin it again"));
}

std::list<Uploads::Held>::iterator Uploads::FindKept(std::string_view sha256) {
  return std::find_if(kept_.begin(), kept_.end(), [&](const Held& kept) { return kept.file.sha256 == sha256; });
}

std::list<Uploads::Held>::iterator Uploads::FindPending(const std::string& id) {
  return std::find_if(pending_.begin(), pending_.end(), [&](const Held& pending) { return pending.id == id; });
}

std::vector<Uploads::File> Uploads::List() const {
  absl::MutexLock lock(&mutex_);
  std::vector<File> files;
  for (const Held& kept : kept_) files.push_back(kept.file);
  return files;
}

absl::Status Uploads::Delete(const std::string& path) {
  absl::MutexLock lock(&mutex_);
  const auto kept = FindKept(std::string_view(path).substr(std::min(path.size(), kPrefix.size())));
  if (kept == kept_.end()) return absl::NotFoundError(absl::StrCat("path: there is no ", path.substr(0, 80)));
  kept_.erase(kept);
  return absl::OkStatus();
}

absl::StatusOr<Uploads::Held> Uploads::Hold(const std::string& path) {
  absl::MutexLock lock(&mutex_);
  const auto kept = FindKept(std::string_view(path).substr(std::min(path.size(), kPrefix.size())));
  if (kept == kept_.end()) {
    return absl::NotFoundError(
        absl::StrCat(path.substr(0, 80),
                     ": the server does not have this file, or has dropped it; upload it again (phrenic upload FILE)"));
  }
  kept_.splice(kept_.begin(), kept_, kept);
  return *kept;
}

absl::StatusOr<Uploads::Held> Uploads::Adopt(const std::string& name, std::string_view bytes) {
  const std::string sha256 = Sha256Hex(bytes);
  if (auto there = Hold(absl::StrCat(std::string(kPrefix), sha256)); there.ok()) return there;
  auto spool = record::SpoolFile::Open(spool_folder_);
  if (!spool.ok()) return spool.status();
  if (absl::Status status = (*spool)->Append(bytes); !status.ok()) return status;
  Held held{"", {sha256, name, static_cast<std::int64_t>(bytes.size())}, *std::move(spool)};
  absl::MutexLock lock(&mutex_);
  Keep(held);
  return held;
}

absl::StatusOr<Mesh> Uploads::Read(const std::string& path, double unit) {
  const auto held = Hold(path);
  if (!held.ok()) return held.status();
  const auto bytes = held->Bytes();
  return bytes.ok() ? meshio::Parse(held->file.name, *bytes, unit) : bytes.status();
}

}  // namespace phrenic::session
