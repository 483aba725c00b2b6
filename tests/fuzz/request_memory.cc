// The memory that any bytes take as a request is counted before they are parsed: they take at most four times that.
#include <google/protobuf/message.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "phrenic/v1/session.pb.h"
#include "phrenic/v1/study.pb.h"
#include "server/service/calls/unfolded.h"

namespace phrenic::service {
namespace {

constexpr std::size_t kAnyMessage = 64 << 10;  // [bytes]; what a message of a few fields may take

template <class Request>
void TryRequest(const std::string& bytes) {
  const grpc::Slice slice(bytes);
  const std::size_t counted = UnfoldedBytes(grpc::ByteBuffer(&slice, 1), *Request::descriptor(), SIZE_MAX);
  if (UnfoldedBytes(grpc::ByteBuffer(&slice, 1), *Request::descriptor(), counted / 2) > counted) std::abort();
  Request request;
  if (request.ParseFromString(bytes) && request.SpaceUsedLong() > kAnyMessage + 4 * counted) std::abort();
}

}  // namespace
}  // namespace phrenic::service

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  phrenic::service::TryRequest<phrenic::v1::CreateSessionRequest>(bytes);
  phrenic::service::TryRequest<phrenic::v1::CreateStudyRequest>(bytes);
  return 0;
}
