#include "server/service/frame_service.h"

#include <grpcpp/support/proto_buffer_reader.h>

#include "server/schema/schema.h"
#include "server/service/status.h"
#include "server/service/watch_reactor.h"
#include "server/stream/geometry.h"

namespace phrenic::service {
namespace {

// The session that the request names, when the request is in order.
absl::StatusOr<std::shared_ptr<session::Session>> Read(const session::Table& table, const grpc::ByteBuffer& bytes,
                                                       v1::WatchFramesRequest& request) {
  grpc::ByteBuffer copy = bytes;  // shares the bytes
  grpc::ProtoBufferReader reader(&copy);
  if (!request.ParseFromZeroCopyStream(&reader)) {
    return absl::InvalidArgumentError("the bytes are no phrenic.v1.WatchFramesRequest");
  }
  if (absl::Status status = schema::Validate(request); !status.ok()) return status;
  return table.Find(request.session_id());
}

}  // namespace

grpc::Status FrameService::GetGeometry(grpc::ServerContext* /*context*/, const v1::GetGeometryRequest* request,
                                       grpc::ServerWriter<v1::GetGeometryResponse>* writer) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  const auto session = table_.Find(request->session_id());
  if (!session.ok()) return ToGrpc(session.status());
  const Model& model = (*session)->model();
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    if (!writer->Write(stream::MakeGeometry(model, (*session)->publisher().layout(), body))) break;  // they went away
  }
  return grpc::Status::OK;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* FrameService::WatchFrames(grpc::CallbackServerContext* /*context*/,
                                                                      const grpc::ByteBuffer* bytes) {
  v1::WatchFramesRequest request;
  auto session = Read(table_, *bytes, request);
  const auto reactor = WatchReactor::Make();
  if (session.ok()) {
    reactor->Watch(*std::move(session), {.max_fps = request.max_fps(), .numbers_only = request.numbers_only()});
  } else {
    reactor->Refuse(session.status());
  }
  return reactor.get();
}

}  // namespace phrenic::service
