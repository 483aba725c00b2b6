// The options that every command has, and the exit codes.
#ifndef PHRENIC_CLIENT_CONNECTION_CONTEXT_H_
#define PHRENIC_CLIENT_CONNECTION_CONTEXT_H_

#include <string>
#include <vector>

#include "client/terminal/interruption.h"
#include "server/settings/setting.h"

namespace phrenic::client {

// Exit codes. Scripts rely on them.
inline constexpr int kOk = 0, kFailed = 1, kUsage = 2, kUnreachable = 3, kMissed = 4, kNotAllowed = 5,
                     kInterrupted = 130;

// Output formats: aligned tables for people, one JSON document, one JSON document per line, CSV (RFC 4180).
enum class Output { kTable, kJson, kJsonl, kCsv };

// Options of every command. Constant while a command runs.
struct Context {
  std::string server = "127.0.0.1:50051";  // HOST:PORT, or "https://HOST:PORT" for an encrypted connection
  std::string tls_ca;                      // file of certificate authorities (PEM); empty: the system's
  std::string tls_cert, tls_key;           // files of the client's certificate and key (PEM); empty: none
  std::string token_file;                  // file of the account's token; empty: $PHRENIC_TOKEN, if set
  bool server_given = false;               // true if an option, the environment or the settings file names the server
  std::string viewer;                      // URL of the viewer; empty: the one that the server reports
  Output output = Output::kTable;
  Interruption* interruption = nullptr;     // outlives every command
  std::vector<settings::Setting> settings;  // values and origins, for `phrenic doctor`
  std::string settings_file;                // path; the file may not exist

  bool json() const { return output == Output::kJson || output == Output::kJsonl; }
};

// Returns HOST:PORT of the server, without a scheme.
std::string HostOf(const Context& context);
// True if calls to the server use TLS.
bool IsEncrypted(const Context& context);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_CONTEXT_H_
