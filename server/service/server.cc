#include "server/service/server.h"

#include <grpcpp/client_context.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <filesystem>

#include "absl/strings/str_cat.h"
#include "phrenic/v1/server.grpc.pb.h"
#include "server/jobs/thread_priority.h"
#include "server/mechanics/parallel/compile_threads.h"
#include "server/mechanics/parallel/parallel_for.h"
#include "server/service/access_service.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_limits.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/metrics.h"
#include "server/service/calls/reflection.h"
#include "server/service/compare_service.h"
#include "server/service/control_service.h"
#include "server/service/export_service.h"
#include "server/service/fit_service.h"
#include "server/service/frame_service.h"
#include "server/service/health_service.h"
#include "server/service/lti_classroom.h"
#include "server/service/lti_forms.h"
#include "server/service/memory_trimmer.h"
#include "server/service/net/grpc_listener.h"
#include "server/service/patient_service.h"
#include "server/service/periodic_task.h"
#include "server/service/reference_service.h"
#include "server/service/routing/forwarding_service.h"
#include "server/service/routing/session_router.h"
#include "server/service/sample_service.h"
#include "server/service/scene_service.h"
#include "server/service/server_service.h"
#include "server/service/session_service.h"
#include "server/service/study_service.h"
#include "server/service/tissue_service.h"
#include "server/service/upload_service.h"
#include "server/service/web/web_gateway.h"
#include "server/service/web_pages.h"
#include "server/session/export/exports.h"
#include "server/session/patient/patients.h"
#include "server/session/table.h"
#include "server/store/store.h"

namespace phrenic::service {
namespace {

constexpr int kMaxStreams = 128;                      // of one HTTP/2 connection
constexpr int kStreamWindow = 16 << 10;               // of a stream whose request is not read yet [bytes]
constexpr std::chrono::milliseconds kDrainTime(500);  // for calls to end before they are cancelled
constexpr absl::Duration kMaintenancePeriod = absl::Seconds(2);
constexpr std::chrono::seconds kReadyTime(1);  // for the call that /readyz makes

std::vector<std::string> SceneFolders(const ServerOptions& options) {
  std::vector<std::string> folders = {options.scenes_dir};
  if (!options.data_dir.empty()) folders.push_back(options.data_dir + "/scenes");
  return folders;
}

// Servers of a cluster check each other by the cluster's authority, else by that of their clients.
std::shared_ptr<grpc::ChannelCredentials> PeerCredentials(const ServerOptions& options) {
  return MakePeerCredentials(options.tls,
                             options.cluster.tls.ca.empty() ? options.tls.client_ca : options.cluster.tls.ca);
}

int Milliseconds(double seconds) { return static_cast<int>(seconds * 1000); }

std::chrono::milliseconds RequestTime(const ServerOptions& options) {
  return std::chrono::milliseconds(Milliseconds(options.idle_seconds));
}

// Sets keepalive (a dead peer is detected within 13 s), timeouts and limits. Two servers cannot share a port.
void Configure(const ServerOptions& options, grpc::ServerBuilder& builder) {
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 3'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 5'000);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreams);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, kStreamWindow);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);  // would raise the window to megabytes
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, Milliseconds(options.head_seconds));
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, Milliseconds(options.idle_seconds));
  // gRPC checks a compressed message's size only after decompressing it, so compression is refused.
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  builder.AddChannelArgument(GRPC_ARG_ENABLE_PER_MESSAGE_DECOMPRESSION, 0);
  builder.SetMaxReceiveMessageSize(options.max_message_bytes);
  builder.SetMaxSendMessageSize(-1);  // bounded by --max-vertices
  grpc::ResourceQuota quota("phrenicd");
  quota.Resize(static_cast<std::size_t>(options.network_mb) << 20);
  builder.SetResourceQuota(quota);
}

}  // namespace

// The members, in the order of their dependencies.
struct Server::Parts {
  // What Parts takes over from Open.
  struct Opened {
    std::unique_ptr<access::Accounts> accounts;
    std::unique_ptr<access::AuditLog> audit;
    std::unique_ptr<store::Store> store;
    std::unique_ptr<cluster::Cluster> cluster;
    std::unique_ptr<lti::ToolKey> lti_key;  // null: no learning platforms
  };

  // Opens accounts and audit log, the store and the connection to Redis.
  static absl::StatusOr<Opened> Open(const ServerOptions& options);

