// Serialized messages as gRPC has them, read by their descriptors.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_MESSAGES_H_
#define PHRENIC_SERVER_SERVICE_CALLS_MESSAGES_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>

#include <cstdint>

#include "absl/status/status.h"

namespace phrenic::service {

// Parses a message without copying its bytes. Drops what it held, and unknown fields above 64 KiB. Thread-safe. Errors:
// INVALID_ARGUMENT if the bytes are not a `message`, which is then only partly filled; RESOURCE_EXHAUSTED, before
// anything is built, if it would take more than four times its length and 16 MiB of memory (UnfoldedBytes).
absl::Status Parse(const grpc::ByteBuffer& bytes, google::protobuf::Message& message);

// Returns the bytes of a message. Thread-safe. The bytes lie in one slice that the buffer owns, so the message need not
// outlive it. Requires: no other thread changes the message.
inline grpc::ByteBuffer Serialize(const google::protobuf::MessageLite& message) {
  grpc::Slice slice(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(const_cast<std::uint8_t*>(slice.begin()));
  return grpc::ByteBuffer(&slice, 1);
}

// Returns the string field "session_id" of a request type; null if it has none. AccessGuard reads the session of a call
// by it, and SessionRouter the session by which it routes. The field lives as long as `request`. Thread-safe.
inline const google::protobuf::FieldDescriptor* SessionIdField(const google::protobuf::Descriptor& request) {
  const auto* field = request.FindFieldByName("session_id");
  const bool is_string = field != nullptr && field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_STRING;
  return is_string ? field : nullptr;
}

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_MESSAGES_H_
