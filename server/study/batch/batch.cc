#include "server/study/batch/batch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/compile/presets.h"
#include "server/schema/schema.h"
#include "server/schema/thread_cpu.h"
#include "server/stream/state_arrays.h"
#include "server/study/batch/run_pool.h"
#include "server/study/batch/run_reader.h"
#include "server/study/batch/start_state.h"
#include "server/study/subject.h"
#include "server/study/watched_run.h"

namespace phrenic::study {
namespace {

// Prefixes the message of an error.
absl::Status InField(const std::string& path, const absl::Status& status) {
  return {status.code(), absl::StrCat(path, status.message())};
}

// Sets the numbers that the request leaves out. Parameters stay: those not set are the scene's.
void SetDefaults(v1::RunBatchRequest& request) {
  v1::RunBatchRequest defaults;
  schema::FillDefaults(&defaults);
  if (!request.has_seconds()) request.set_seconds(defaults.seconds());
  if (!request.has_frames_per_second()) request.set_frames_per_second(defaults.frames_per_second());
  if (!request.has_threads()) request.set_threads(defaults.threads());
  if (!request.has_most_seconds_a_run()) request.set_most_seconds_a_run(defaults.most_seconds_a_run());
}

// Returns why a run ended early; empty if it did not.
std::string ProblemOf(const WatchedRun& run, double most_cpu) {
  if (run.cut) return absl::StrFormat("took more than %g s of CPU time, at %.6g s", most_cpu, run.simulated_s);
  if (run.status.ok()) return "";
  return absl::StrFormat("diverged at %.6g s at %s: %s", run.divergence.time(), Where(run.divergence),
                         run.divergence.remedy());
}

}  // namespace

Batch::Batch(v1::RunBatchRequest request, std::shared_ptr<const Model> model)
    : request_(std::move(request)), model_(std::move(model)), layout_(*model_) {}

absl::StatusOr<Batch> Batch::Make(v1::RunBatchRequest request, const Compiler& compile,
                                  const std::function<bool()>& cancelled) {
  if (request.runs_size() > kMostBatchRuns) {
    return absl::InvalidArgumentError(
        absl::StrFormat("runs: %d are more than %d: send several requests", request.runs_size(), kMostBatchRuns));
  }
  if (absl::Status status = stream::CheckParts(request.read()); !status.ok()) return status;
  auto model = compile(request.source());
  if (!model.ok()) return model.status();
  SetDefaults(request);
  Batch batch(std::move(request), *std::move(model));
  if (absl::Status status = batch.SetWanted(); !status.ok()) return status;
  if (absl::Status status = batch.Check(cancelled); !status.ok()) return status;
  return batch;
}

absl::Status Batch::SetWanted() {
  std::vector<bool> finished(static_cast<std::size_t>(request_.runs_size()));
  for (int i = 0; i < request_.finished_size(); ++i) {
    const int run = request_.finished(i);
    if (run < 0 || run >= request_.runs_size()) {
      return absl::InvalidArgumentError(
          absl::StrFormat("finished[%d]: %d is not the index of a run: there are %d, and the first is 0", i, run,
                          request_.runs_size()));
    }
    finished[static_cast<std::size_t>(run)] = true;
  }
  for (int run = 0; run < request_.runs_size(); ++run) {
    if (!finished[static_cast<std::size_t>(run)]) wanted_.push_back(run);
  }
  return absl::OkStatus();
}

double Batch::CountNumbers() const {
  constexpr int kRange = 3;  // numbers of a measure in a summary
  const double samples = request_.summary() ? kRange : request_.seconds() * request_.frames_per_second();
  return samples * static_cast<double>(model_->measures.size() + 1);
}

absl::Status Batch::Check(const std::function<bool()>& cancelled) const {
  const double numbers = CountNumbers();
  if (numbers > kMostSampledNumbers) {
    return absl::InvalidArgumentError(
        absl::StrFormat("frames_per_second: a run of %g s gives %.3g numbers, more than %.3g: lower it, or the seconds",
                        request_.seconds(), numbers, kMostSampledNumbers));
  }
  if (const auto preset = FindPreset(model_->scene, request_.preset()); !preset.ok()) return preset.status();
  for (const int run : wanted_) {
    if (cancelled()) return Cancelled();
    if (absl::Status status = CheckRun(run); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status Batch::CheckRun(int run) const {
  v1::Parameters parameters = model_->parameters;
  parameters.MergeFrom(*FindPreset(model_->scene, request_.preset()));
  parameters.MergeFrom(ParametersOf(run));
  if (absl::Status status = schema::Validate(parameters); !status.ok()) {
    return InField(absl::StrCat("runs[", run, "].parameters."), status);
  }
  return request_.runs(run).has_start() ? StartOf(run, parameters).status() : absl::OkStatus();
}

v1::Parameters Batch::ParametersOf(int run) const {
  v1::Parameters parameters = request_.parameters();
  parameters.MergeFrom(request_.runs(run).parameters());
  return parameters;
}

absl::StatusOr<Subject> Batch::SubjectOf(int run) const {
  const auto compiled = [this](const v1::SceneSource&) -> absl::StatusOr<std::shared_ptr<const Model>> {
    return model_;
  };
  return MakeSubject(request_.source(), request_.preset(), ParametersOf(run), compiled);
}

absl::StatusOr<State> Batch::StartOf(int run, const v1::Parameters& parameters) const {
  if (!request_.runs(run).has_start()) return model_->InitialState();
  return StartState(*model_, parameters, request_.runs(run).start(), absl::StrCat("runs[", run, "].start"));
}

int Batch::threads() const { return ThreadsFor(request_.threads(), wanted_.size()); }

v1::BatchHeader Batch::Header() const {
  v1::BatchHeader header;
  for (const auto& measure : model_->measures) {
    header.add_measures(measure->name());
    header.add_units(measure->unit());
  }
  if (request_.read().empty()) return header;
  google::protobuf::RepeatedField<int> names;
  names.Add(v1::STATE_PART_LAYOUT);
  auto arrays = stream::MakeStateArrays(*model_, layout_, model_->InitialState(), names);
  if (arrays.ok()) header.mutable_layout()->Swap(arrays->mutable_layout());
  return header;
}

std::size_t Batch::ResultBytes() const {
  return static_cast<std::size_t>(sizeof(double) * CountNumbers()) +
         stream::StateBytes(*model_, layout_, request_.read());
}

absl::StatusOr<v1::BatchResult> Batch::Run(int run, const std::function<bool()>& cancelled) const {
  const absl::StatusOr<Subject> subject = SubjectOf(run);
  if (!subject.ok()) return subject.status();
  const absl::StatusOr<State> start = StartOf(run, subject->parameters);
  if (!start.ok()) return start.status();
  const double began = ThreadCpuSeconds(), dt = subject->parameters.time_step();
  v1::BatchResult result;
  result.set_run(run);
  result.set_time_step(dt);
  const std::unique_ptr<RunReader> reader = RunReader::Make(request_, *subject, *start, result);
  const auto watched = Watch(
      *subject, *start, static_cast<double>(reader->steps()) * dt, dt, request_.most_seconds_a_run(),
      [&](double, std::string_view) { return !cancelled(); }, [&](const State& state) { reader->Look(state); });
  if (!watched.ok()) return watched.status();
  result.set_problem(ProblemOf(*watched, request_.most_seconds_a_run()));
  const State& last = reader->LastOr(*start);
  result.set_state_hash(absl::StrFormat("%016x", StateHash(last)));
  result.set_cpu_seconds(ThreadCpuSeconds() - began);
  if (request_.read().empty()) return result;
  auto arrays = stream::MakeStateArrays(*model_, layout_, last, request_.read());
  if (!arrays.ok()) return arrays.status();
  result.mutable_state()->Swap(&*arrays);
  return result;
}

}  // namespace phrenic::study