  Parts(const ServerOptions& options, Opened opened)
      : cluster(std::move(opened.cluster)),
        store(std::move(opened.store)),
        accounts(std::move(opened.accounts)),
        audit(std::move(opened.audit)),
        uploads(options.limits, options.spool_dir),
        models(session::SceneCatalogue(SceneFolders(options)), options.data_dir, options.limits.models, &uploads,
               options.limits, session::MeshCache(options.cache_dir)),
        table(models, clock, options.limits, store.get(), cluster.get()),
        page_tokens(cluster == nullptr ? PageTokens() : PageTokens("cluster")),
        router(cluster == nullptr ? nullptr
                                  : std::make_unique<SessionRouter>(*cluster, PeerCredentials(options), page_tokens)),
        guard(*accounts, *audit, table, metrics, options.max_requests),
        pages(guard, metrics, table),
        scene_service(models, guard),
        session_service(table, guard, page_tokens),
        control_service(table, guard),
        access_service(guard, table),
        frame_service(table, guard, metrics, options.limits, watches),
        sample_service(table, guard, options.limits),
        reference_service(table, guard),
        tissue_service(table, guard, options.limits),
        exports(options.limits, options.spool_dir, clock, store.get(), options.web_root + "/offline.html"),
        export_service(table, exports, guard),
        upload_service(uploads, options.limits, guard),
        patients(models, uploads, options.limits, clock),
        patient_service(patients, options.limits, guard),
        study_service(models, options.web_root, guard, clock, options.limits, store.get()),
        compare_service(table, options.limits, guard),
        fit_service(models, options.limits, guard),
        server_service(std::filesystem::exists(options.web_root + "/index.html"), !options.data_dir.empty(),
                       options.tls.used(), guard),
        call_limits(options.max_calls, RequestTime(options), static_cast<std::size_t>(options.max_message_bytes)),
        calls(guard, call_limits),
        forwarding_limits(options.max_calls, RequestTime(options),
                          static_cast<std::size_t>(options.max_message_bytes)) {
    if (opened.lti_key != nullptr) {
      lti = std::make_unique<LtiForms>(*lti::ReadSettings(options.lti), std::move(opened.lti_key),
                                       options.web_root + "/lessons", classroom, store.get());
      session_service.set_listener(lti->listener());
    }
    AddCalls();
    table.set_account_names([this](const std::string& account) { return guard.AccountOf(account); });
  }

  // Fills the table of calls.
  void AddCalls();
  void JoinCluster();
  absl::Status Restore(const ServerOptions& options);
  // Deletes idle sessions, reloads accounts and gives freed memory back.
  void Maintain();
  // Makes a call to this server in process, for /readyz.
  void CheckReady();
  absl::Status Serve(const ServerOptions& options);
  absl::Status ServeWeb(const ServerOptions& options);

  absl::Status Listen(const ServerOptions& options, grpc::ServerBuilder& builder);
  absl::Status ServeForwarding(const ServerOptions& options);
  // Returns the gRPC server that accepts calls from outside the process.
  grpc::Server& entry_server() { return forwarding_server == nullptr ? *grpc : *forwarding_server; }

  const std::unique_ptr<cluster::Cluster> cluster;  // null: not in a cluster
  const std::unique_ptr<store::Store> store;        // null: sessions are not saved
  const std::unique_ptr<access::Accounts> accounts;
  const std::unique_ptr<access::AuditLog> audit;
  SystemClock clock;
  session::Uploads uploads;
  session::Models models;
  session::Table table;
  const PageTokens page_tokens;
  const std::unique_ptr<SessionRouter> router;  // null: not in a cluster
  Metrics metrics;
  AccessGuard guard;
  WebPages pages;
  SceneService scene_service;
  SessionService session_service;
  ControlService control_service;
  AccessService access_service;
  WatchClaims watches;
  FrameService frame_service;
  SampleService sample_service;
  ReferenceService reference_service;
  TissueService tissue_service;
  session::Exports exports;
  ExportService export_service;
  UploadService upload_service;
  session::Patients patients;
  PatientService patient_service;
  StudyService study_service;
  CompareService compare_service;
  FitService fit_service;
  ServerService server_service;
  HealthService health_service;
  LtiClassroom classroom{table, *accounts};
  std::unique_ptr<LtiForms> lti;  // null: no learning platforms
  CallLimits call_limits;
  CallTable calls;
  std::unique_ptr<GrpcListener> listener;
  std::unique_ptr<grpc::Server> grpc;
  CallLimits forwarding_limits;
  std::unique_ptr<ForwardingService> forwarding_service;  // in a cluster: listens in front of `grpc`
  std::unique_ptr<grpc::Server> forwarding_server;
  std::unique_ptr<WebGateway> web;
  std::unique_ptr<PeriodicTask> maintenance, readiness;
  std::unique_ptr<v1::ServerService::Stub> own_stub;  // for readiness
  std::atomic<bool> stopping = false;
  std::map<std::string, absl::Status> lost;
  MemoryTrimmer memory;        // of the maintenance
  absl::Status refresh_error;  // of the accounts; logged when it changes
};

