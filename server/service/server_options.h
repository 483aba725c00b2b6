// What a server is started with, and the checks that need no other part of the server.
#ifndef PHRENIC_SERVER_SERVICE_SERVER_OPTIONS_H_
#define PHRENIC_SERVER_SERVICE_SERVER_OPTIONS_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "server/access/accounts.h"
#include "server/cluster/cluster.h"
#include "server/lti/platform.h"
#include "server/record/spool_file.h"
#include "server/schema/places.h"
#include "server/service/net/tls.h"
#include "server/session/limits.h"
#include "server/session/mesh_cache/mesh_cache.h"

namespace phrenic::service {

// The settings of phrenicd fill it (daemon/). Plain data; the server keeps copies of what it needs.
struct ServerOptions {
  std::string listen;    // gRPC, "127.0.0.1:50051"; the system chooses port 0; empty: in-process calls only
  std::string web;       // web gateway, "127.0.0.1:8080"; the system chooses port 0; empty: no gateway
  std::string data_dir;  // folder of surface files, with scenes in DATA/scenes; empty: none
  std::string scenes_dir = Installed("scenes", PHRENIC_SCENES_DIR);
  std::string web_root = Installed("web", PHRENIC_WEB_DIR);
  std::string spool_dir = record::DefaultSpoolFolder();       // unnamed temporary files of exports and uploads
  std::string cache_dir = session::DefaultCacheFolder();      // generated meshes, for the next start; none: not kept
  std::string store_dir;                                      // sessions are saved here and restored; empty: not saved
  std::function<void(const std::string& session)> restoring;  // called before each session of the store is restored
  std::vector<std::string> allowed_origins;  // "https://host:port": may call the server and frame the viewer
  std::vector<std::string> allowed_hosts;  // names by which browsers reach `web`, beside loopback and the certificate's
  session::Limits limits;
  int step_threads = 1;              // threads of one step (mechanics/parallel/parallel_for.h), process-wide
  int max_message_bytes = 16 << 20;  // of a request [bytes]
  int max_calls = 1024;              // calls and streams in flight of one caller
  int network_mb = 512;              // memory of gRPC's connections [MiB], above which calls are cancelled
  double max_requests = 200;         // per account or other machine [1/s]; 0: no limit
  int max_connections = 512;         // to `web` and to `listen`, each
  double head_seconds = 10;          // timeout of a request's header [s]
  double idle_seconds = 60;          // timeout of a request's body and of an idle connection [s]
  TlsFiles tls;                      // empty: no encryption
  bool insecure_listen = false;      // allows addresses that other machines reach without TLS
  bool unguarded_listen = false;     // allows other machines to reach `listen` without a proxy that guards it
  access::AccountOptions accounts;   // empty: every caller may do everything
  std::string audit_file;            // empty: no audit log
  lti::Options lti;                  // empty: not a tool of learning platforms
  cluster::ClusterOptions cluster;   // empty: not in a cluster
};

// Checks the options against each other. Errors name the flag and the remedy: FAILED_PRECONDITION if other machines can
// connect without TLS and insecure_listen is not set, or can reach gRPC itself and unguarded_listen is not set;
// INVALID_ARGUMENT if options exclude each other or a certificate is bad; NOT_FOUND if a file or folder is missing.
// FAILED_PRECONDITION also if Redis is on another machine without encryption and insecure_listen is not set. Does not
// check the ranges of numbers. Reads certificates and looks for folders, but opens no socket. Server::Start calls it
// first. Thread-safe.
absl::Status CheckOptions(const ServerOptions& options);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SERVER_OPTIONS_H_
