#include "server/service/calls/messages.h"

#include <grpcpp/support/proto_buffer_reader.h>

#include <cstddef>

#include "absl/strings/str_cat.h"
#include "server/service/calls/unfolded.h"

namespace phrenic::service {
namespace {

// Scenes of large meshes take about three bytes for each on the wire.
constexpr std::size_t kUnfoldedOfByte = 4, kUnfoldedOfAny = 16 << 20;
constexpr std::size_t kShort = 64 << 10;  // [bytes]; a message as short cannot take more than kUnfoldedOfAny

}  // namespace

absl::Status Parse(const grpc::ByteBuffer& bytes, google::protobuf::Message& message) {
  message.Clear();
  const std::size_t length = bytes.Length(), most = kUnfoldedOfAny + kUnfoldedOfByte * length;
  if (length > kShort && UnfoldedBytes(bytes, *message.GetDescriptor(), most) > most) {
    return absl::ResourceExhaustedError(
        absl::StrCat("the message of ", length, " bytes would take more than ", most >> 20,
                     " MiB of memory: it has too many entries for its size; leave out those that are empty"));
  }
  grpc::ByteBuffer shared = bytes;  // shares the slices; the reader needs a non-const buffer
  grpc::ProtoBufferReader reader(&shared);
  if (!message.ParseFromZeroCopyStream(&reader)) {
    return absl::InvalidArgumentError(absl::StrCat("the message is not a ", message.GetTypeName()));
  }
  if (length > kShort) message.DiscardUnknownFields();  // a session would keep those of its scene
  return absl::OkStatus();
}

}  // namespace phrenic::service
