// Calls of a server by requests in protobuf text format.
#ifndef PHRENIC_TESTS_SERVICE_CALL_H_
#define PHRENIC_TESTS_SERVICE_CALL_H_

#include <grpcpp/client_context.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "google/protobuf/text_format.h"

namespace phrenic::service {

// Returns the request; fails the test if the text is not one.
template <class Request>
Request RequestOf(const std::string& text) {
  Request request;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &request)) << text;
  return request;
}

// Calls a method of a stub. The deadline is 30 s; `sign` adds metadata.
template <class Stub, class Request, class Response, class Sign>
grpc::Status Call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                  const std::string& text, Response* response, const Sign& sign) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
  sign(context);
  return (stub.*method)(&context, RequestOf<Request>(text), response);
}
template <class Stub, class Request, class Response>
grpc::Status Call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                  const std::string& text, Response* response) {
  return Call(stub, method, text, response, [](grpc::ClientContext&) {});
}

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SERVICE_CALL_H_
