// The methods of the server's services, and the gRPC service that calls their handlers.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_CALL_TABLE_H_
#define PHRENIC_SERVER_SERVICE_CALLS_CALL_TABLE_H_

#include <grpcpp/generic/async_generic_service.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/service/calls/reply_stream.h"
#include "server/service/calls/served_call.h"

namespace phrenic::service {

// Filled before the server starts; then thread-safe. Handlers run on threads of their lane (CallLimits), may block
// there, and see with context->IsCancelled() that their client is gone.
class CallTable final : public grpc::CallbackGenericService {
 public:
  template <class Service, class Request, class Response>
  using Unary = grpc::Status (Service::*)(grpc::CallbackServerContext*, const Request*, Response*);
  template <class Service, class Request, class Response>
  using Streaming = grpc::Status (Service::*)(grpc::CallbackServerContext*, const Request*, ReplyStream<Response>*);

  // The references outlive the table.
  CallTable(AccessGuard& guard, CallLimits& limits) : guard_(guard), limits_(limits) {}

  // Adds the method whose request has the handler's type. `service` outlives the table.
  template <class Service, class Request, class Response>
  void Add(Lane lane, Service& service, Unary<Service, Request, Response> handler) {
    AddParsed<Request>(lane, [&service, handler](ServedCall& call, const Request& request) {
      Response response;
      grpc::Status status = (service.*handler)(&call.context(), &request, &response);
      if (status.ok()) call.Reply(Serialize(response));
      return status;
    });
  }
  template <class Service, class Request, class Response>
  void Add(Lane lane, Service& service, Streaming<Service, Request, Response> handler) {
    AddParsed<Request>(lane, [&service, handler](ServedCall& call, const Request& request) {
      ReplyStream<Response> writer(call);
      return (service.*handler)(&call.context(), &request, &writer);
    });
  }
  // Adds a method whose handler has the call itself: it parses the request, and may go on without a thread.
  template <class Request>
  void AddRaw(Lane lane, Method::Handler handler) {
    const access::Rule* rule = access::RuleOf(Request::descriptor()->full_name());
    Add("phrenic.v1", {rule, lane, std::move(handler)});
  }
  // Adds method.rule->method of a package.
  void Add(const std::string& package, Method method);

  // Returns the method of a path, "/phrenic.v1.ServerService/GetServer", and its rule; null if there is none.
  const Method* Find(const std::string& path) const;
  const access::Rule* RuleOf(const std::string& path) const;
  // Returns the full names of the services, sorted.
  std::vector<std::string> Services() const;

  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* context) override;

 private:
  template <class Request, class Handler>
  void AddParsed(Lane lane, Handler handler) {
    AddRaw<Request>(lane, [handler](ServedCall& call) -> std::optional<grpc::Status> {
      Request request;
      const bool parsed = Parse(call.request(), request);
      call.request().Clear();
      if (parsed) return handler(call, request);
      return grpc::Status(grpc::StatusCode::INVALID_ARGUMENT,
                          absl::StrCat("the message is not a ", Request::descriptor()->full_name()));
    });
  }

  AccessGuard& guard_;
  CallLimits& limits_;
  std::map<std::string, Method> methods_;  // by path
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_CALL_TABLE_H_
