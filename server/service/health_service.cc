#include "server/service/health_service.h"

#include <grpcpp/support/slice.h>

#include <string>

#include "absl/time/clock.h"

namespace phrenic::service {
namespace {

constexpr access::Rule kCheck = {.method = "Health.Check", .open = true};
constexpr access::Rule kWatch = {.method = "Health.Watch", .open = true};
constexpr absl::Duration kLook = absl::Milliseconds(200);  // between two looks at the state
constexpr char kServing = 1, kNotServing = 2;              // HealthCheckResponse.ServingStatus

// Returns a HealthCheckResponse: field 1, an enum.
grpc::ByteBuffer Response(bool serving) {
  const grpc::Slice slice(std::string{'\x08', serving ? kServing : kNotServing});
  return grpc::ByteBuffer(&slice, 1);
}

}  // namespace

void HealthService::AddTo(CallTable& calls) {
  const auto check = [this](ServedCall& call) -> std::optional<grpc::Status> {
    call.Reply(Response(serving_));
    return grpc::Status::OK;
  };
  calls.Add("grpc.health.v1", {.rule = &kCheck, .lane = Lane::kQuick, .handler = check});
  calls.Add("grpc.health.v1",
            {.rule = &kWatch, .lane = Lane::kWatch, .handler = [this](ServedCall& call) { return Watch(call); }});
}

std::optional<grpc::Status> HealthService::Watch(ServedCall& call) const {
  bool told = !serving_;
  while (!call.context().IsCancelled()) {
    if (const bool serving = serving_; serving != told) {
      if (!call.Write(Response(serving))) break;
      told = serving;
    }
    absl::SleepFor(kLook);
  }
  return grpc::Status::CANCELLED;
}

}  // namespace phrenic::service
