// How much memory a serialized message takes when it is parsed, counted before anything of it is built.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_UNFOLDED_H_
#define PHRENIC_SERVER_SERVICE_CALLS_UNFOLDED_H_

#include <google/protobuf/descriptor.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstddef>

namespace phrenic::service {

// An empty message inside another one is two bytes on the wire and hundreds in memory, so 16 MB of them are gigabytes.
// Returns the bytes that a message of this type takes, roughly: objects of submessages and texts, elements of lists,
// and fields of unknown numbers. Stops counting at the first byte that is no protobuf, since the parser stops there
// too, and as soon as the count is above `enough` [bytes]. Thread-safe; takes time in proportion to the fields, and
// allocates a few kilobytes.
std::size_t UnfoldedBytes(const grpc::ByteBuffer& bytes, const google::protobuf::Descriptor& type, std::size_t enough);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_UNFOLDED_H_
