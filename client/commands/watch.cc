// `phrenic watch`: a session's numbers as they come.
#include <chrono>

#include "client/commands.h"
#include "client/watch_printer.h"
#include "phrenic/v1/frames.grpc.pb.h"

namespace phrenic::client {
int Watch(const Context& context, const WatchOptions& options) {
  const auto stub = v1::FrameService::NewStub(Connect(context));
  v1::WatchFramesRequest request;
  request.set_session_id(options.id);
  request.set_max_fps(options.frames_per_second);
  request.set_numbers_only(true);
  grpc::ClientContext call;
  if (options.seconds > 0) {
    call.set_deadline(std::chrono::system_clock::now() +
                      std::chrono::milliseconds(static_cast<long>(1e3 * options.seconds)));
  }
  const Interruption::Scope scope(*context.interruption, call);
  const auto stream = stub->WatchFrames(&call, request);
  int lines = 0;
  const std::unique_ptr<WatchPrinter> printer = MakeWatchPrinter(context);
  v1::WatchFramesResponse event;
  while (stream->Read(&event)) {
    printer->Print(event);
    if (event.has_frame() && ++lines == options.count) call.TryCancel();
  }
  const grpc::Status status = stream->Finish();
  const bool enough = lines > 0 && lines == options.count;
  const bool time_is_up = options.seconds > 0 && status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
  return status.ok() || enough || time_is_up ? kOk : Fail(context, status);
}

}  // namespace phrenic::client
