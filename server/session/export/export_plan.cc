#include "server/session/export/export_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "phrenic/v1/options.pb.h"
#include "server/mechanics/body_names.h"
#include "server/mechanics/measures/readings.h"
#include "server/mechanics/skinning/probe_position.h"
#include "server/mechanics/skinning/tissue_bodies.h"
#include "server/mesh/units.h"
#include "server/record/spool_file.h"
#include "server/session/export/export_catalogue.h"
#include "server/session/export/page_writer.h"
#include "server/session/run.h"

namespace phrenic::session {
namespace {

constexpr std::int64_t kBytesPerNumber = 16;  // of text
constexpr std::int64_t kBytesPerShape = 60;   // a triangle or an edge, in text or a .vtp
constexpr std::size_t kLongestStem = 100;

// True for what computes the motion of what is seen, and is not seen itself.
bool IsHiddenMechanics(const Model& model, const BodyModel& body) {
  if (body.first_vertex < 0 && body.anatomy.structure() != v1::STRUCTURE_INNER_CAGE) return false;
  for (const v1::Layer& layer : model.scene.layers()) {
    if (layer.name() == body.layer) return layer.has_opacity() && layer.opacity() == 0;
  }
  return false;
}

// Returns the bodies of a file that has no request for some: a page has what is seen, or all if nothing is.
std::vector<int> DefaultBodies(const Model& model, const record::Format& format) {
  if (!format.page) return TissueBodies(model);
  std::vector<int> all, seen;
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    all.push_back(i);
    if (!IsHiddenMechanics(model, model.bodies[static_cast<std::size_t>(i)])) seen.push_back(i);
  }
  return seen.empty() ? all : seen;
}

absl::StatusOr<std::vector<int>> Bodies(const Model& model, const v1::CreateExportRequest& request,
                                        const record::Format& format) {
  std::vector<bool> chosen(model.bodies.size(), false);
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) names.push_back(body.name);
  for (int k = 0; k < request.bodies_size(); ++k) {
    const auto named = BodiesNamed(model, request.bodies(k), absl::StrCat("bodies[", k, "]"));
    if (!named.ok()) return named.status();
    for (const int body : *named) chosen[static_cast<std::size_t>(body)] = true;
  }
  if (request.bodies().empty()) {
    for (const int body : DefaultBodies(model, format)) chosen[static_cast<std::size_t>(body)] = true;
  }
  std::vector<int> bodies;
  for (int i = 0; i < static_cast<int>(chosen.size()); ++i) {
    if (chosen[static_cast<std::size_t>(i)]) bodies.push_back(i);
  }
  if (bodies.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("bodies: the scene has no deformable body; name some of ", absl::StrJoin(names, ", ")));
  }
  return bodies;
}

// Chooses bodies, or columns of numbers, whichever the format holds.
absl::Status ChooseContent(const v1::CreateExportRequest& request, const Model& model, ExportPlan& plan) {
  if (!plan.format.numbers_only) {
    auto bodies = Bodies(model, request, plan.format);
    if (!bodies.ok()) return bodies.status();
    plan.bodies = *std::move(bodies);
    for (const int body : plan.bodies) plan.vertices += model.bodies[body].mesh.vertices.cols();
    return absl::OkStatus();
  }
  if (!request.bodies().empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("bodies: ", plan.format.name, " holds probes and measures only; leave the field out"));
  }
  if (!model.probes.empty() || !model.measures.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("format: the scene has neither probes nor measures, which are what ",
                                                 plan.format.name, " holds; add some, or choose another format"));
}

absl::Status ChooseValues(const v1::CreateExportRequest& request, ExportPlan& plan) {
  const std::vector<record::Values>& offered = plan.format.values;
  if (!offered.empty()) plan.values = offered.front();
  if (request.values() == v1::EXPORT_VALUES_UNSPECIFIED) return absl::OkStatus();
  plan.values =
      request.values() == v1::EXPORT_VALUES_DISPLACEMENTS ? record::Values::kDisplacements : record::Values::kPositions;
  if (std::find(offered.begin(), offered.end(), plan.values) != offered.end()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("values: ", plan.format.name, " has one kind of values; leave the field out"));
}

absl::Status ChooseStem(const v1::CreateExportRequest& request, ExportPlan& plan) {
  plan.file_stem = request.file_stem().empty() ? request.session_id() : request.file_stem();
  const auto allowed = [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
  };
  const bool plain = std::all_of(plan.file_stem.begin(), plan.file_stem.end(), allowed);
  if (plain && plan.file_stem[0] != '.' && plan.file_stem.size() <= kLongestStem) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("file_stem: the file's name has up to ", kLongestStem,
                   " letters, digits, \".\", \"_\" and \"-\", and does not begin with a dot"));
}

