#include "server/service/server_options.h"

#include <filesystem>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/cluster/redis.h"
#include "server/service/net/address.h"
#include "server/service/web/hosts.h"

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

// gRPC 1.51 bounds neither the streams that a client opens and resets nor the messages that it does not finish.
absl::Status CheckGuard(const ServerOptions& options) {
  if (options.unguarded_listen || !options.tls.client_ca.empty()) return absl::OkStatus();
  const auto parsed = ParseAddress(options.listen);
  if (!parsed.ok() || IsLoopback(*parsed)) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      "--listen: ", options.listen, " lets other machines reach gRPC itself, which a single client without an account ",
      "can overload: listen on 127.0.0.1 behind nginx (deploy/nginx/guard.conf), require client certificates with ",
      "--tls-client-ca, or pass --unguarded-listen in a network that you trust"));
}

absl::Status CheckHosts(const ServerOptions& options) {
  for (const std::string& host : options.allowed_hosts) {
    if (HostOf(host).has_value()) continue;
    return absl::InvalidArgumentError(absl::StrCat("--allow-host: \"", host, "\" is not the name of a host: write ",
                                                   "phrenic.example.org, 192.0.2.1 or [2001:db8::1]"));
  }
  return absl::OkStatus();
}

// Redis has the states of sessions, so the way to it is encrypted like that to the servers.
absl::Status CheckRedis(const ServerOptions& options) {
  const auto redis = cluster::ParseRedisAddress(options.cluster.redis);
  if (!redis.ok()) return redis.status();
  if (redis->encrypted || options.insecure_listen || IsLoopback({redis->host, redis->port})) return absl::OkStatus();
  return absl::FailedPreconditionError(
      "--cluster: Redis is on another machine and the connection is not encrypted: write rediss://, or pass "
      "--insecure-listen in a network that you trust");
}

absl::Status CheckCluster(const ServerOptions& options) {
  if (options.cluster.redis.empty()) return absl::OkStatus();
  if (options.store_dir.empty()) {
    return absl::InvalidArgumentError("--cluster: a cluster's server saves sessions on its own disk: pass --store DIR");
  }
  if (absl::Status status = CheckRedis(options); !status.ok()) return status;
  const auto parsed = ParseAddress(options.cluster.advertise);
  if (parsed.ok() && parsed->port != 0 && parsed->host != "0.0.0.0" && parsed->host != "::") return absl::OkStatus();
  return absl::InvalidArgumentError(
      "--advertise: pass the HOST:PORT at which the cluster's other servers reach --listen");
}

// Roles have an effect on a server with accounts alone; logins are kept in the memory of one server.
absl::Status CheckLti(const ServerOptions& options) {
  if (!options.lti.used()) {
    const bool url = !options.lti.url.empty(), lrs = !options.lti.lrs_url.empty();
    if (!url && !lrs) return absl::OkStatus();
    return absl::InvalidArgumentError(absl::StrCat(url ? "--lti-url" : "--xapi-url", ": needs --lti-platform"));
  }
  if (!options.accounts.used()) {
    return absl::InvalidArgumentError(
        "--lti-platform: needs accounts, since without them everybody may do everything: pass --tokens FILE");
  }
  if (!options.cluster.redis.empty()) {
    return absl::InvalidArgumentError("--lti-platform: not with --cluster; run a server of its own for the platform");
  }
  return lti::ReadSettings(options.lti).status();
}

}  // namespace

absl::Status CheckOptions(const ServerOptions& options) {
  if (absl::Status status = CheckTls(options.tls); !status.ok()) return status;
  if (absl::Status status = CheckEncryption(options); !status.ok()) return status;
  if (absl::Status status = CheckGuard(options); !status.ok()) return status;
  if (absl::Status status = CheckHosts(options); !status.ok()) return status;
  if (absl::Status status = CheckCluster(options); !status.ok()) return status;
  if (absl::Status status = CheckLti(options); !status.ok()) return status;
  return CheckFolders(options);
}

}  // namespace phrenic::service
