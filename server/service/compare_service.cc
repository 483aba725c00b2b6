#include "server/service/compare_service.h"

#include <string>
#include <string_view>

#include "absl/cleanup/cleanup.h"
#include "absl/strings/str_cat.h"
#include "server/schema/schema.h"
#include "server/service/status.h"
#include "server/study/comparison.h"

namespace phrenic::service {

grpc::Status CompareService::Compare(grpc::ServerContext* context, const v1::CompareRequest* request,
                                     grpc::ServerWriter<v1::CompareResponse>* writer) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  const absl::Cleanup leave = [this] { --comparisons_; };
  if (++comparisons_ > max_comparisons_) {
    return ToGrpc(absl::ResourceExhaustedError(absl::StrCat(
        max_comparisons_, " comparisons are under way, and no more are allowed; try again when one is done")));
  }
  v1::CompareResponse response;
  const auto table = study::Compare(
      *request,
      [&](double done) {
        response.set_progress(done);
        return !context->IsCancelled() && writer->Write(response);
      },
      [&](std::string_view bytes) {
        response.set_map_chunk(std::string(bytes));
        return writer->Write(response) ? absl::OkStatus() : absl::CancelledError("the receiver of the map went away");
      });
  if (!table.ok()) return ToGrpc(table.status());
  *response.mutable_table() = *table;
  writer->Write(response);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
