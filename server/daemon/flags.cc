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
constexpr double kLargestCount = 1e6;

// systemd's StateDirectory, else the user's.
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

// Options of one group, each with its variable.
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

void AddPlaces(CLI::App& app, Flags& flags) {
  service::ServerOptions& options = flags.options;
  options.listen = "127.0.0.1:50051";
  options.web = "127.0.0.1:8080";
  options.store_dir = DefaultStore();
  Group group(app, "Places");
  group.Add("config", flags.config, "File of settings, in TOML: a line NAME = VALUE each");
  group.Add("listen", options.listen, "HOST:PORT of gRPC");
  group.Add("web", options.web, "HOST:PORT of the viewer and gRPC-web");
  group.Add("data", options.data_dir, "Folder of surface files; scenes of your own in its folder scenes/");
  group.Add("scenes", options.scenes_dir, "Folder of the shipped scenes");
  group.Add("spool", options.spool_dir, "Folder on a disk with room, for exports and uploads; nothing stays in it");
  group.Add("store", options.store_dir,
            "Folder that sessions are saved in, so that they go on after the server ended; none: nowhere");
  group.Add("web-root", options.web_root, "Folder of the built viewer");
  group.Add("start", flags.start, "Scene to start and play, or none");
  group.Add("log", flags.log, "How the log is written on standard error: text, or json, an object a line")
      ->check(CLI::IsMember({"text", "json"}));
}

void AddLimits(CLI::App& app, Flags& flags) {
  service::ServerOptions& options = flags.options;
  session::Limits& limits = options.limits;
  Group group(app, "Limits");
  group.Add("max-sessions", limits.sessions, "Sessions at once", 1, 1000);
  group.Add("max-sessions-of-user", limits.sessions_of_user, "Sessions of one account at once", 1, 1000);
  group.Add("max-viewers", limits.viewers, "Viewers of one session", 1, 10000);
  group.Add("max-viewers-in-all", limits.viewers_in_all, "Viewers of all sessions", 1, kLargestCount);
  group.Add("max-vertices", limits.vertices, "Vertices of one scene", 1, 1e8);
  group.Add("max-message-mb", flags.message_mb, "Size of a request, uncompressed [MiB]", 1, 1024);
  group.Add("max-upload-mb", flags.upload_mb, "Size of an uploaded file [MiB]", 1, 65536);
  group.Add("max-uploads-mb", flags.uploads_mb,
            "Size of all uploaded files [MiB]; past it the one used longest ago goes", 1, 1048576);
  group.Add("session-cpu", limits.session_cpu, "Share of a processor core that stepping one session may have", 0.01, 1);
  group.Add("max-exports", limits.exports, "Exports at once; comparisons as well", 1, 64);
  group.Add("max-requests", options.max_requests,
            "Requests a second of one caller, an account or another machine, twice as many in a burst; 0: any number",
            0, kLargestCount);
  group.Add("max-connections", options.max_connections, "Connections to each of --web and --listen", 4, kLargestCount);
  group.Add("step-threads", options.step_threads, "Threads that a step of a large session may have", 1, 256);
  group.Add("keep-exports", limits.export_minutes, "Minutes that an export waits to be downloaded", 1, 10080);
  group.Add("head-seconds", options.head_seconds, "Time for the head of a request to come [s]", 1, 3600);
  group.Add("idle-seconds", options.idle_seconds,
            "Time for the rest of a request, and for a connection without one until it is closed [s]", 1, 86400);
  group.Add("pause-minutes", limits.pause_minutes,
            "Minutes that a session plays on while nobody watches or asks for it; 0: for ever", 0, kLargestCount);
  group.Add("delete-minutes", limits.delete_minutes,
            "Minutes that a session is kept while nobody watches or asks for it; 0: for ever", 0, kLargestCount);
  group.Add("stop-seconds", flags.stop_seconds, "Time to end in, when told to, before work is broken off [s]", 1, 600);
}

void AddAccess(CLI::App& app, Flags& flags) {
  service::ServerOptions& options = flags.options;
  Group group(app, "Access");
  group
      .Add("allow-origin", options.allowed_origins,
           "Web pages that may call, and show the viewer in a frame, as https://example.org")
      ->delimiter(',');
  group.Add("tls-cert", options.tls.certificate, "File of the certificate chain, PEM: encrypts gRPC and web");
  group.Add("tls-key", options.tls.key, "File of its private key, PEM");
  group.Add("tls-client-ca", options.tls.client_ca,
            "File of the authorities, PEM, one of which every client's own "
            "certificate must come from");
  group.AddFlag("insecure-listen", options.insecure_listen,
                "Listen to other machines without TLS: anybody on the way can read and change everything");
  access::AccountOptions& accounts = options.accounts;
  group.Add("tokens", accounts.tokens_file, "File of accounts (phrenicd token add); with it every call needs one");
  group.Add(
      "jwt-keys", accounts.jwt.keys,
      "File or https:// address of an identity provider's keys, a JSON Web Key Set or an OpenID configuration: its "
      "signed tokens are accounts too");
  group.Add("jwt-issuer", accounts.jwt.issuer, "What \"iss\" of such a token must be");
  group.Add("jwt-audience", accounts.jwt.audience, "What \"aud\" must be, or hold");
  group.Add("jwt-name-claim", accounts.jwt.name_claim, "Which claim names the account");
  group.Add("jwt-role-claim", accounts.jwt.role_claim, "Which claim has its role: viewer, controller, owner, admin");
  group.Add("audit", options.audit_file, "File that is told who did what; rotated past 16 MiB");
}

void AddCluster(CLI::App& app, Flags& flags) {
  cluster::ClusterOptions& cluster = flags.options.cluster;
  Group group(app, "More than one machine");
  group.Add("cluster", cluster.redis,
            "redis://[:PASSWORD@]HOST:PORT that the servers of a cluster share; none: a server by itself");
  group.Add("advertise", cluster.advertise, "HOST:PORT at which the cluster's other servers reach --listen");
}

}  // namespace

void AddFlags(CLI::App& app, Flags& flags) {
  AddPlaces(app, flags);
  AddAccess(app, flags);
  AddLimits(app, flags);
  AddCluster(app, flags);
}

service::ServerOptions OptionsOf(const Flags& flags) {
  service::ServerOptions options = flags.options;
  if (options.store_dir == "none") options.store_dir.clear();
  if (options.cluster.advertise.empty()) options.cluster.advertise = options.listen;
  options.max_message_bytes = flags.message_mb << 20;
  options.limits.upload_bytes = std::int64_t{flags.upload_mb} << 20;
  options.limits.uploads_bytes = std::int64_t{flags.uploads_mb} << 20;
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
