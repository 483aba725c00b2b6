#include "server/service/compare_service.h"

#include <string>
#include <string_view>

#include "server/compare/comparison.h"
#include "server/service/calls/status.h"
#include "server/session/present_body.h"
#include "server/stream/codecs/wire.h"

namespace phrenic::service {
namespace {

using CompareWriter = ReplyStream<v1::CompareResponse>;

absl::Status Send(CompareWriter& writer, const v1::CompareResponse& response) {
  return writer.Write(response) ? absl::OkStatus()
                                : absl::CancelledError("the client disconnected during the comparison");
}

compare::ComparisonSink MakeSink(grpc::CallbackServerContext& context, CompareWriter& writer) {
  return {.progress =
              [&](double done) {
                v1::CompareResponse response;
                response.set_progress(done);
                return !context.IsCancelled() && writer.Write(response);
              },
          .vertices =
              [&](const v1::VertexDistances& vertices) {
                v1::CompareResponse response;
                *response.mutable_vertices() = vertices;
                return Send(writer, response);
              },
          .map =
              [&](std::string_view bytes) {
                v1::CompareResponse response;
                response.set_map_chunk(std::string(bytes));
                return Send(writer, response);
              },
          .mesh =
              [&](const ConstPoints& x, const Triangles& triangles) {
                v1::CompareResponse response;
                stream::AppendFloats(x.cast<float>(), *response.mutable_mesh()->mutable_positions());
                stream::AppendIndices(triangles, *response.mutable_mesh()->mutable_triangles());
                return Send(writer, response);
              }};
}

}  // namespace

void CompareService::AddTo(CallTable& calls) { calls.Add(Lane::kWork, *this, &CompareService::Compare); }

grpc::Status CompareService::Compare(grpc::CallbackServerContext* context, const v1::CompareRequest* request,
                                     ReplyStream<v1::CompareResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto running = comparisons_.Take(guard_.ShareOf(*caller));
  if (!running.ok()) return ToGrpc(running.status());
  const auto bodies = [&](const v1::SessionBody& body, v1::ComparedState& state) -> absl::StatusOr<Mesh> {
    if (const auto seen = guard_.Find(*caller, body.session_id()); !seen.ok()) return seen.status();
    return session::FindPresentBody(table_, body, state);
  };
  const auto table = compare::Compare(*request, bodies, MakeSink(*context, *writer));
  if (!table.ok()) return ToGrpc(table.status());
  v1::CompareResponse response;
  *response.mutable_table() = *table;
  writer->Write(response);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
