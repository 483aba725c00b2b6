#include "client/connection/tissue_probe.h"

#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/connection/connection.h"
#include "server/mesh/units.h"

namespace phrenic::client {
namespace {

constexpr std::chrono::seconds kPatience(60);  // the first call for a scene computes for seconds

void AddTissueMeasure(const std::string& name, const char* unit, double value, v1::Frame& frame) {
  v1::MeasureReading& measure = *frame.add_measures();
  measure.set_name(name);
  measure.set_unit(unit);
  measure.set_value(value);
}

std::string PlaceText(const v1::Vector& at) {
  return absl::StrFormat("%g,%g,%g", kMillimetresAMetre * at.x(), kMillimetresAMetre * at.y(),
                         kMillimetresAMetre * at.z());
}

}  // namespace

absl::Status CheckQuestion(const TissueQuestion& question) {
  if (question.points_mm.size() % 3 == 0) return absl::OkStatus();
  return absl::InvalidArgumentError("--at takes three numbers a point: x,y,z at rest [mm, LPS]");
}

TissueProbe::TissueProbe(const Context& context, const std::string& session, TissueQuestion question)
    : question_(std::move(question)), stub_(v1::TissueService::NewStub(Connect(context))) {
  request_.set_session_id(session);
  for (size_t i = 0; i + 2 < question_.points_mm.size(); i += 3) {
    v1::Vector& point = *request_.add_points();
    point.set_x(question_.points_mm[i] / kMillimetresAMetre);
    point.set_y(question_.points_mm[i + 1] / kMillimetresAMetre);
    point.set_z(question_.points_mm[i + 2] / kMillimetresAMetre);
  }
}

void TissueProbe::AddLung(const v1::LungReading& lung, v1::Frame& frame) const {
  if (!question_.regions) return;
  AddTissueMeasure(absl::StrCat(lung.name(), " gained"), "m^3", lung.volume(), frame);
  for (const v1::RegionReading& region : lung.regions()) {
    AddTissueMeasure(absl::StrCat(lung.name(), " ", region.name(), " ventilation"), "1", region.ventilation(), frame);
  }
}

void TissueProbe::AddPoint(const v1::PointReading& reading, const v1::Vector& at, const std::string& name,
                           v1::Frame& frame) {
  v1::ProbeReading& probe = *frame.add_probes();
  probe.set_name(name);
  probe.set_x(at.x() + reading.dx());
  probe.set_y(at.y() + reading.dy());
  probe.set_z(at.z() + reading.dz());
  probe.set_dx(reading.dx());
  probe.set_dy(reading.dy());
  probe.set_dz(reading.dz());
  AddTissueMeasure(absl::StrCat(name, " ventilation"), "1", reading.ventilation(), frame);
  AddTissueMeasure(absl::StrCat(name, " strain"), "1", reading.strain(), frame);
}

grpc::Status TissueProbe::AddTo(v1::Frame& frame) {
  v1::ReadTissueResponse response;
  grpc::ClientContext call;  // not that which Ctrl-C cancels: the stream is
  call.set_deadline(std::chrono::system_clock::now() + kPatience);
  NameSession(request_, call);
  grpc::Status read = stub_->ReadTissue(&call, request_, &response);
  if (!read.ok()) return read;
  for (const v1::LungReading& lung : response.lungs()) AddLung(lung, frame);
  for (int i = 0; i < response.points_size(); ++i) {
    const v1::Vector& at = request_.points(i);
    const std::string& lung = response.points(i).lung();
    if (lung.empty()) {
      return {grpc::StatusCode::INVALID_ARGUMENT,
              absl::StrCat("--at ", PlaceText(at), ": no lung is there at rest; `phrenic lungs SCENE --grid FILE.vti` ",
                           "shows where the lungs are")};
    }
    AddPoint(response.points(i), at, absl::StrCat(lung, " ", PlaceText(at)), frame);
  }
  return grpc::Status::OK;
}

}  // namespace phrenic::client
