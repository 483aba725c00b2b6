#include "server/service/reference_service.h"

#include "server/physiology/health_ranges.h"
#include "server/physiology/static_curves.h"
#include "server/service/calls/session_call.h"
#include "server/service/calls/status.h"

namespace phrenic::service {

grpc::Status ReferenceService::GetReferences(grpc::CallbackServerContext* context,
                                             const v1::GetReferencesRequest* request,
                                             v1::GetReferencesResponse* response) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  const v1::Scene& scene = call->session->model().scene;
  for (v1::HealthRange& range : physiology::HealthRanges(scene)) *response->add_ranges() = std::move(range);
  for (v1::StaticCurve& curve : physiology::StaticCurves(scene, call->session->status().parameters())) {
    *response->add_curves() = std::move(curve);
  }
  return grpc::Status::OK;
}

}  // namespace phrenic::service