// Returns the time at which the first whole breath begins, at least one breath after the start of the run [s].
double NextBreath(const Fork& fork) {
  const double phase = std::max(1.0, std::ceil(fork.state.phase - kTimeTolerance));
  return fork.state.time + (phase - fork.state.phase) * fork.parameters.breath_length();
}

absl::Status ChooseTimes(const v1::CreateExportRequest& request, const Fork& fork, ExportPlan& plan) {
  plan.start = request.has_start() ? request.start() : fork.state.time;
  plan.seconds = request.seconds();
  if (plan.format.page && plan.seconds == 0) {
    plan.seconds = fork.parameters.breath_length();
    if (!request.has_start()) plan.start = NextBreath(fork);
  }
  if (plan.start < fork.state.time - kTimeTolerance) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "start: %g s is past, the session is at %g s; reset it, or choose a later time", plan.start, fork.state.time));
  }
  if (plan.format.instant && plan.seconds > 0) {
    return absl::InvalidArgumentError(absl::StrCat(
        "seconds: ", plan.format.name, " holds one instant; leave the length 0 and choose the time by start"));
  }
  if (request.has_steps_per_frame() && request.has_frames_per_second()) {
    return absl::InvalidArgumentError("steps_per_frame: give either this or frames_per_second");
  }
  plan.steps_per_frame = request.steps_per_frame();
  const auto* field = v1::CreateExportRequest::descriptor()->FindFieldByName("frames_per_second");
  plan.frames_per_second = field->options().GetExtension(v1::quantity).default_value();
  if (plan.format.frames_a_breath > 0) {
    plan.frames_per_second = plan.format.frames_a_breath / fork.parameters.breath_length();
  }
  if (request.has_frames_per_second()) plan.frames_per_second = request.frames_per_second();
  return absl::OkStatus();
}

// Estimates the bytes of file and spool, at the time step of `parameters`.
std::int64_t Estimate(const Model& model, const v1::Parameters& parameters, const ExportPlan& plan) {
  const double rate = plan.steps_per_frame > 0
                          ? 1 / (parameters.time_step() * static_cast<double>(plan.steps_per_frame))
                          : plan.frames_per_second;
  const auto frames = 1 + static_cast<std::int64_t>(plan.seconds * rate);
  std::int64_t shapes = 0;
  for (const int body : plan.bodies) {
    shapes += model.bodies[body].mesh.triangles.cols() + model.bodies[body].mesh.edges.cols();
  }
  if (plan.format.numbers_only)
    return frames * kBytesPerNumber * static_cast<std::int64_t>(1 + ColumnsOf(model).size());
  return kBytesPerShape * (plan.vertices + shapes) +
         frames * plan.vertices * (plan.format.file_bytes + plan.format.spool_bytes);
}

}  // namespace

absl::StatusOr<ExportPlan> PlanExport(const v1::CreateExportRequest& request, const Model& model, const Fork& fork,
                                      const std::string& spool_folder, const std::string& page_template) {
  auto format = record::FindFormat(ExportFormats(), request.format());
  if (!format.ok()) return format.status();
  ExportPlan plan;
  plan.format = *std::move(format);
  plan.spool_folder = spool_folder;
  if (plan.format.page) {
    plan.page_template = page_template;
    if (const auto page = ReadPageTemplate(page_template); !page.ok()) return page.status();
  }
  if (absl::Status status = ChooseContent(request, model, plan); !status.ok()) return status;
  if (absl::Status status = ChooseValues(request, plan); !status.ok()) return status;
  if (absl::Status status = ChooseStem(request, plan); !status.ok()) return status;
  if (absl::Status status = ChooseTimes(request, fork, plan); !status.ok()) return status;
  plan.bytes = Estimate(model, fork.parameters, plan);
  if (absl::Status status = record::CheckRoom(spool_folder, plan.bytes); !status.ok()) return status;
  return plan;
}

std::vector<record::Column> ColumnsOf(const Model& model) {
  std::vector<record::Column> columns;
  for (const Probe& probe : model.probes) {
    for (const char* axis : {" x", " y", " z"}) columns.push_back({probe.name + axis, "mm"});
  }
  for (const auto& measure : model.measures) columns.push_back({measure->name(), measure->unit()});
  return columns;
}

std::vector<double> NumbersAt(const Model& model, const v1::Parameters& parameters, const State& state) {
  std::vector<double> numbers;
  for (const Probe& probe : model.probes) {
    for (const double x : ProbePosition(model, state, probe)) numbers.push_back(kMillimetresAMetre * x);
  }
  for (const v1::MeasureReading& reading : ReadMeasures(model, MakeEvalContext(model, parameters, state))) {
    numbers.push_back(reading.value());
  }
  return numbers;
}

}  // namespace phrenic::session
