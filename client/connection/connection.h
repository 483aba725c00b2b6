// The channel to the server, and calls on it.
#ifndef PHRENIC_CLIENT_CONNECTION_CONNECTION_H_
#define PHRENIC_CLIENT_CONNECTION_CONNECTION_H_

#include <google/protobuf/message.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <memory>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "client/connection/context.h"

namespace phrenic::client {

// Returns a channel to the server. Each call carries the account's token. Does not connect before the first call.
std::shared_ptr<grpc::Channel> Connect(const Context& context);

// Returns OK if Connect can read its files and sends no token unencrypted to another machine. INVALID_ARGUMENT names
// the option and the remedy.
absl::Status CheckConnection(const Context& context);

// Returns the viewer's address of a session, "http://127.0.0.1:8080/?session=class". Empty if the server serves no
// viewer or does not answer within 5 s.
std::string ViewerLink(const Context& context, const std::string& session);

// Runs a streaming call and repeats it if the connection breaks. `stream` makes the call once; it calls `received` for
// each message and returns the call's status. If a call ends with UNAVAILABLE after a message was received, it is
// repeated every second for up to 60 s; standard error reports the loss and the return. Returns the last status.
using OnReceived = absl::FunctionRef<void()>;
grpc::Status StreamWithReconnect(const Context& context, absl::FunctionRef<grpc::Status(OnReceived received)> stream);

// Adds the request's session_id, if it has one, to the call's metadata. A cluster routes the call by it.
void NameSession(const google::protobuf::Message& request, grpc::ClientContext& call);

// Makes a unary call with a deadline [s]. `method` is a stub's member function: Call(context, stub, &Stub::GetSession,
// ...). Ctrl-C cancels the call.
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
