#include "client/motion_file.h"

#include <openssl/evp.h>

#include <cstdio>
#include <fstream>
#include <iostream>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "client/progress.h"
#include "phrenic/v1/export.grpc.pb.h"

namespace phrenic::client {
namespace {

// FILE.part, with the hash of what was written; removed unless it was put in its place.
class PartFile {
 public:
  explicit PartFile(const std::string& file)
      : file_(file), part_(file + ".part"), out_(part_, std::ios::binary), hash_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    EVP_DigestInit_ex(hash_.get(), EVP_sha256(), nullptr);
  }
  ~PartFile() {
    out_.close();
    std::remove(part_.c_str());
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  bool Write(const std::string& bytes) {
    out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    EVP_DigestUpdate(hash_.get(), bytes.data(), bytes.size());
    return static_cast<bool>(out_);
  }

  std::string Error() const {
    return absl::StrCat("cannot write ", part_, ": is the folder there, and the disk not full?");
  }

  absl::Status PutInPlace(const v1::ExportSummary& summary) {
    out_.close();
    if (!out_) return absl::DataLossError(Error());
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    EVP_DigestFinal_ex(hash_.get(), digest, &size);
    const std::string hex = absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(digest), size));
    if (hex != summary.sha256()) return absl::DataLossError(absl::StrCat(file_, " arrived damaged: try again"));
    if (std::rename(part_.c_str(), file_.c_str()) != 0) {
      return absl::DataLossError(absl::StrCat("cannot rename ", part_, " to ", file_));
    }
    return absl::OkStatus();
  }

 private:
  std::string file_, part_;
  std::ofstream out_;
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> hash_;
};

}  // namespace

std::string FormatOf(const std::string& file) {
  const size_t dot = file.find_last_of('.');
  return dot == std::string::npos || file.find('/', dot) != std::string::npos ? "" : file.substr(dot + 1);
}

int DownloadMotion(const Context& context, const std::shared_ptr<grpc::Channel>& channel,
                   const v1::ExportMotionRequest& request, const std::string& file, v1::ExportSummary* summary) {
  const auto stub = v1::ExportService::NewStub(channel);
  grpc::ClientContext call;
  const Interruption::Scope scope(*context.interruption, call);
  const auto stream = stub->ExportMotion(&call, request);
  PartFile part(file);
  bool writable = true;
  {
    Progress progress("recording", request.seconds());
    v1::ExportMotionResponse event;
    while (writable && stream->Read(&event)) {
      if (event.has_chunk()) writable = part.Write(event.chunk());
      if (event.event_case() == v1::ExportMotionResponse::kRecordedSeconds) progress.Update(event.recorded_seconds());
      if (event.has_summary()) *summary = event.summary();
    }
  }
  if (!writable) {
    call.TryCancel();
    return Fail(absl::DataLossError(part.Error()));
  }
  const grpc::Status status = stream->Finish();
  if (!status.ok()) return Fail(context, status);
  const absl::Status placed = part.PutInPlace(*summary);
  return placed.ok() ? kOk : Fail(placed);
}

}  // namespace phrenic::client
