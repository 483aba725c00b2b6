#include <unistd.h>

#include <chrono>
#include <iostream>

#include "absl/strings/str_format.h"
#include "client/commands.h"
#include "client/print_session.h"
#include "client/readings.h"
#include "phrenic/v1/frames.grpc.pb.h"

namespace phrenic::client {
namespace {

// "t 1.250 s  tick 2500  breath 0.500  right dome -0.1 -0.4 -9.2 mm  lung volume 2.513 l".
std::string Line(const v1::Frame& frame) {
  std::string line = absl::StrFormat("t %.3f s  tick %d  breath %.3f", frame.time(), frame.tick(), frame.breath());
  for (const v1::ProbeReading& probe : frame.probes()) {
    absl::StrAppendFormat(&line, "  %s %.1f %.1f %.1f mm", probe.name(), 1e3 * probe.dx(), 1e3 * probe.dy(),
                          1e3 * probe.dz());
  }
  for (const v1::MeasureReading& reading : frame.measures()) {
    absl::StrAppendFormat(&line, "  %s %s", reading.name(), ReadingText(reading.value(), reading.unit()));
  }
  return line;
}

// Prints events as they come; lines overwrite each other on a terminal.
class Printer {
 public:
  explicit Printer(const Context& context) : json_(context.json()), live_(!json_ && isatty(STDOUT_FILENO) != 0) {}
  ~Printer() {
    if (live_) std::cout << "\n";
  }
  Printer(const Printer&) = delete;
  Printer& operator=(const Printer&) = delete;

  void Print(const v1::WatchFramesResponse& event) {
    if (json_) {
      std::cout << Json(event) << std::endl;
    } else if (event.has_frame()) {
      std::cout << (live_ ? "\r\x1b[K" : "") << Line(event.frame()) << residual_ << (live_ ? "" : "\n") << std::flush;
    } else {
      PrintState(event.session());
    }
  }

 private:
  void PrintState(const v1::Session& session) {
    residual_ = SolverText(session, "  solver: ", "") + ResidualText(session, "  constraints within ", "");
    if (session.revision() == revision_) return;
    revision_ = session.revision();
    if (live_) std::cout << "\r\x1b[K";
    PrintSession(session, std::cout);
  }

  bool json_, live_;
  std::int64_t revision_ = -1;
  std::string residual_;  // about a second old at most
};

}  // namespace

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
  {
    Printer printer(context);
    v1::WatchFramesResponse event;
    while (stream->Read(&event)) {
      printer.Print(event);
      if (event.has_frame() && ++lines == options.count) call.TryCancel();
    }
  }
  const grpc::Status status = stream->Finish();
  const bool enough = lines > 0 && lines == options.count;
  const bool time_is_up = options.seconds > 0 && status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
  return status.ok() || enough || time_is_up ? kOk : Fail(context, status);
}

}  // namespace phrenic::client
