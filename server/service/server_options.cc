#include "server/service/server_options.h"

#include <filesystem>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/service/net/address.h"

namespace phrenic::service {
namespace {

absl::Status CheckFolder(const std::string& folder, const char* flag) {
  std::error_code error;
  if (folder.empty() || std::filesystem::is_directory(folder, error)) return absl::OkStatus();
  return absl::NotFoundError(absl::StrCat(flag, ": there is no folder ", folder));
}

absl::Status CheckFolders(const ServerOptions& options) {
  for (const auto& [folder, flag] :
       {std::pair(options.data_dir, "--data"), {options.scenes_dir, "--scenes"}, {options.spool_dir, "--spool"}}) {
    if (absl::Status status = CheckFolder(folder, flag); !status.ok()) return status;
  }
  return absl::OkStatus();
}

// Other machines may connect without TLS only if the operator says so.
absl::Status CheckEncryption(const ServerOptions& options) {
  if (options.tls.used() || options.insecure_listen) return absl::OkStatus();
  for (const auto& [flag, address] : {std::pair("--listen", options.listen), {"--web", options.web}}) {
    const auto parsed = ParseAddress(address);
    if (!parsed.ok() || IsLoopback(*parsed)) continue;
    return absl::FailedPreconditionError(absl::StrCat(
        flag, ": ", address, " is reachable from other machines and is not encrypted: pass --tls-cert and ",
        "--tls-key, listen on 127.0.0.1 behind a proxy with TLS, or pass --insecure-listen in a network ",
        "that you trust"));
  }
  return absl::OkStatus();
}

absl::Status CheckCluster(const ServerOptions& options) {
  if (options.cluster.redis.empty()) return absl::OkStatus();
  if (options.store_dir.empty()) {
    return absl::InvalidArgumentError("--cluster: a cluster's server saves sessions on its own disk: pass --store DIR");
  }
  if (options.tls.used()) {
    return absl::InvalidArgumentError(
        "--cluster: the servers of a cluster call each other without TLS: remove --tls-cert, terminate TLS in nginx, "
        "and listen in a private network");
  }
  const auto parsed = ParseAddress(options.cluster.advertise);
  if (parsed.ok() && parsed->port != 0 && parsed->host != "0.0.0.0" && parsed->host != "::") return absl::OkStatus();
  return absl::InvalidArgumentError(
      "--advertise: pass the HOST:PORT at which the cluster's other servers reach --listen");
}

}  // namespace

absl::Status CheckOptions(const ServerOptions& options) {
  if (absl::Status status = CheckTls(options.tls); !status.ok()) return status;
  if (absl::Status status = CheckEncryption(options); !status.ok()) return status;
  if (absl::Status status = CheckCluster(options); !status.ok()) return status;
  return CheckFolders(options);
}

}  // namespace phrenic::service
