#include "server/service/tissue_service.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "server/service/calls/session_call.h"
#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

using physiology::LiveLungs;
using physiology::LungMoment;

constexpr int kMostPoints = 64;
constexpr absl::Duration kCancelInterval = absl::Milliseconds(100);                  // of a call that waits
constexpr const char* kRegionNames[] = {"base", "middle", "apex", "back", "front"};  // by LungRegion
static_assert(std::size(kRegionNames) == physiology::kLungRegions);

std::string FloatBytes(const Eigen::MatrixXd& numbers) {
  const Eigen::MatrixXf floats = numbers.cast<float>();
  return {reinterpret_cast<const char*>(floats.data()), sizeof(float) * static_cast<std::size_t>(floats.size())};
}

// The byte of a cell in GetTissueResponse.bricks.
char BrickByte(const BrickGrid& grid, int brick) {
  if (brick < 0) return 0;
  const BrickFractions& parts = grid.fractions()[static_cast<std::size_t>(brick)];
  const float inside = std::accumulate(parts.begin(), parts.end(), 0.0F) / static_cast<float>(parts.size());
  return static_cast<char>(1 + std::lround(254 * std::clamp(inside, 0.0F, 1.0F)));
}

void WriteLung(const LiveLungs::Lung& lung, v1::GetTissueResponse& response) {
  const BrickGrid& grid = lung.responses.grid();
  response.set_name(lung.name);
  response.mutable_origin()->set_x(grid.origin().x());
  response.mutable_origin()->set_y(grid.origin().y());
  response.mutable_origin()->set_z(grid.origin().z());
  response.set_edge(grid.edge());
  for (const int count : grid.cells()) response.add_cells(count);
  for (const int brick : grid.brick_of_cell()) response.mutable_bricks()->push_back(BrickByte(grid, brick));
  response.set_shapes(FloatBytes(lung.responses.shapes()));
  response.set_shape_count(static_cast<int>(lung.responses.shapes().cols()));
}

void WriteMoment(const LiveLungs::Lung& lung, const LungMoment& moment, v1::LungReading& reading) {
  reading.set_name(lung.name);
  reading.set_amplitudes(FloatBytes(moment.amplitudes));
  reading.set_volume(moment.volume);
  for (std::size_t r = 0; r < physiology::kLungRegions; ++r) {
    v1::RegionReading& region = *reading.add_regions();
    region.set_name(kRegionNames[r]);
    region.set_descent(moment.caudal[r]);
    region.set_ventilation(moment.gained[r]);
  }
}

void WritePoint(const LiveLungs& lungs, const std::vector<LungMoment>& moments, const v1::Vector& point,
                v1::PointReading& reading) {
  const auto read = lungs.Read(moments, {point.x(), point.y(), point.z()});
  if (!read) return;
  reading.set_lung(lungs.lungs()[static_cast<std::size_t>(read->lung)].name);
  reading.set_dx(read->tissue.displacement.x());
  reading.set_dy(read->tissue.displacement.y());
  reading.set_dz(read->tissue.displacement.z());
  reading.set_ventilation(read->tissue.Ventilation());
  reading.set_strain(read->tissue.LargestStrain());
}

}  // namespace

TissueService::TissueService(session::Table& table, AccessGuard& guard, const session::Limits& limits)
    : table_(table), guard_(guard), longest_(limits.compile_seconds) {}

void TissueService::AddTo(CallTable& calls) {
  calls.Add(Lane::kWork, *this, &TissueService::GetTissue);
  calls.Add(Lane::kWork, *this, &TissueService::ReadTissue);
}

void TissueService::DropUnused() {
  const absl::MutexLock lock(&mutex_);
  std::erase_if(made_, [](const auto& entry) { return entry.second->model.expired(); });
}

std::shared_ptr<TissueService::Made> TissueService::EntryOf(const std::shared_ptr<const Model>& model) {
  DropUnused();  // of a model that was at the same address too
  const absl::MutexLock lock(&mutex_);
  std::shared_ptr<Made>& made = made_[model.get()];
  if (made == nullptr) {
    made = std::make_shared<Made>();
    made->model = model;
  }
  return made;
}

TissueService::Lungs TissueService::LungsOf(const std::shared_ptr<const Model>& model,
                                            grpc::CallbackServerContext& context) {
  const std::shared_ptr<Made> made = EntryOf(model);
  absl::MutexLock lock(&made->mutex);
  const auto free = [&making = made->making] { return !making; };
  while (!made->mutex.AwaitWithTimeout(absl::Condition(&free), kCancelInterval)) {
    if (context.IsCancelled()) return absl::CancelledError("the caller has disconnected");
  }
  if (made->lungs) return *made->lungs;
  made->making = true;
  made->mutex.Unlock();
  const StopCheck stop([&context] { return context.IsCancelled(); }, longest_, "--max-compile-seconds");
  absl::StatusOr<LiveLungs> lungs = LiveLungs::Make(*model, stop);
  made->mutex.Lock();
  made->making = false;
  if (absl::IsCancelled(lungs.status())) return lungs.status();
  if (lungs.ok()) return made->lungs.emplace(std::make_shared<const LiveLungs>(*std::move(lungs)));
  return made->lungs.emplace(lungs.status());
}

grpc::Status TissueService::GetTissue(grpc::CallbackServerContext* context, const v1::GetTissueRequest* request,
                                      ReplyStream<v1::GetTissueResponse>* writer) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  const auto lungs = LungsOf(call->session->shared_model(), *context);
  if (!lungs.ok()) return ToGrpc(lungs.status());
  const std::vector<LiveLungs::Lung>& all = (*lungs)->lungs();
  for (const LiveLungs::Lung& lung : all) {
    const auto bytes = sizeof(float) * static_cast<std::size_t>(lung.responses.shapes().size());
    if (absl::Status reserved = writer->Reserve(bytes); !reserved.ok()) return ToGrpc(reserved);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    v1::GetTissueResponse response;
    response.set_lung_count(static_cast<int>(all.size()));
    response.set_lung_index(static_cast<int>(i));
    WriteLung(all[i], response);
    if (!writer->Write(response)) break;  // the client disconnected
  }
  return grpc::Status::OK;
}

grpc::Status TissueService::ReadTissue(grpc::CallbackServerContext* context, const v1::ReadTissueRequest* request,
                                       v1::ReadTissueResponse* response) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  if (request->points_size() > kMostPoints) {
    return ToGrpc(absl::InvalidArgumentError(
        absl::StrCat("points: up to ", kMostPoints, " are read in a call, not ", request->points_size())));
  }
  const auto lungs = LungsOf(call->session->shared_model(), *context);
  if (!lungs.ok()) return ToGrpc(lungs.status());
  const auto present = call->session->ReadState();
  if (!present.ok()) return ToGrpc(present.status());
  const std::vector<LungMoment> moments = (*lungs)->At(present->state(), present->parameters);
  response->set_tick(present->state().tick);
  response->set_time(present->state().time);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    WriteMoment((*lungs)->lungs()[i], moments[i], *response->add_lungs());
  }
  for (const v1::Vector& point : request->points()) {
    WritePoint(**lungs, moments, point, *response->add_points());
  }
  return grpc::Status::OK;
}

}  // namespace phrenic::service
