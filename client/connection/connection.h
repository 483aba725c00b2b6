// What every command has: the channel to the server, unary calls, and what becomes of errors.
#ifndef PHRENIC_CLIENT_CONNECTION_CONNECTION_H_
#define PHRENIC_CLIENT_CONNECTION_CONNECTION_H_

#include <google/protobuf/message.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "client/terminal/interruption.h"
#include "server/settings/setting.h"

namespace phrenic::client {

// Exit codes, as scripts may rely on them.
inline constexpr int kOk = 0, kFailed = 1, kUsage = 2, kUnreachable = 3, kMissed = 4, kNotAllowed = 5,
                     kInterrupted = 130;

// For people, as one JSON document, as one JSON document a line, and as RFC 4180 has it.
enum class Output { kTable, kJson, kJsonl, kCsv };

struct Context {
  std::string server = "127.0.0.1:50051";  // "https://HOST:PORT" where it is encrypted
  std::string tls_ca;                      // file of the authorities to trust; empty: the system's
  std::string tls_cert, tls_key;           // files of one's own certificate; empty: none
  std::string token_file;                  // of an account; empty: $PHRENIC_TOKEN, or none
  bool server_given = false;               // by a flag, the environment or the settings file
  std::string viewer;                      // "https://host"; empty: where the server says
  Output output = Output::kTable;
  Interruption* interruption = nullptr;     // outlives every command
  std::vector<settings::Setting> settings;  // as they came
  std::string settings_file;                // whether it is there or not

  bool json() const { return output == Output::kJson || output == Output::kJsonl; }
};

// HOST:PORT of the server, and whether calls are encrypted.
std::string HostOf(const Context& context);
bool IsEncrypted(const Context& context);

// A channel to the server, whose calls carry the account's token; nothing is sent yet.
std::shared_ptr<grpc::Channel> Connect(const Context& context);

// What Connect needs can be read, and no token goes to another machine unencrypted; else what to do.
absl::Status CheckConnection(const Context& context);

// The address of the viewer's page of a session, "http://127.0.0.1:8080/?session=class"; empty where the server serves
// no viewer.
std::string ViewerLink(const Context& context, const std::string& session);

// "phrenic:", as errors begin on standard error; red on a terminal.
std::string ErrorName();

// A stream of what outlives its server: where it breaks off after it `heard` something, it is called again every second
// until the server is back, for a minute at the most; standard error says both. Its last status.
using Heard = absl::FunctionRef<void()>;
grpc::Status RideOut(const Context& context, absl::FunctionRef<grpc::Status(Heard heard)> stream);

// Says the error on standard error, "phrenic: what is wrong and what to do", what to type next below it, and gives the
// exit code for it.
int Fail(const Context& context, const grpc::Status& status);
int Fail(const absl::Status& status);

// "{...}" with the proto's own field names, every field written.
std::string Json(const google::protobuf::Message& message);

// Names the session that the request is about in the call's head, where it is about one: by it a cluster's front
// chooses the server.
void NameSession(const google::protobuf::Message& request, grpc::ClientContext& call);

// One unary call with a deadline: `method` is a stub's member, as in Call(context, stub, &Stub::GetSession, ...).
template <typename Stub, typename Method, typename Request, typename Response>
grpc::Status Call(const Context& context, Stub& stub, Method method, const Request& request, Response* response,
                  int deadline_seconds = 120) {
  grpc::ClientContext call;
  call.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(deadline_seconds));
  NameSession(request, call);
  const Interruption::Scope scope(*context.interruption, call);
  return (stub.*method)(&call, request, response);
}

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_CONNECTION_H_
