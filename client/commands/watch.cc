// `phrenic watch`: prints a session's values as they change and, with --codec, the size of its frames.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/schema_options.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/connection/tissue_probe.h"
#include "client/print/watch_printer.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "phrenic/v1/samples.grpc.pb.h"
#include "server/stream/codecs/codec.h"

namespace phrenic::client {
namespace {

constexpr int kWindow = 4;  // frames that may be unacknowledged

struct WatchOptions {
  std::string id;
  double seconds = 0;  // 0: until interrupted
  int count = 0;       // number of lines; 0: no limit
  double frames_per_second = 5;
  std::string codec;    // encoding of the vertices; empty: receive numbers only
  double bound_mm = 0;  // error bound of the codec [mm]; 0: the server's default
  TissueQuestion tissue;
  double every = 0;                   // interval of samples [simulated s]; 0: watch frames
  std::vector<std::string> measures;  // of the samples; empty: all
};

v1::WatchFramesRequest RequestOf(const WatchOptions& options) {
  v1::WatchFramesRequest request;
  request.set_session_id(options.id);
  request.set_max_fps(options.frames_per_second);
  request.set_numbers_only(options.codec.empty());
  if (options.codec.empty()) return request;
  for (const stream::CodecRow& row : stream::Codecs()) {
    if (row.name == options.codec) request.set_codec(row.codec);
  }
  if (options.bound_mm > 0) request.set_max_error_mm(options.bound_mm);
  request.set_watch_id(absl::StrCat("watch-", getpid()));
  request.set_max_unacked_frames(kWindow);
  return request;
}

// Acknowledges a frame and fetches a new basis if the server has one. Ignores errors: the stream reports them.
void Acknowledge(v1::FrameService::Stub& stub, const v1::WatchFramesRequest& watched,
                 v1::AckFramesRequest& acknowledged) {
  acknowledged.set_session_id(watched.session_id());
  acknowledged.set_watch_id(watched.watch_id());
  v1::AckFramesResponse answer;
  grpc::ClientContext call, fetch;
  NameSession(acknowledged, call);
  if (!stub.AckFrames(&call, acknowledged, &answer).ok() || answer.basis_epoch() <= acknowledged.basis_epoch()) return;
  v1::GetBasisRequest request;
  request.set_session_id(watched.session_id());
  NameSession(request, fetch);
  v1::GetBasisResponse basis;
  if (stub.GetBasis(&fetch, request, &basis).ok()) acknowledged.set_basis_epoch(basis.epoch());
}

// Watches frames over one or more connections, up to `count` in total.
class Watcher {
 public:
  Watcher(const Context& context, const WatchOptions& options)
      : context_(context),
        options_(options),
        stub_(v1::FrameService::NewStub(Connect(context))),
        request_(RequestOf(options)),
        printer_(MakeWatchPrinter(context)) {
    if (!options.tissue.empty()) tissue_.emplace(context, options.id, options.tissue);
  }

  grpc::Status Follow(OnReceived received) {
    grpc::ClientContext call;
    NameSession(request_, call);
    if (options_.seconds > 0) call.set_deadline(end_);
    const Interruption::Scope scope(*context_.interruption, call);
    const auto stream = stub_->WatchFrames(&call, request_);
    v1::AckFramesRequest acknowledged;  // empty, because a restarted server knows nothing of earlier frames
    grpc::Status read;
    for (v1::WatchFramesResponse event; stream->Read(&event);) {
      received();
      if (tissue_ && event.has_frame() && !(read = tissue_->AddTo(*event.mutable_frame())).ok()) break;
      printer_->Print(event);
      if (!event.has_frame()) continue;
      if (++frames_ == options_.count || !std::cout) call.TryCancel();  // or the output's disk is full
      acknowledged.set_sequence(event.frame().sequence());
      if (request_.max_unacked_frames() > 0) Acknowledge(*stub_, request_, acknowledged);
    }
    printer_->Detach();
    if (!read.ok()) call.TryCancel();
    const grpc::Status status = stream->Finish();
    if (!read.ok()) return read;
    const bool enough = !std::cout || (frames_ > 0 && frames_ == options_.count);
    return enough ? grpc::Status::OK : status;
  }

 private:
  const Context& context_;
  const WatchOptions& options_;
  const std::chrono::system_clock::time_point end_ =
      std::chrono::system_clock::now() + std::chrono::milliseconds(static_cast<long>(1e3 * options_.seconds));
  const std::unique_ptr<v1::FrameService::Stub> stub_;
  const v1::WatchFramesRequest request_;
  const std::unique_ptr<WatchPrinter> printer_;
  std::optional<TissueProbe> tissue_;  // none: the lungs are not read
  int frames_ = 0;
};

// Prints samples as frames, which have the same numbers.
class SampleWatcher {
 public:
  SampleWatcher(const Context& context, const WatchOptions& options)
      : context_(context),
        options_(options),
        stub_(v1::SampleService::NewStub(Connect(context))),
        printer_(MakeWatchPrinter(context)) {
    request_.set_session_id(options.id);
    request_.set_interval(options.every);
    request_.mutable_measures()->Assign(options.measures.begin(), options.measures.end());
  }

