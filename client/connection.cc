#include "client/connection.h"

#include <google/protobuf/util/json_util.h>
#include <grpcpp/create_channel.h>

#include <iostream>

namespace phrenic::client {

std::shared_ptr<grpc::Channel> Connect(const Context& context) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(64 << 20);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  return grpc::CreateCustomChannel(context.server, grpc::InsecureChannelCredentials(), arguments);
}

int Fail(const Context& context, const grpc::Status& status) {
  if (context.interruption != nullptr && context.interruption->happened()) {
    std::cerr << "phrenic: interrupted\n";
    return kInterrupted;
  }
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE) {
    std::cerr << "phrenic: no server at " << context.server << " (" << status.error_message()
              << "): start one with deploy/run or phrenicd, or name another with --server HOST:PORT\n";
    return kUnreachable;
  }
  std::cerr << "phrenic: " << status.error_message() << "\n";
  return kFailed;
}

int Fail(const absl::Status& status) {
  std::cerr << "phrenic: " << std::string(status.message()) << "\n";
  return kFailed;
}

std::string Json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  (void)google::protobuf::util::MessageToJsonString(message, &text, options);
  return text;
}

}  // namespace phrenic::client
