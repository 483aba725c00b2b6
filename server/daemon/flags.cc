#include "server/daemon/flags.h"

#include <cstdlib>
#include <filesystem>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace phrenic::daemon {
namespace {

constexpr char kSystemFile[] = "/etc/phrenic/phrenicd.toml";
constexpr double kMaxCount = 1e6;

// Returns systemd's StateDirectory, else the XDG state folder of the user, else "none".
std::string DefaultStore() {
  const auto from = [](const char* variable, const char* below) {
    const char* folder = std::getenv(variable);
    return folder == nullptr || *folder == '\0' ? std::string() : absl::StrCat(folder, below);
  };
  for (const auto& [variable, below] :
       {std::pair("STATE_DIRECTORY", ""), {"XDG_STATE_HOME", "/phrenic"}, {"HOME", "/.local/state/phrenic"}}) {
    if (std::string folder = from(variable, below); !folder.empty()) return folder;
  }
  return "none";
}

// Adds options to one group of the help text, each with its environment variable.
class Group {
 public:
  Group(CLI::App& app, std::string name) : app_(app), name_(std::move(name)) {}

  template <class Value>
  CLI::Option* Add(const std::string& name, Value& value, const std::string& meaning) {
    return app_.add_option("--" + name, value, meaning)->capture_default_str()->envname(Variable(name))->group(name_);
  }
  template <class Number>
  void Add(const std::string& name, Number& value, const std::string& meaning, double least, double most) {
    Add(name, value, meaning)->check(CLI::Range(least, most));
  }
  void AddFlag(const std::string& name, bool& value, const std::string& meaning) {
    app_.add_flag("--" + name, value, meaning)->default_str("false")->envname(Variable(name))->group(name_);
  }

 private:
  static std::string Variable(const std::string& name) {
    return "PHRENICD_" + absl::AsciiStrToUpper(absl::StrReplaceAll(name, {{"-", "_"}}));
  }

