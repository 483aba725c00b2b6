// The methods of the server's services, and the gRPC service that calls their handlers.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_CALL_TABLE_H_
#define PHRENIC_SERVER_SERVICE_CALLS_CALL_TABLE_H_

#include <grpcpp/generic/async_generic_service.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "server/service/calls/reply_stream.h"
#include "server/service/calls/served_call.h"
#include "server/service/calls/status.h"

namespace phrenic::service {

// Filled before the server starts; then thread-safe. Handlers run on threads of their lane (CallLimits), may block
// there, and see with context->IsCancelled() that their client is gone.
//
// The server has one table; each service adds its methods to it (AddTo). It has no lock, because it does not change
// once gRPC calls it. Several threads may run the same handler at once, so a service locks what it changes.
class CallTable final : public grpc::CallbackGenericService {
 public:
  // A handler returns OK with a response, or a status without one; the response is then not sent. The context, the
  // request and the response live until the handler returns. A streaming handler writes its responses before it
  // returns.
  template <class Service, class Request, class Response>
  using Unary = grpc::Status (Service::*)(grpc::CallbackServerContext*, const Request*, Response*);
  // The same for a method whose response may be large: before it makes one, it asks the call whether it may be sent
  // (ServedCall::Reserve).
  template <class Service, class Request, class Response>
  using Large = grpc::Status (Service::*)(ServedCall&, const Request&, Response*);
  template <class Service, class Request, class Response>
  using Streaming = grpc::Status (Service::*)(grpc::CallbackServerContext*, const Request*, ReplyStream<Response>*);

  // The references outlive the table. They admit calls by their headers and limit them.
  CallTable(AccessGuard& guard, CallLimits& limits) : guard_(guard), limits_(limits) {}

  // Adds the method whose request has the handler's type. `service` outlives the table. access/rules.cc must have a
  // rule for the request type: the rule gives the method its name. Call it before the server starts. The request is
  // parsed on the lane's thread. The errors of Parse.
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
  void Add(Lane lane, Service& service, Large<Service, Request, Response> handler) {
    AddParsed<Request>(lane, [&service, handler](ServedCall& call, const Request& request) {
      Response response;
      grpc::Status status = (service.*handler)(call, request, &response);
      if (status.ok()) call.Reply(Serialize(response));
      return status;
    });
  }
  // The same for a method that answers with a stream.
  template <class Service, class Request, class Response>
  void Add(Lane lane, Service& service, Streaming<Service, Request, Response> handler) {
    AddParsed<Request>(lane, [&service, handler](ServedCall& call, const Request& request) {
      ReplyStream<Response> writer(call);
      return (service.*handler)(&call.context(), &request, &writer);
    });
  }
  // Adds a method with a stream of requests, each of which the handler answers once. The next request is read when the
  // client's flow control has accepted the answer; the first error ends the stream.
  template <class Service, class Request, class Response>
  void AddConversation(Lane lane, Service& service, Large<Service, Request, Response> handler) {
    const access::Rule* rule = access::RuleOf(Request::descriptor()->full_name());
    const auto answer = [&service, handler](ServedCall& call, const Request& request) -> std::optional<grpc::Status> {
      Response response;
      grpc::Status status = (service.*handler)(call, request, &response);
      if (!status.ok()) return status;
      if (!call.Write(Serialize(response))) return grpc::Status::CANCELLED;
      return std::nullopt;
    };
    Add("phrenic.v1", {rule, lane, Parsed<Request>(answer), /*conversation=*/true});
  }
  // Adds a method whose handler has the call itself: it parses the request, and may go on without a thread.
  // FrameService::WatchFrames is such a method, since its stream goes on without a thread.
  template <class Request>
  void AddRaw(Lane lane, Method::Handler handler) {
    const access::Rule* rule = access::RuleOf(Request::descriptor()->full_name());
    Add("phrenic.v1", {rule, lane, std::move(handler)});
  }
  // Adds method.rule->method of a package. If the path has a method already, that one stays. Requires: `method.rule`
  // outlives the table.
  void Add(const std::string& package, Method method);

  // Returns the method of a path, "/phrenic.v1.ServerService/GetServer", and its rule; null if the method is unknown.
  // The method lives as long as the table.
  const Method* Find(const std::string& path) const;
  const access::Rule* RuleOf(const std::string& path) const;
  // Returns the full names of the services, sorted. "phrenic.v1.SessionService" is one. Reflection lists them.
  std::vector<std::string> Services() const;

  // gRPC calls it for each call, on its own threads, when it has the headers. The call deletes itself after OnDone; one
  // of an unknown method ends with UNIMPLEMENTED.
  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* context) override;

 private:
  // Frees the bytes of the request before the handler runs, so that a long call does not keep them.
  template <class Request, class Handler>
  void AddParsed(Lane lane, Handler handler) {
    AddRaw<Request>(lane, Parsed<Request>(std::move(handler)));
  }
  template <class Request, class Handler>
  static Method::Handler Parsed(Handler handler) {
    return [handler](ServedCall& call) -> std::optional<grpc::Status> {
      Request request;
      const absl::Status parsed = Parse(call.request(), request);
      call.request().Clear();
      return parsed.ok() ? std::optional<grpc::Status>(handler(call, request)) : ToGrpc(parsed);
    };
  }

  AccessGuard& guard_;
  CallLimits& limits_;
  std::map<std::string, Method> methods_;  // by path; calls in progress point to its methods
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_CALL_TABLE_H_
