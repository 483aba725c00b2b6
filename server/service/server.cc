#include "server/service/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <spdlog/spdlog.h>

#include <filesystem>

#include "absl/strings/str_cat.h"
#include "server/mechanics/parallel/parallel_for.h"
#include "server/service/access_service.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/metrics.h"
#include "server/service/compare_service.h"
#include "server/service/control_service.h"
#include "server/service/export_service.h"
#include "server/service/frame_service.h"
#include "server/service/net/address.h"
#include "server/service/net/grpc_listener.h"
#include "server/service/periodic_task.h"
#include "server/service/routing/session_router.h"
#include "server/service/scene_service.h"
#include "server/service/server_service.h"
#include "server/service/session_service.h"
#include "server/service/study_service.h"
#include "server/service/upload_service.h"
#include "server/service/web/web_gateway.h"
#include "server/service/web_pages.h"
#include "server/session/export/exports.h"
#include "server/session/table.h"
#include "server/store/store.h"

namespace phrenic::service {
namespace {

constexpr int kMostThreads = 128;                 // of unary calls and exports; viewers need none of their own
constexpr int kMostStreams = 1000;                // of one connection
constexpr std::chrono::milliseconds kGrace(500);  // for calls to end by themselves
constexpr absl::Duration kTendPause = absl::Seconds(2);

absl::Status CheckFolder(const std::string& folder, const char* option) {
  std::error_code error;
  if (folder.empty() || std::filesystem::is_directory(folder, error)) return absl::OkStatus();
  return absl::NotFoundError(absl::StrCat(option, ": there is no folder ", folder));
}

std::vector<std::string> SceneFolders(const ServerOptions& options) {
  std::vector<std::string> folders = {options.scenes_dir};
  if (!options.data_dir.empty()) folders.push_back(options.data_dir + "/scenes");
  return folders;
}

// What may be read and changed on its way is for this machine alone, unless somebody says so.
absl::Status CheckReach(const ServerOptions& options) {
  if (options.tls.used() || options.insecure_listen) return absl::OkStatus();
  for (const auto& [flag, address] : {std::pair("--listen", options.listen), {"--web", options.web}}) {
    const auto parts = ParseAddress(address);
    if (!parts.ok() || IsLoopback(*parts)) continue;
    return absl::FailedPreconditionError(
        absl::StrCat(flag, ": ", address, " can be reached from other machines, and nothing is encrypted: give ",
                     "--tls-cert and --tls-key, listen to 127.0.0.1 behind a proxy that has them, or say ",
                     "--insecure-listen in a network that you trust"));
  }
  return absl::OkStatus();
}

// What a server of a cluster must have, and may not.
absl::Status CheckCluster(const ServerOptions& options) {
  if (options.cluster.redis.empty()) return absl::OkStatus();
  if (options.store_dir.empty()) {
    return absl::InvalidArgumentError("--cluster: a server of a cluster saves on its own disk first: give --store DIR");
  }
  if (options.tls.used()) {
    return absl::InvalidArgumentError(
        "--cluster: servers of a cluster call each other unencrypted: leave --tls-cert to nginx in front of them, and "
        "listen in a network of their own");
  }
  const auto parts = ParseAddress(options.cluster.advertise);
  if (parts.ok() && parts->port != 0 && parts->host != "0.0.0.0" && parts->host != "::") return absl::OkStatus();
  return absl::InvalidArgumentError(
      "--advertise: name the HOST:PORT at which the cluster's other servers reach --listen");
}

int Milliseconds(double seconds) { return static_cast<int>(seconds * 1000); }

// A dead peer is noticed within 15 s, and two servers never share a port.
void Configure(const ServerOptions& options, grpc::ServerBuilder& builder) {
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 3'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 5'000);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMostStreams);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, Milliseconds(options.head_seconds));
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, Milliseconds(options.idle_seconds));
  // gRPC unpacks a compressed message of whatever size before it looks how long it is: none are taken.
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  builder.AddChannelArgument(GRPC_ARG_ENABLE_PER_MESSAGE_DECOMPRESSION, 0);
  builder.SetMaxReceiveMessageSize(options.max_message_bytes);
  builder.SetMaxSendMessageSize(-1);  // ours: bounded by the scenes that are taken on
  grpc::ResourceQuota quota("phrenicd");
  quota.SetMaxThreads(kMostThreads);
  builder.SetResourceQuota(quota);
}

}  // namespace