  CLI::App& app_;
  const std::string name_;
};

void AddAddresses(CLI::App& app, Flags& flags) {
  service::ServerOptions& options = flags.options;
  options.listen = "127.0.0.1:50051";
  options.web = "127.0.0.1:8080";
  options.store_dir = DefaultStore();
  Group group(app, "Addresses and folders");
  group.Add("config", flags.config, "Settings file in TOML, with lines NAME = VALUE");
  group.Add("listen", options.listen, "HOST:PORT for gRPC");
  group.Add("web", options.web, "HOST:PORT for the viewer and gRPC-web");
  group.Add("data", options.data_dir, "Folder of surface files, with your own scenes in its subfolder scenes/");
  group.Add("scenes", options.scenes_dir, "Folder of the shipped scenes");
  group.Add("spool", options.spool_dir, "Folder for temporary files of exports and uploads");
  group.Add("cache", options.cache_dir, "Folder in which generated meshes are kept for the next start; none: not kept");
  group.Add("store", options.store_dir,
            "Folder in which sessions are saved, to resume them after a restart; none: not saved");
  group.Add("web-root", options.web_root, "Folder of the built viewer");
  group.Add("start", flags.start, "Scene to start and play, or none");
  group.Add("log", flags.log, "Format of the log on standard error: text, or json with one object per line")
      ->check(CLI::IsMember({"text", "json"}));
}

void AddLimits(CLI::App& app, Flags& flags) {
  service::ServerOptions& options = flags.options;
  session::Limits& limits = options.limits;
  Group group(app, "Limits");
  group.Add("max-sessions", limits.sessions, "Maximum number of sessions", 1, 1000);
  group.Add("max-sessions-of-user", limits.sessions_of_user, "Maximum number of sessions per account", 1, 1000);
  group.Add("max-viewers", limits.viewers, "Maximum number of viewers per session", 1, 10000);
  group.Add("max-viewers-in-all", limits.viewers_in_all, "Maximum number of viewers over all sessions", 1, kMaxCount);
  group.Add("max-vertices", limits.vertices, "Maximum number of vertices per scene", 1, 1e8);
  group.Add("max-elements", limits.elements,
            "Maximum number of springs, triangles, tetrahedra and other elements per scene", 1, 1e9);
  group.Add("max-compile-seconds", limits.compile_seconds, "Timeout for compiling a scene [s]; 0: none", 0, 86400);
  group.Add("max-message-mb", flags.message_mb, "Maximum size of a request, uncompressed [MiB]", 1, 1024);
  group.Add("max-upload-mb", flags.upload_mb, "Maximum size of an uploaded file [MiB]", 1, 65536);
  group.Add("max-uploads-mb", flags.uploads_mb,
            "Maximum size of all uploaded files [MiB]; without accounts the least recently used one makes room", 1,
            1048576);
  group.Add("max-uploads-mb-of-user", flags.uploads_mb_of_user,
            "Maximum size of the uploaded files of an account [MiB]; above it its least recently used one is deleted",
            1, 1048576);
  group.Add("session-cpu", limits.session_cpu, "Fraction of a processor core that stepping one session may use", 0.01,
            1);
  group.Add("max-exports", limits.exports,
            "Maximum number of exports at a time, of comparisons, of physiology checks, and of batches", 1, 64);
  group.Add("max-share", limits.share,
            "Fraction of viewers, exports, comparisons, physiology checks, batches and studies that one account, link "
            "or address "
            "may have",
            0.01, 1);
  group.Add("max-calls", options.max_calls,
            "Maximum number of calls and streams in flight of an account, link or address; a sixteenth for an address "
            "without an account",
            16, kMaxCount);
  group.Add("max-network-mb", options.network_mb,
            "Maximum memory of gRPC's connections [MiB]; above it calls are cancelled", 16, 65536);
  group.Add("max-requests", options.max_requests,
            "Maximum requests per second of an account or another machine, with bursts of twice as many; 0: no limit",
            0, kMaxCount);
  group.Add("max-connections", options.max_connections, "Maximum number of connections to --web and to --listen, each",
            4, kMaxCount);
  group.Add("step-threads", options.step_threads, "Maximum number of threads for a step of a large session", 1, 256);
  group.Add("keep-exports", limits.export_minutes, "Time that a finished export is kept [min]", 1, 10080);
  group.Add("head-seconds", options.head_seconds, "Timeout for the header of a request [s]", 1, 3600);
  group.Add("idle-seconds", options.idle_seconds, "Timeout for the body of a request and for an idle connection [s]", 1,
            86400);
  group.Add(
      "pause-minutes", limits.pause_minutes,
      "Time after which a session without viewers and calls is paused, unless asked to keep playing [min]; 0: never", 0,
      kMaxCount);
  group.Add("delete-minutes", limits.delete_minutes,
            "Time after which a session without viewers and calls is deleted [min]; 0: never", 0, kMaxCount);
  group.Add("stop-seconds", flags.stop_seconds, "Timeout for a clean shutdown, after which work is aborted [s]", 1,
            600);
}

void AddAccess(CLI::App& app, Flags& flags) {
  service::ServerOptions& options = flags.options;
  Group group(app, "Access");
  group
      .Add("allow-origin", options.allowed_origins,
           "Origins whose pages may call the server and frame the viewer, such as https://example.org")
      ->delimiter(',');
  group
      .Add("allow-host", options.allowed_hosts,
           "Names by which browsers reach --web, such as phrenic.example.org, beside localhost, the address of this "
           "machine and the names in --tls-cert")
      ->delimiter(',');
  group.Add("tls-cert", options.tls.certificate, "Certificate chain in PEM; enables TLS for gRPC and web");
  group.Add("tls-key", options.tls.key, "Private key of the certificate in PEM");
  group.Add("tls-client-ca", options.tls.client_ca,
            "CA certificates in PEM; every client must have a certificate of one of them");
  group.AddFlag("insecure-listen", options.insecure_listen,
                "Allow connections from other machines without TLS, which can be read and modified on the network");
  group.AddFlag("unguarded-listen", options.unguarded_listen,
                "Allow other machines to reach --listen without nginx in front of it, although one client can overload "
                "gRPC itself");
  access::AccountOptions& accounts = options.accounts;
  group.Add("tokens", accounts.tokens_file, "Token file (phrenicd token add); with it every call requires an account");
  group.Add(
      "jwt-keys", accounts.jwt.keys,
      "File or https:// address of an identity provider's JSON Web Key Set or OpenID configuration; its signed tokens "
      "are accepted as accounts");
  group.Add("jwt-issuer", accounts.jwt.issuer, "Required value of the claim \"iss\"");
  group.Add("jwt-audience", accounts.jwt.audience, "Required value of the claim \"aud\", or of one of its elements");
  group.Add("jwt-name-claim", accounts.jwt.name_claim, "Claim with the name of the account");
  group.Add("jwt-role-claim", accounts.jwt.role_claim, "Claim with its role: viewer, controller, owner or admin");
  group.Add("audit", options.audit_file, "Audit log file, rotated at 16 MiB");
}

void AddLti(CLI::App& app, Flags& flags) {
  lti::Options& lti = flags.options.lti;
  Group group(app, "Learning platforms");
  group.Add("lti-url", lti.url, "Address by which browsers reach this server, such as https://phrenic.example.org");
  group
      .Add("lti-platform", lti.platforms,
           "Learning platforms (LTI 1.3), each as \"issuer=URL client=ID deployment=ID login=URL token=URL keys=URL\", "
           "with \"audience=TEXT\" and further \"deployment=ID\" and \"origin=URL\" where the platform needs them")
      ->delimiter(',');
  group.Add("lti-key", lti.key_file,
            "File of this server's private keys for platforms, made if it is missing; empty: lti-key.json in --store");
  group.Add("xapi-url", lti.lrs_url, "Address of a store of learning records (xAPI), without /statements");
  group.Add("xapi-user", lti.lrs_user, "Its user name");
  group.Add("xapi-password", lti.lrs_password_file, "File with its password");
}

void AddCluster(CLI::App& app, Flags& flags) {
  cluster::ClusterOptions& cluster = flags.options.cluster;
  Group group(app, "Cluster");
  group.Add("cluster", cluster.redis,
            "redis://[:PASSWORD@]HOST:PORT of the cluster's Redis, rediss:// with TLS; empty: not in a cluster");
  group.Add("advertise", cluster.advertise, "HOST:PORT at which the other servers of the cluster reach --listen");
  group.Add(
      "cluster-ca", cluster.tls.ca,
      "CA certificates in PEM of the cluster's other servers and of a Redis with TLS; empty: those of the system");
}

}  // namespace

