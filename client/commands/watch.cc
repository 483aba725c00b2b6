// `phrenic watch`: a session's numbers as they come, and what frames take where vertices are asked for.
#include <unistd.h>

#include <chrono>

#include "absl/strings/str_cat.h"
#include "client/commands/commands.h"
#include "client/print/watch_printer.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "server/stream/codec.h"

namespace phrenic::client {
namespace {

constexpr int kWindow = 4;  // frames unacknowledged

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

// Tells the server that the frame came, and fetches the shapes that there are. A call that fails is not repeated: the
// stream says what is wrong.
void Acknowledge(v1::FrameService::Stub& stub, const v1::WatchFramesRequest& watched, v1::AckFramesRequest& taken) {
  taken.set_session_id(watched.session_id());
  taken.set_watch_id(watched.watch_id());
  v1::AckFramesResponse answer;
  grpc::ClientContext call, fetch;
  NameSession(taken, call);
  if (!stub.AckFrames(&call, taken, &answer).ok() || answer.basis_epoch() <= taken.basis_epoch()) return;
  v1::GetBasisRequest request;
  request.set_session_id(watched.session_id());
  NameSession(request, fetch);
  v1::GetBasisResponse basis;
  if (stub.GetBasis(&fetch, request, &basis).ok()) taken.set_basis_epoch(basis.epoch());
}

// The frames of one connection, up to `count` of them over all.
class Watcher {
 public:
  Watcher(const Context& context, const WatchOptions& options)
      : context_(context),
        options_(options),
        stub_(v1::FrameService::NewStub(Connect(context))),
        request_(RequestOf(options)),
        printer_(MakeWatchPrinter(context)) {}

  grpc::Status Follow(Heard heard) {
    grpc::ClientContext call;
    NameSession(request_, call);
    if (options_.seconds > 0) call.set_deadline(end_);
    const Interruption::Scope scope(*context_.interruption, call);
    const auto stream = stub_->WatchFrames(&call, request_);
    v1::AckFramesRequest taken;  // what a server that starts anew knows of it: nothing
    for (v1::WatchFramesResponse event; stream->Read(&event);) {
      heard();
      printer_->Print(event);
      if (!event.has_frame()) continue;
      if (++frames_ == options_.count) call.TryCancel();
      taken.set_sequence(event.frame().sequence());
      if (request_.max_unacked_frames() > 0) Acknowledge(*stub_, request_, taken);
    }
    printer_->Leave();
    const grpc::Status status = stream->Finish();
    const bool enough = frames_ > 0 && frames_ == options_.count;
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
  int frames_ = 0;
};

}  // namespace

int Watch(const Context& context, const WatchOptions& options) {
  Watcher watcher(context, options);
  const grpc::Status status = RideOut(context, [&](Heard heard) { return watcher.Follow(heard); });
  const bool time_is_up = options.seconds > 0 && status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
  return status.ok() || time_is_up ? kOk : Fail(context, status);
}

}  // namespace phrenic::client