// In the order in which they depend on each other.
struct Server::Parts {
  Parts(const ServerOptions& options, std::unique_ptr<cluster::Cluster> others, std::unique_ptr<store::Store> kept,
        std::unique_ptr<access::Accounts> who, std::unique_ptr<access::AuditLog> log)
      : cluster(std::move(others)),
        store(std::move(kept)),
        accounts(std::move(who)),
        audit(std::move(log)),
        uploads(options.limits, options.spool_dir),
        models(session::SceneCatalogue(SceneFolders(options)), options.data_dir, options.limits.models, &uploads,
               options.limits.vertices),
        table(models, clock, options.limits, store.get(), cluster.get()),
        front(cluster == nullptr ? nullptr : std::make_unique<SessionRouter>(*cluster)),
        guard(*accounts, *audit, table, metrics, options.max_requests),
        pages(guard, metrics, table),
        scene_service(models, guard),
        session_service(table, guard),
        control_service(table, guard),
        access_service(guard, table),
        frame_service(table, guard, metrics, options.limits.viewers_in_all),
        exports(options.limits, options.spool_dir, clock, store.get()),
        export_service(table, exports, guard),
        upload_service(uploads, options.limits, guard),
        study_service(models, options.web_root, guard, store.get()),
        compare_service(table, options.limits.exports, guard),
        server_service(std::filesystem::exists(options.web_root + "/index.html"), !options.data_dir.empty(),
                       options.tls.used(), guard) {}

  void JoinCluster();
  absl::Status Restore(const ServerOptions& options);
  // Now and then.
  void Tend();
  absl::Status Serve(const ServerOptions& options);
  absl::Status ServeWeb(const ServerOptions& options);

  absl::Status Listen(const ServerOptions& options, grpc::ServerBuilder& builder);
  absl::Status ServeFront(const ServerOptions& options);
  // Where calls come in that may be another server's.
  grpc::Server& outer() { return front_grpc == nullptr ? *grpc : *front_grpc; }

  const std::unique_ptr<cluster::Cluster> cluster;  // null: a server by itself
  const std::unique_ptr<store::Store> store;        // null: there is none
  const std::unique_ptr<access::Accounts> accounts;
  const std::unique_ptr<access::AuditLog> audit;
  stream::SystemClock clock;
  session::Uploads uploads;
  session::Models models;
  session::Table table;
  const std::unique_ptr<SessionRouter> front;  // of a cluster's server
  Metrics metrics;
  AccessGuard guard;
  WebPages pages;
  SceneService scene_service;
  SessionService session_service;
  ControlService control_service;
  AccessService access_service;
  FrameService frame_service;
  session::Exports exports;
  ExportService export_service;
  UploadService upload_service;
  StudyService study_service;
  CompareService compare_service;
  ServerService server_service;
  std::unique_ptr<GrpcListener> listener;
  std::unique_ptr<grpc::Server> grpc, front_grpc;
  std::unique_ptr<WebGateway> web;
  std::unique_ptr<PeriodicTask> caretaker;
  std::map<std::string, absl::Status> lost;
  absl::Status not_refreshed;  // of the accounts, the last time
};

