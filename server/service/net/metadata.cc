#include "server/service/net/metadata.h"

#include <grpc/grpc.h>
#include <grpc/slice.h>
#include <grpc/support/time.h>

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace phrenic::service {
namespace {

constexpr std::size_t kEntryBytes = 32, kShownBytes = 64;
constexpr std::int64_t kYear = 366LL * 24 * 3600;  // [s]

grpc_slice SliceOf(const std::string& text) { return grpc_slice_from_static_buffer(text.data(), text.size()); }

absl::Status Illegal(const std::string& name, const char* what) {
  return absl::InvalidArgumentError(absl::StrCat(absl::CHexEscape(name.substr(0, kShownBytes)), ": ", what));
}

absl::Status CheckEntry(const std::string& name, const std::string& value) {
  if (grpc_header_key_is_legal(SliceOf(name)) == 0 || absl::StartsWith(name, "grpc-")) {
    return Illegal(name, "not a legal name of a header; use letters, digits, \"_\", \"-\" and \".\"");
  }
  if (grpc_is_binary_header(SliceOf(name)) != 0 || grpc_header_nonbin_value_is_legal(SliceOf(value)) != 0) {
    return absl::OkStatus();
  }
  return Illegal(name, "its value has a character that is not printable ASCII; remove it");
}

}  // namespace

absl::Status CheckMetadata(const Metadata& metadata) {
  std::size_t bytes = 0;
  for (const auto& [name, value] : metadata) {
    if (absl::Status status = CheckEntry(name, value); !status.ok()) return status;
    bytes += name.size() + value.size() + kEntryBytes;
    if (bytes <= kMaxMetadataBytes) continue;
    return absl::ResourceExhaustedError(
        absl::StrCat(name, ": the headers of a call have at most ", kMaxMetadataBytes, " bytes; send fewer"));
  }
  return absl::OkStatus();
}

absl::Status CheckMethod(const std::string& method) {
  const std::size_t slash = method.find('/', 1);
  const auto legal = [](char c) { return absl::ascii_isalnum(c) || c == '_' || c == '.' || c == '/'; };
  const bool ok = !method.empty() && method[0] == '/' && slash != std::string::npos && slash > 1 &&
                  slash + 1 < method.size() && method.find('/', slash + 1) == std::string::npos &&
                  method.size() <= kMaxMetadataBytes && std::all_of(method.begin(), method.end(), legal);
  return ok ? absl::OkStatus()
            : absl::InvalidArgumentError("the address is not that of a method: use /PACKAGE.SERVICE/METHOD");
}

absl::Status PrepareContext(const std::string& method, const Metadata& metadata, grpc::ClientContext& context) {
  if (absl::Status status = CheckMethod(method); !status.ok()) return status;
  if (absl::Status status = CheckMetadata(metadata); !status.ok()) return status;
  for (const auto& [name, value] : metadata) context.AddMetadata(name, value);
  return absl::OkStatus();
}

std::chrono::system_clock::time_point DeadlineOf(const grpc::ServerContextBase& context) {
  const gpr_timespec left = gpr_time_sub(context.raw_deadline(), gpr_now(context.raw_deadline().clock_type));
  return left.tv_sec > kYear ? std::chrono::system_clock::time_point::max() : context.deadline();
}

}  // namespace phrenic::service
