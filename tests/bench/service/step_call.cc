// What a step costs beside its own time, as a call of StepSession and as a request of Advance: CPU time of the server
// and of the caller, for one step of a scene whose own step takes a fifth of a microsecond. `service_bench [CALLS]`.
#include <grpcpp/create_channel.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"

namespace phrenic::bench {
namespace {

constexpr double kAim = 150;  // [us] of the server's CPU

// CPU time so far [us], of the process (RUSAGE_SELF) or of the calling thread (RUSAGE_THREAD).
double CpuTime(int whose) {
  rusage usage;
  getrusage(whose, &usage);
  const auto micros = [](const timeval& time) {
    return 1e6 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec);
  };
  return micros(usage.ru_utime) + micros(usage.ru_stime);
}

struct Cost {
  double server = 0, caller = 0, wall = 0;  // [us] a call
};

// Takes a step and waits for its answer; returns why it failed.
using TakeStep = std::function<grpc::Status()>;

grpc::Status Measure(const TakeStep& take_step, int calls, Cost& cost) {
  const double process = CpuTime(RUSAGE_SELF), caller = CpuTime(RUSAGE_THREAD);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < calls; ++i) {
    if (grpc::Status status = take_step(); !status.ok()) return status;
  }
  cost.caller = (CpuTime(RUSAGE_THREAD) - caller) / calls;
  cost.server = (CpuTime(RUSAGE_SELF) - process) / calls - cost.caller;
  cost.wall = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() / calls;
  return grpc::Status::OK;
}

// The median of five by the server's time.
grpc::Status Report(const char* name, const TakeStep& take_step, int calls) {
  Cost warm_up;
  if (grpc::Status status = Measure(take_step, calls, warm_up); !status.ok()) return status;
  std::vector<Cost> costs(5);
  for (Cost& cost : costs) {
    if (grpc::Status status = Measure(take_step, calls, cost); !status.ok()) return status;
  }
  std::sort(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.server < b.server; });
  const Cost& cost = costs[costs.size() / 2];
  std::printf("%-22s %12.0f %12.0f %12.0f   %s\n", name, cost.server, cost.caller, cost.wall,
              cost.server <= kAim ? "within the aim of 150 us" : "over the aim of 150 us");
  return grpc::Status::OK;
}

grpc::Status ReportCalls(const char* name, v1::SessionService::Stub& stub, int calls) {
  v1::StepSessionRequest request;
  request.set_session_id("cube");
  request.set_ticks(1);
  return Report(
      name,
      [&] {
        grpc::ClientContext context;
        v1::StepSessionResponse response;
        return stub.StepSession(&context, request, &response);
      },
      calls);
}

grpc::Status ReportStream(const char* name, v1::SessionService::Stub& stub, int calls) {
  v1::AdvanceRequest request;
  request.set_session_id("cube");
  request.set_ticks(1);
  grpc::ClientContext context;
  const auto stream = stub.Advance(&context);
  const grpc::Status measured = Report(
      name,
      [&] {
        v1::AdvanceResponse response;
        if (stream->Write(request) && stream->Read(&response)) return grpc::Status::OK;
        return stream->Finish();
      },
      calls);
  context.TryCancel();
  return measured;
}

grpc::Status Run(int calls) {
  service::ServerOptions options;
  options.listen = "127.0.0.1:0";
  auto server = service::Server::Start(options);
  if (!server.ok()) return {grpc::StatusCode::UNAVAILABLE, std::string(server.status().message())};
  const auto local = v1::SessionService::NewStub((*server)->InProcessChannel());
  const auto socket = v1::SessionService::NewStub(
      grpc::CreateChannel(absl::StrCat("127.0.0.1:", (*server)->port()), grpc::InsecureChannelCredentials()));
  v1::CreateSessionRequest create;
  create.set_session_id("cube");
  create.mutable_source()->set_name("cube-tensegrity");
  v1::CreateSessionResponse created;
  grpc::ClientContext context;
  if (grpc::Status status = local->CreateSession(&context, create, &created); !status.ok()) return status;
  std::printf("%-22s %12s %12s %12s\n", "one step", "server [us]", "caller [us]", "wall [us]");
  if (grpc::Status status = ReportCalls("call over loopback", *socket, calls); !status.ok()) return status;
  if (grpc::Status status = ReportStream("stream over loopback", *socket, calls); !status.ok()) return status;
  if (grpc::Status status = ReportCalls("call in the process", *local, calls); !status.ok()) return status;
  return ReportStream("stream in the process", *local, calls);
}

}  // namespace
}  // namespace phrenic::bench

int main(int argc, char** argv) {
  const grpc::Status status = phrenic::bench::Run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 2000);
  if (status.ok()) return 0;
  std::fprintf(stderr, "%s\n", status.error_message().c_str());
  return 1;
}
