// What a call of StepSession costs beside the step itself: CPU time of the server and of the caller, for one step of a
// scene whose own step takes a fifth of a microsecond. `service_bench [CALLS]`.
#include <grpcpp/create_channel.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
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

// Takes one step a call, `calls` times over.
grpc::Status Measure(v1::SessionService::Stub& stub, const v1::StepSessionRequest& request, int calls, Cost& cost) {
  const double process = CpuTime(RUSAGE_SELF), caller = CpuTime(RUSAGE_THREAD);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < calls; ++i) {
    grpc::ClientContext context;
    v1::StepSessionResponse response;
    if (grpc::Status status = stub.StepSession(&context, request, &response); !status.ok()) return status;
  }
  cost.caller = (CpuTime(RUSAGE_THREAD) - caller) / calls;
  cost.server = (CpuTime(RUSAGE_SELF) - process) / calls - cost.caller;
  cost.wall = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() / calls;
  return grpc::Status::OK;
}

// The median of five by the server's time.
grpc::Status Report(const char* name, v1::SessionService::Stub& stub, int calls) {
  v1::StepSessionRequest request;
  request.set_session_id("cube");
  request.set_ticks(1);
  Cost warm_up;
  if (grpc::Status status = Measure(stub, request, calls, warm_up); !status.ok()) return status;
  std::vector<Cost> costs(5);
  for (Cost& cost : costs) {
    if (grpc::Status status = Measure(stub, request, calls, cost); !status.ok()) return status;
  }
  std::sort(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.server < b.server; });
  const Cost& cost = costs[costs.size() / 2];
  std::printf("%-22s %12.0f %12.0f %12.0f   %s\n", name, cost.server, cost.caller, cost.wall,
              cost.server <= kAim ? "within the aim of 150 us" : "over the aim of 150 us");
  return grpc::Status::OK;
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
  std::printf("%-22s %12s %12s %12s\n", "a call of one step", "server [us]", "caller [us]", "wall [us]");
  if (grpc::Status status = Report("over loopback", *socket, calls); !status.ok()) return status;
  return Report("in the process", *local, calls);
}

}  // namespace
}  // namespace phrenic::bench

int main(int argc, char** argv) {
  const grpc::Status status = phrenic::bench::Run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 2000);
  if (status.ok()) return 0;
  std::fprintf(stderr, "%s\n", status.error_message().c_str());
  return 1;
}