void Server::Parts::JoinCluster() {
  if (cluster == nullptr) return;
  store->set_ownership(cluster.get());
  cluster->Begin({.lost = [this](const std::string& id) { table.Drop(id); },
                  .take_over = [this](const store::SavedSession& saved,
                                      std::int64_t epoch) { return table.TakeOver(saved, epoch); },
                  .copy_whole = [this](const std::vector<std::string>& ids) { store->CopyWhole(ids); }});
  metrics.Follow([this] { return std::pair(cluster->counts(), front->forwarded()); });
}

absl::Status Server::Parts::Restore(const ServerOptions& options) {
  if (store == nullptr) return absl::OkStatus();
  const auto records = store->LoadRecords();  // before sessions go on, and are saved
  if (!records.ok()) return records.status();
  auto restored = table.Restore([&options](const std::string& id) {
    if (options.restoring) options.restoring(id);
  });
  if (!restored.ok()) return restored.status();
  lost = *std::move(restored);
  study_service.Restore(*records, lost);
  const auto take = [this](const std::string& id, const std::string& owner) {
    guard.Give(AccessGuard::Kind::kExport, id, owner);
  };
  exports.Restore(*records, models, take, lost);
  return absl::OkStatus();
}

void Server::Parts::Tend() {
  table.Tend();
  const absl::Status refreshed = accounts->Refresh();
  if (!refreshed.ok() && refreshed != not_refreshed) {
    spdlog::warn("{}; what was good before stays", std::string(refreshed.message()));
  }
  not_refreshed = refreshed;
}

absl::Status Server::Parts::Listen(const ServerOptions& options, grpc::ServerBuilder& builder) {
  if (options.listen.empty()) return absl::OkStatus();
  auto listening = GrpcListener::Make(options.listen, static_cast<std::size_t>(options.max_connections),
                                      MakeCredentials(options.tls), builder);
  if (!listening.ok()) return listening.status();
  listener = *std::move(listening);
  return absl::OkStatus();
}

// Calls come in at the front, and those that are this server's go on within the process.
absl::Status Server::Parts::ServeFront(const ServerOptions& options) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  front->set_here(grpc->InProcessChannel(arguments));
  grpc::ServerBuilder builder;
  Configure(options, builder);
  if (absl::Status status = Listen(options, builder); !status.ok()) return status;
  builder.RegisterCallbackGenericService(front.get());
  front_grpc = builder.BuildAndStart();
  return front_grpc == nullptr ? absl::InternalError("gRPC could not be started") : absl::OkStatus();
}

absl::Status Server::Parts::Serve(const ServerOptions& options) {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  Configure(options, builder);
  if (front == nullptr) {
    if (absl::Status status = Listen(options, builder); !status.ok()) return status;
  }
  builder.RegisterService(&scene_service);
  builder.RegisterService(&session_service);
  builder.RegisterService(&control_service);
  builder.RegisterService(&access_service);
  builder.RegisterService(&frame_service);
  builder.RegisterService(&export_service);
  builder.RegisterService(&upload_service);
  builder.RegisterService(&study_service);
  builder.RegisterService(&compare_service);
  builder.RegisterService(&server_service);
  grpc = builder.BuildAndStart();
  if (grpc == nullptr) return absl::InternalError("gRPC could not be started");
  if (front != nullptr) {
    if (absl::Status status = ServeFront(options); !status.ok()) return status;
  }
  if (listener != nullptr) listener->Start();
  return absl::OkStatus();
}