absl::StatusOr<Server::Parts::Opened> Server::Parts::Open(const ServerOptions& options) {
  Opened opened;
  auto accounts = access::Accounts::Open(options.accounts);
  if (!accounts.ok()) return accounts.status();
  opened.accounts = *std::move(accounts);
  auto audit = access::AuditLog::Open(options.audit_file);
  if (!audit.ok()) return audit.status();
  opened.audit = *std::move(audit);
  if (!options.store_dir.empty()) {
    auto store = store::Store::Open(options.store_dir);
    if (!store.ok()) return store.status();
    opened.store = *std::move(store);
  }
  if (options.lti.used()) {
    auto key = lti::ToolKey::Open(options.lti.key_file);
    if (!key.ok()) return key.status();
    opened.lti_key = *std::move(key);
  }
  if (!options.cluster.redis.empty()) {
    cluster::ClusterOptions joining = options.cluster;
    joining.tls.certificate = options.tls.certificate;
    joining.tls.key = options.tls.key;
    auto cluster = cluster::Cluster::Join(joining);
    if (!cluster.ok()) return cluster.status();
    opened.cluster = *std::move(cluster);
  }
  return opened;
}

void Server::Parts::AddCalls() {
  scene_service.AddTo(calls);
  session_service.AddTo(calls);
  control_service.AddTo(calls);
  access_service.AddTo(calls);
  frame_service.AddTo(calls);
  sample_service.AddTo(calls);
  reference_service.AddTo(calls);
  tissue_service.AddTo(calls);
  export_service.AddTo(calls);
  upload_service.AddTo(calls);
  patient_service.AddTo(calls);
  study_service.AddTo(calls);
  compare_service.AddTo(calls);
  fit_service.AddTo(calls);
  server_service.AddTo(calls);
  health_service.AddTo(calls);
  AddReflection(calls);
}

void Server::Parts::JoinCluster() {
  if (cluster == nullptr) return;
  store->set_ownership(cluster.get());
  cluster->Start({.lost = [this](const std::string& id) { table.Drop(id); },
                  .take_over = [this](const store::SavedSession& saved,
                                      std::int64_t epoch) { return table.TakeOver(saved, epoch); },
                  .copy_whole = [this](const std::vector<std::string>& ids) { store->CopyWhole(ids); }});
  metrics.AddCluster([this] { return std::pair(cluster->counts(), router->forwarded()); });
}

absl::Status Server::Parts::Restore(const ServerOptions& options) {
  if (store == nullptr) return absl::OkStatus();
  const auto records = store->LoadRecords();  // before restored sessions save again
  if (!records.ok()) return records.status();
  auto restored = table.Restore([&options](const std::string& id) {
    if (options.restoring) options.restoring(id);
  });
  if (!restored.ok()) return restored.status();
  lost = *std::move(restored);
  for (const auto& [id, how] : table.carried_over()) spdlog::warn("session {}: {}", id, how);
  study_service.Restore(*records, lost);
  if (lti != nullptr) lti->tool().Restore(*records, lost);
  exports.Restore(
      *records, models, [this](const std::string& account) { return guard.AccountOf(account); }, lost);
  return absl::OkStatus();
}

void Server::Parts::Maintain() {
  table.Tend();
  tissue_service.DropUnused();
  const absl::Status refreshed = accounts->Refresh();
  if (!refreshed.ok() && refreshed != refresh_error) {
    spdlog::warn("{}; the previous accounts stay in use", std::string(refreshed.message()));
  }
  refresh_error = refreshed;
  memory.Trim();
}

void Server::Parts::CheckReady() {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kReadyTime);
  v1::GetServerResponse response;
  const grpc::Status status = own_stub->GetServer(&context, {}, &response);
  if (stopping || pages.ready() == status.ok()) return;
  pages.set_ready(status.ok());
  spdlog::warn("readyz: {}",
               status.ok() ? "calls get through again" : "a call does not get through: " + status.error_message());
}

absl::Status Server::Parts::Listen(const ServerOptions& options, grpc::ServerBuilder& builder) {
  if (options.listen.empty()) return absl::OkStatus();
  auto made = GrpcListener::Make(options.listen, static_cast<std::size_t>(options.max_connections),
                                 MakeCredentials(options.tls), builder);
  if (!made.ok()) return made.status();
  listener = *std::move(made);
  return absl::OkStatus();
}

// The forwarding server accepts all calls and passes this server's own ones to `grpc` in process.
absl::Status Server::Parts::ServeForwarding(const ServerOptions& options) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  router->set_local_channel(grpc->InProcessChannel(arguments));
  forwarding_service = std::make_unique<ForwardingService>(*router, calls, guard, forwarding_limits);
  grpc::ServerBuilder builder;
  Configure(options, builder);
  if (absl::Status status = Listen(options, builder); !status.ok()) return status;
  builder.RegisterCallbackGenericService(forwarding_service.get());
  forwarding_server = builder.BuildAndStart();
  return forwarding_server == nullptr ? absl::InternalError("gRPC could not be started") : absl::OkStatus();
}

