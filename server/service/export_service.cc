#include "server/service/export_service.h"

#include <string>
#include <string_view>

#include "absl/cleanup/cleanup.h"
#include "absl/strings/str_cat.h"
#include "server/record/recorder.h"
#include "server/schema/schema.h"
#include "server/service/status.h"
#include "server/session/exporter.h"

namespace phrenic::service {
namespace {

using ExportWriter = grpc::ServerWriter<v1::ExportMotionResponse>;

absl::Status Send(ExportWriter& writer, const v1::ExportMotionResponse& response) {
  if (writer.Write(response)) return absl::OkStatus();
  return absl::CancelledError("the receiver of the export went away");
}

session::ExportSink MakeSink(grpc::ServerContext& context, ExportWriter& writer) {
  return {.chunk =
              [&writer](std::string_view bytes) {
                v1::ExportMotionResponse response;
                response.set_chunk(std::string(bytes));
                return Send(writer, response);
              },
          .progress =
              [&context, &writer](double seconds) {
                if (context.IsCancelled()) return absl::CancelledError("the export was cancelled");
                v1::ExportMotionResponse response;
                response.set_recorded_seconds(seconds);
                return Send(writer, response);
              }};
}

}  // namespace

grpc::Status ExportService::ListFormats(grpc::ServerContext* /*context*/, const v1::ListFormatsRequest* /*request*/,
                                        v1::ListFormatsResponse* response) {
  for (const record::Format& format : record::Formats()) {
    v1::FileFormat& listed = *response->add_formats();
    listed.set_name(std::string(format.name));
    listed.set_description(std::string(format.description));
  }
  return grpc::Status::OK;
}

grpc::Status ExportService::ExportMotion(grpc::ServerContext* context, const v1::ExportMotionRequest* request,
                                         ExportWriter* writer) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  const auto session = table_.Find(request->session_id());
  if (!session.ok()) return ToGrpc(session.status());
  const absl::Cleanup leave = [this] { --exports_; };
  if (++exports_ > max_exports_) {
    return ToGrpc(absl::ResourceExhaustedError(
        absl::StrCat(max_exports_, " exports are under way, and no more are allowed; try again when one is done")));
  }
  auto fork = (*session)->MakeFork();
  if (!fork.ok()) return ToGrpc(fork.status());
  auto summary =
      session::ExportMotion(*request, (*session)->shared_model(), *std::move(fork), MakeSink(*context, *writer));
  if (!summary.ok()) return ToGrpc(summary.status());
  v1::ExportMotionResponse last;
  *last.mutable_summary() = *std::move(summary);
  return ToGrpc(Send(*writer, last));
}

}  // namespace phrenic::service
