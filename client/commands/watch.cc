// `phrenic watch`: a session's numbers as they come, and what frames take where vertices are asked for.
#include <unistd.h>

#include <chrono>

#include "absl/strings/str_cat.h"
#include "client/commands.h"
#include "client/watch_printer.h"
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

}  // namespace

int Watch(const Context& context, const WatchOptions& options) {
  const auto stub = v1::FrameService::NewStub(Connect(context));
  const v1::WatchFramesRequest request = RequestOf(options);
  grpc::ClientContext call;
  NameSession(request, call);
  if (options.seconds > 0) {
    call.set_deadline(std::chrono::system_clock::now() +
                      std::chrono::milliseconds(static_cast<long>(1e3 * options.seconds)));
  }
  const Interruption::Scope scope(*context.interruption, call);
  const auto stream = stub->WatchFrames(&call, request);
  int lines = 0;
  const std::unique_ptr<WatchPrinter> printer = MakeWatchPrinter(context);
  v1::WatchFramesResponse event;
  v1::AckFramesRequest taken;
  while (stream->Read(&event)) {
    printer->Print(event);
    if (event.has_frame() && ++lines == options.count) call.TryCancel();
    taken.set_sequence(event.frame().sequence());
    if (event.has_frame() && request.max_unacked_frames() > 0) Acknowledge(*stub, request, taken);
  }
  const grpc::Status status = stream->Finish();
  const bool enough = lines > 0 && lines == options.count;
  const bool time_is_up = options.seconds > 0 && status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
  return status.ok() || enough || time_is_up ? kOk : Fail(context, status);
}

}  // namespace phrenic::client