absl::Status Server::Parts::Serve(const ServerOptions& options) {
  grpc::ServerBuilder builder;
  Configure(options, builder);
  if (router == nullptr) {
    if (absl::Status status = Listen(options, builder); !status.ok()) return status;
  }
  builder.RegisterCallbackGenericService(&calls);
  grpc = builder.BuildAndStart();
  if (grpc == nullptr) return absl::InternalError("gRPC could not be started");
  if (router != nullptr) {
    if (absl::Status status = ServeForwarding(options); !status.ok()) return status;
  }
  if (listener != nullptr) listener->Start();
  return absl::OkStatus();
}

absl::Status Server::Parts::ServeWeb(const ServerOptions& options) {
  if (options.web.empty()) return absl::OkStatus();
  WebGateway::Options web_options = {
      .address = options.web,
      .settings = {
          .root = options.web_root,
          .allowed_origins = options.allowed_origins,
          .allowed_hosts = options.allowed_hosts,
          .max_message_bytes = static_cast<std::size_t>(options.max_message_bytes),
          .head_time = std::chrono::milliseconds(Milliseconds(options.head_seconds)),
          .idle_time = std::chrono::milliseconds(Milliseconds(options.idle_seconds)),
          .page = [this](std::string_view target,
                         const WebSettings::Credentials& credentials) { return pages.Find(target, credentials); },
          .known =
              [this](const WebSettings::Credentials& credentials) {
                return guard.Known(credentials.authorization, credentials.join);
              }},
      .max_connections = static_cast<std::size_t>(options.max_connections),
      .tls = options.tls};
  web_options.settings.framers = options.allowed_origins;
  web_options.settings.answer = [this](const WebCall::Request& call) -> WebSettings::Answer {
    if (call.method != "/phrenic.v1.FrameService/AckFrames") return std::nullopt;
    return frame_service.AckFramesAtOnce(call.metadata, call.message);
  };
  if (lti != nullptr) lti->AddTo(web_options.settings);
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  auto gateway = WebGateway::Start(web_options, entry_server().InProcessChannel(arguments), watches);
  if (!gateway.ok()) return gateway.status();
  web = *std::move(gateway);
  server_service.set_web_port(web->port());
  return absl::OkStatus();
}

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerOptions& options) {
  SetCompileThreadStart(jobs::LowerThreadPriority);
  if (absl::Status status = CheckOptions(options); !status.ok()) return status;
  auto opened = Parts::Open(options);
  if (!opened.ok()) return opened.status();
  if (options.step_threads != StepThreads()) SetStepThreads(options.step_threads);
  std::unique_ptr<Server> server(new Server(std::make_unique<Parts>(options, *std::move(opened))));
  Parts& parts = *server->parts_;
  parts.JoinCluster();
  if (absl::Status status = parts.Restore(options); !status.ok()) return status;
  if (absl::Status status = parts.Serve(options); !status.ok()) return status;
  if (absl::Status status = parts.ServeWeb(options); !status.ok()) return status;
  parts.maintenance = std::make_unique<PeriodicTask>(kMaintenancePeriod, [&parts] { parts.Maintain(); });
  if (parts.cluster != nullptr) parts.cluster->StartTakeovers();
  parts.pages.set_ready(true);
  parts.own_stub = v1::ServerService::NewStub(parts.entry_server().InProcessChannel({}));
  parts.readiness = std::make_unique<PeriodicTask>(kMaintenancePeriod, [&parts] { parts.CheckReady(); });
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
  parts_->stopping = true;
  parts_->pages.set_ready(false);
  parts_->health_service.set_serving(false);
  parts_->readiness.reset();
  parts_->maintenance.reset();
  if (parts_->cluster != nullptr) parts_->cluster->Drain();
  if (parts_->listener != nullptr) parts_->listener->Shutdown();
  parts_->table.Close(absl::UnavailableError("the server is shutting down"));
  if (parts_->cluster != nullptr) parts_->cluster->Leave();
  if (parts_->web != nullptr) parts_->web->Shutdown();
  if (parts_->lti != nullptr) parts_->lti->Shutdown();
  if (parts_->forwarding_server != nullptr) {
    parts_->forwarding_server->Shutdown(std::chrono::system_clock::now() + kDrainTime);
  }
  if (parts_->grpc != nullptr) parts_->grpc->Shutdown(std::chrono::system_clock::now() + kDrainTime);
}

}  // namespace phrenic::service
