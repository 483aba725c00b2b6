// What every command has: the channel to the server, unary calls, and what becomes of errors.
#ifndef PHRENIC_CLIENT_CONNECTION_H_
#define PHRENIC_CLIENT_CONNECTION_H_

#include <google/protobuf/message.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "client/interruption.h"

namespace phrenic::client {

// Exit codes, as scripts may rely on them.
inline constexpr int kOk = 0, kFailed = 1, kUsage = 2, kUnreachable = 3, kMissed = 4, kInterrupted = 130;

enum class Output { kTable, kJson, kCsv };

struct Context {
  std::string server = "127.0.0.1:50051";
  bool server_given = false;  // by a flag or the environment
  Output output = Output::kTable;
  Interruption* interruption = nullptr;  // outlives every command

  bool json() const { return output == Output::kJson; }
};

// A channel to the server; nothing is sent yet.
std::shared_ptr<grpc::Channel> Connect(const Context& context);

// Says the error on standard error, "phrenic: what is wrong and what to do", and gives the exit code for it.
int Fail(const Context& context, const grpc::Status& status);
int Fail(const absl::Status& status);

// "{...}" with the proto's own field names, every field written.
std::string Json(const google::protobuf::Message& message);

// One unary call with a deadline: `method` is a stub's member, as in Call(context, stub, &Stub::GetSession, ...).
template <typename Stub, typename Method, typename Request, typename Response>
grpc::Status Call(const Context& context, Stub& stub, Method method, const Request& request, Response* response,
                  int deadline_seconds = 120) {
  grpc::ClientContext call;
  call.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(deadline_seconds));
  const Interruption::Scope scope(*context.interruption, call);
  return (stub.*method)(&call, request, response);
}

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_H_