void AddFlags(CLI::App& app, Flags& flags) {
  AddAddresses(app, flags);
  AddAccess(app, flags);
  AddLti(app, flags);
  AddLimits(app, flags);
  AddCluster(app, flags);
}

service::ServerOptions OptionsOf(const Flags& flags) {
  service::ServerOptions options = flags.options;
  if (options.store_dir == "none") options.store_dir.clear();
  if (options.cluster.advertise.empty()) options.cluster.advertise = options.listen;
  if (options.lti.key_file.empty() && !options.store_dir.empty()) {
    options.lti.key_file = options.store_dir + "/lti-key.json";
  }
  options.max_message_bytes = flags.message_mb << 20;
  options.limits.upload_bytes = std::int64_t{flags.upload_mb} << 20;
  options.limits.uploads_bytes = std::int64_t{flags.uploads_mb} << 20;
  options.limits.uploads_bytes_of_user = std::int64_t{flags.uploads_mb_of_user} << 20;
  return options;
}

std::string ConfigFile(const std::vector<std::string>& words) {
  constexpr char kFlag[] = "--config";
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == kFlag && i + 1 < words.size()) return words[i + 1];
    if (absl::StartsWith(words[i], "--config=")) return words[i].substr(sizeof kFlag);
  }
  if (const char* file = std::getenv("PHRENICD_CONFIG"); file != nullptr) return file;
  std::error_code error;
  return std::filesystem::exists(kSystemFile, error) ? kSystemFile : "";
}

}  // namespace phrenic::daemon