absl::Status Server::Parts::ServeWeb(const ServerOptions& options) {
  if (options.web.empty()) return absl::OkStatus();
  constexpr std::size_t kBase64 = 2;  // a text call's body is a third longer than its message
  const WebGateway::Options web_options = {
      .address = options.web,
      .settings = {.root = options.web_root,
                   .allowed_origins = options.allowed_origins,
                   .max_body_bytes = kBase64 * static_cast<std::size_t>(options.max_message_bytes),
                   .head_time = std::chrono::milliseconds(Milliseconds(options.head_seconds)),
                   .idle_time = std::chrono::milliseconds(Milliseconds(options.idle_seconds)),
                   .page = [this](std::string_view target,
                                  std::string_view authorization) { return pages.Find(target, authorization); }},
      .max_connections = static_cast<std::size_t>(options.max_connections),
      .tls = options.tls};
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  auto gateway = WebGateway::Start(web_options, outer().InProcessChannel(arguments));
  if (!gateway.ok()) return gateway.status();
  web = *std::move(gateway);
  server_service.set_web_port(web->port());
  return absl::OkStatus();
}

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerOptions& options) {
  if (absl::Status status = CheckTls(options.tls); !status.ok()) return status;
  if (absl::Status status = CheckReach(options); !status.ok()) return status;
  if (absl::Status status = CheckCluster(options); !status.ok()) return status;
  auto accounts = access::Accounts::Open(options.accounts);
  if (!accounts.ok()) return accounts.status();
  auto audit = access::AuditLog::Open(options.audit_file);
  if (!audit.ok()) return audit.status();
  if (absl::Status status = CheckFolder(options.data_dir, "--data"); !status.ok()) return status;
  if (absl::Status status = CheckFolder(options.scenes_dir, "--scenes"); !status.ok()) return status;
  if (absl::Status status = CheckFolder(options.spool_dir, "--spool"); !status.ok()) return status;
  if (options.step_threads != StepThreads()) SetStepThreads(options.step_threads);
  std::unique_ptr<store::Store> store;
  if (!options.store_dir.empty()) {
    auto opened = store::Store::Open(options.store_dir);
    if (!opened.ok()) return opened.status();
    store = *std::move(opened);
  }
  std::unique_ptr<cluster::Cluster> cluster;
  if (!options.cluster.redis.empty()) {
    auto joined = cluster::Cluster::Join(options.cluster);
    if (!joined.ok()) return joined.status();
    cluster = *std::move(joined);
  }
  std::unique_ptr<Server> server(new Server(
      std::make_unique<Parts>(options, std::move(cluster), std::move(store), *std::move(accounts), *std::move(audit))));
  server->parts_->JoinCluster();
  if (absl::Status status = server->parts_->Restore(options); !status.ok()) return status;
  if (absl::Status status = server->parts_->Serve(options); !status.ok()) return status;
  if (absl::Status status = server->parts_->ServeWeb(options); !status.ok()) return status;
  server->parts_->caretaker =
      std::make_unique<PeriodicTask>(kTendPause, [parts = server->parts_.get()] { parts->Tend(); });
  if (server->parts_->cluster != nullptr) server->parts_->cluster->Watch();
  server->parts_->pages.set_ready(true);
  return server;
}

Server::~Server() { Shutdown(); }

std::shared_ptr<grpc::Channel> Server::InProcessChannel() {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  return parts_->grpc->InProcessChannel(arguments);
}

int Server::port() const { return parts_->listener == nullptr ? 0 : parts_->listener->port(); }

int Server::web_port() const { return parts_->web == nullptr ? 0 : parts_->web->port(); }

const std::map<std::string, absl::Status>& Server::lost() const { return parts_->lost; }

void Server::Shutdown() {
  parts_->pages.set_ready(false);
  if (parts_->grpc != nullptr) parts_->grpc->GetHealthCheckService()->SetServingStatus(false);
  parts_->caretaker.reset();
  if (parts_->cluster != nullptr) parts_->cluster->Rest();
  if (parts_->listener != nullptr) parts_->listener->Shutdown();
  parts_->table.Close(absl::UnavailableError("the server is shutting down"));
  if (parts_->cluster != nullptr) parts_->cluster->Leave();
  if (parts_->web != nullptr) parts_->web->Shutdown();
  if (parts_->front_grpc != nullptr) parts_->front_grpc->Shutdown(std::chrono::system_clock::now() + kGrace);
  if (parts_->grpc != nullptr) parts_->grpc->Shutdown(std::chrono::system_clock::now() + kGrace);
}

}  // namespace phrenic::service
