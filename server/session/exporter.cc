#include "server/session/exporter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "phrenic/v1/options.pb.h"
#include "server/record/recorder.h"
#include "server/session/chunks.h"
#include "server/session/pace_meter.h"
#include "server/session/run.h"

namespace phrenic::session {
namespace {

using Wall = std::chrono::steady_clock;

constexpr auto kBetweenWords = std::chrono::milliseconds(200);  // of progress

double FramesPerSecond(const v1::ExportMotionRequest& request) {
  const auto* field = v1::ExportMotionRequest::descriptor()->FindFieldByName("frames_per_second");
  return request.has_frames_per_second() ? request.frames_per_second()
                                         : field->options().GetExtension(v1::quantity).default_value();
}

bool IsCalled(const BodyModel& body, const std::string& name) { return body.name == name || body.layer == name; }

absl::StatusOr<std::vector<int>> Bodies(const Model& model, const v1::ExportMotionRequest& request) {
  std::vector<bool> chosen(model.bodies.size(), false);
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) names.push_back(body.name);
  for (int k = 0; k < request.bodies_size(); ++k) {
    bool found = false;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (IsCalled(model.bodies[i], request.bodies(k))) found = chosen[i] = true;
    }
    if (found) continue;
    return absl::InvalidArgumentError(absl::StrCat("bodies[", k, "]: there is no body or layer \"", request.bodies(k),
                                                   "\"; there are ", absl::StrJoin(names, ", ")));
  }
  std::vector<int> bodies;
  for (int i = 0; i < static_cast<int>(chosen.size()); ++i) {
    const bool usual = request.bodies().empty() && model.bodies[i].role == v1::ROLE_DEFORMABLE;
    if (chosen[i] || usual) bodies.push_back(i);
  }
  if (bodies.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("bodies: the scene has no deformable body; name some of ", absl::StrJoin(names, ", ")));
  }
  return bodies;
}

// One export under way. Not thread-safe.
class Export {
 public:
  Export(const Model& model, std::vector<int> bodies, Run& run, record::Recorder& recorder, const ExportSink& sink)
      : model_(model), bodies_(std::move(bodies)), run_(run), recorder_(recorder), sink_(sink) {
    Eigen::Index vertices = 0;
    for (int body : bodies_) vertices += model_.bodies[body].mesh.vertices.cols();
    positions_.resize(3, vertices);
    start_ = run_.state().time;
  }

  absl::Status Record(double seconds, double frames_per_second) {
    if (absl::Status status = Begin(); !status.ok()) return status;
    const auto frames = static_cast<std::int64_t>(std::floor(seconds * frames_per_second + 1e-6));
    for (std::int64_t frame = 1; frame <= frames; ++frame) {
      const double time = start_ + static_cast<double>(frame) / frames_per_second;
      if (absl::Status status = StepTo(time); !status.ok()) return status;
      if (absl::Status status = AddFrame(); !status.ok()) return status;
    }
    if (absl::Status status = StepTo(start_ + seconds); !status.ok()) return status;
    return recorder_.End();
  }

  void FillSummary(v1::ExportSummary& summary) const {
    summary.set_frames(frames_);
    summary.set_vertices(positions_.cols());
    summary.set_steps(steps_);
    summary.set_simulated_seconds(run_.state().time - start_);
    summary.set_step_wall_seconds(step_wall_);
    summary.set_step_cpu_seconds(step_cpu_);
    summary.set_state_hash(HashText(run_.state()));
  }

 private:
  absl::Status Begin() {
    PlaceBodies();
    std::vector<record::RecordedBody> recorded;
    Eigen::Index first = 0;
    for (int body : bodies_) {
      recorded.push_back({model_.bodies[body].name, model_.bodies[body].mesh});
      Points& vertices = recorded.back().mesh.vertices;
      vertices = positions_.middleCols(first, vertices.cols());
      first += vertices.cols();
    }
    if (absl::Status status = recorder_.Begin(recorded); !status.ok()) return status;
    return AddFrame();
  }

  void PlaceBodies() {
    Eigen::Index first = 0;
    for (int body : bodies_) {
      const Eigen::Index count = model_.bodies[body].mesh.vertices.cols();
      PlaceBody(model_, run_.state(), body, positions_.middleCols(first, count));
      first += count;
    }
  }

  absl::Status AddFrame() {
    PlaceBodies();
    ++frames_;
    return recorder_.AddFrame(run_.state().time, positions_);
  }

  absl::Status StepTo(double time) {
    while (run_.state().time < time - kTimeTolerance) {
      if (absl::Status status = StepForAWhile(time); !status.ok()) return status;
      if (Wall::now() < last_word_ + kBetweenWords) continue;
      last_word_ = Wall::now();
      if (absl::Status status = sink_.progress(run_.state().time - start_); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  // Until `time`, or until a word is due.
  absl::Status StepForAWhile(double time) {
    const Wall::time_point start = Wall::now();
    const double cpu = ThreadCpuSeconds();
    absl::Status status;
    while (status.ok() && run_.state().time < time - kTimeTolerance && Wall::now() < last_word_ + kBetweenWords) {
      status = run_.Step();
      ++steps_;
    }
    step_wall_ += std::chrono::duration<double>(Wall::now() - start).count();
    step_cpu_ += ThreadCpuSeconds() - cpu;
    return status;
  }

  const Model& model_;
  const std::vector<int> bodies_;
  Run& run_;
  record::Recorder& recorder_;
  const ExportSink& sink_;
  Points positions_;
  double start_ = 0;
  Wall::time_point last_word_ = Wall::now();
  std::int64_t frames_ = 0, steps_ = 0;
  double step_wall_ = 0, step_cpu_ = 0;
};

}  // namespace

absl::StatusOr<v1::ExportSummary> ExportMotion(const v1::ExportMotionRequest& request,
                                               const std::shared_ptr<const Model>& model, Session::Fork fork,
                                               const ExportSink& sink) {
  Chunks chunks(sink.chunk);
  auto recorder = record::MakeRecorder(request.format(), [&](std::string_view bytes) { return chunks.Add(bytes); });
  if (!recorder.ok()) return recorder.status();
  auto bodies = Bodies(*model, request);
  if (!bodies.ok()) return bodies.status();
  Run run(model, std::move(fork.parameters), std::move(fork.state));
  Export work(*model, *std::move(bodies), run, **recorder, sink);
  if (absl::Status status = work.Record(request.seconds(), FramesPerSecond(request)); !status.ok()) return status;
  if (absl::Status status = chunks.Flush(); !status.ok()) return status;
  v1::ExportSummary summary;
  work.FillSummary(summary);
  summary.set_bytes(chunks.bytes());
  summary.set_sha256(chunks.Sha256());
  return summary;
}

}  // namespace phrenic::session