  grpc::Status Follow(OnReceived received) {
    grpc::ClientContext call;
    NameSession(request_, call);
    if (options_.seconds > 0) call.set_deadline(end_);
    const Interruption::Scope scope(*context_.interruption, call);
    const auto stream = stub_->WatchSamples(&call, request_);
    for (v1::WatchSamplesResponse response; !Enough() && stream->Read(&response);) {
      received();
      NotePosition(response.batch());
      Print(response.batch());
    }
    printer_->Detach();
    if (Enough()) call.TryCancel();
    const grpc::Status status = stream->Finish();
    return Enough() ? grpc::Status::OK : status;
  }

 private:
  bool Enough() const { return !std::cout || (options_.count > 0 && printed_ >= options_.count); }

  // The next connection goes on from here, if the server still has this track then; else it reports the gap.
  void NotePosition(const v1::SampleBatch& batch) {
    if (request_.track() != 0 && batch.track() != request_.track()) {
      std::cerr << "phrenic: samples are missing here: the server did not keep those since the connection was lost\n";
    }
    request_.set_track(batch.track());
    request_.set_last(batch.last());
  }

  void Print(const v1::SampleBatch& batch) {
    if (batch.quantities_size() > 0) quantities_ = {batch.quantities().begin(), batch.quantities().end()};
    if (batch.left_out() > 0) std::cerr << "phrenic: " << batch.left_out() << " samples were left out\n";
    for (const v1::Sample& sample : batch.samples()) {
      if (Enough()) return;
      v1::WatchFramesResponse event;
      v1::Frame& frame = *event.mutable_frame();
      frame.set_tick(sample.tick());
      frame.set_time(sample.time());
      frame.set_breath(sample.breath());
      const std::size_t values = std::min(quantities_.size(), static_cast<std::size_t>(sample.values_size()));
      for (std::size_t i = 0; i < values; ++i) {
        v1::MeasureReading& reading = *frame.add_measures();
        reading.set_name(quantities_[i].name());
        reading.set_unit(quantities_[i].unit());
        reading.set_value(sample.values(static_cast<int>(i)));
      }
      printer_->Print(event);
      ++printed_;
    }
  }

  const Context& context_;
  const WatchOptions& options_;
  const std::chrono::system_clock::time_point end_ =
      std::chrono::system_clock::now() + std::chrono::milliseconds(static_cast<long>(1e3 * options_.seconds));
  const std::unique_ptr<v1::SampleService::Stub> stub_;
  v1::WatchSamplesRequest request_;
  const std::unique_ptr<WatchPrinter> printer_;
  std::vector<v1::SampledQuantity> quantities_;
  int printed_ = 0;
};

// Returns an error for options that exclude each other.
absl::Status CheckSampling(const WatchOptions& options) {
  if (options.every > 0 && !(options.codec.empty() && options.tissue.empty())) {
    return absl::InvalidArgumentError("--every: has no vertices and no lungs; leave out --codec, --lungs and --at");
  }
  if (options.every == 0 && !options.measures.empty()) {
    return absl::InvalidArgumentError("--measure: chooses what --every samples; give --every as well");
  }
  return absl::OkStatus();
}

int Watch(const Context& context, const WatchOptions& options) {
  if (absl::Status status = CheckQuestion(options.tissue); !status.ok()) return Fail(status);
  if (absl::Status status = CheckSampling(options); !status.ok()) return Fail(status);
  grpc::Status status;
  if (options.every > 0) {
    SampleWatcher watcher(context, options);
    status = StreamWithReconnect(context, [&](OnReceived received) { return watcher.Follow(received); });
  } else {
    Watcher watcher(context, options);
    status = StreamWithReconnect(context, [&](OnReceived received) { return watcher.Follow(received); });
  }
  const bool time_is_up = options.seconds > 0 && status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
  return status.ok() || time_is_up ? kOk : Fail(context, status);
}

}  // namespace

CommandFunction SetUpWatch(CLI::App& command) {
  const auto options = std::make_shared<WatchOptions>();
  AddSession(command, options->id);
  command.add_option("--seconds", options->seconds, "stop after this time [s]")->check(NumberIn(0.0, 1e7));
  command.add_option("--count", options->count, "stop after this many lines");
  command.add_option("--fps", options->frames_per_second, "lines per second, at most")->capture_default_str();
  command
      .add_option(
          "--every", options->every,
          "print the measures at every such interval of simulated time [s], whatever --fps says; gaps are reported")
      ->check(NumberIn(1e-3, 60.0));
  command.add_option("--measure", options->measures, "with --every: print this measure only; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command.add_flag("--lungs", options->tissue.regions,
                   "also print what each lung's base, middle, apex, back and front have gained of their volume");
  command
      .add_option("--at", options->tissue.points_mm,
                  "also print how the lungs' tissue at x,y,z moves and stretches: its place at rest in the frame LPS "
                  "[mm]; may be repeated")
      ->check(NumberIn(-1e4, 1e4))
      ->delimiter(',')
      ->allow_extra_args(false);
  std::set<std::string> codecs;
  for (const stream::CodecRow& row : stream::Codecs()) codecs.emplace(row.name);
  command
      .add_option("--codec", options->codec,
                  "also receive the vertices in this encoding and print their size: " + absl::StrJoin(codecs, ", "))
      ->check(CLI::IsMember(codecs).description(""));
  AddNumber(command, "--bound", options->bound_mm, *v1::WatchFramesRequest::descriptor(), "max_error_mm");
  return Bind(&Watch, options);
}

}  // namespace phrenic::client
