#include <grpcpp/create_channel.h>

#include <algorithm>
#include <cstdio>

#include "absl/strings/str_cat.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "tests/bench/streaming/gateway_viewers.h"
#include "tests/bench/streaming/parts.h"
#include "tests/bench/streaming/thin_line.h"

namespace phrenic::bench {
namespace {

constexpr double kLine = 4e6 / 8;        // [bytes/s]
constexpr double kAimMedianAge = 0.400;  // [s]
constexpr double kAimFirst = 0.300;      // [s]
constexpr int kJoiners = 5;

bool ThinLineRow(Bench& bench, const char* what, bool gateway, const Wanted& wanted) {
  const ThinLine line(gateway ? bench.server().web_port() : bench.server().port(), kLine);
  const auto viewers =
      gateway ? WatchOverGateway(line.port(), wanted) : WatchOverGrpc(absl::StrCat("127.0.0.1:", line.port()), wanted);
  viewers->WaitForAll(absl::Seconds(30));
  bench.Sleep(bench.settings().seconds);  // until the server has found out what the line takes
  Cost cost;
  const Sight sight = Watch(bench, *viewers, 2 * bench.settings().seconds, &cost);
  const double age = sight.Age(0.5);
  std::printf("4 Mbit/s, %-18s %5.1f fps, age p50 %4.0f ms, p99 %4.0f ms, within %g mm  %s\n", what,
              static_cast<double>(sight.frames) / cost.wall, 1e3 * age, 1e3 * sight.Age(0.99), sight.largest_error,
              Verdict(sight.frames > 0 && age <= kAimMedianAge, "p50 <= 400 ms").c_str());
  return sight.frames > 0;
}

// From nothing to a scene and a frame of it [s].
double FirstPicture(const Bench& bench) {
  const absl::Time start = absl::Now();
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto stub = v1::FrameService::NewStub(
      grpc::CreateCustomChannel(bench.server().address(), grpc::InsecureChannelCredentials(), arguments));
  v1::GetGeometryRequest request;
  request.set_session_id(kSession);
  grpc::ClientContext context, watching;
  const auto bodies = stub->GetGeometry(&context, request);
  v1::GetGeometryResponse body;
  while (bodies->Read(&body)) continue;
  const auto frames = stub->WatchFrames(&watching, RequestOf({.window = 0}, 0));
  v1::WatchFramesResponse event;
  while (frames->Read(&event) && !event.has_frame()) continue;
  const double seconds = absl::ToDoubleSeconds(absl::Now() - start);
  watching.TryCancel();
  frames->Finish();
  return seconds;
}

}  // namespace

bool Lines(Bench& bench) {
  const Wanted viewer{.max_fps = 0}, learned{.codec = v1::CODEC_BASIS, .max_fps = 0};
  std::printf("\n");
  bool complete = ThinLineRow(bench, "predicted, gRPC", false, viewer);
  complete = ThinLineRow(bench, "predicted, web", true, viewer) && complete;
  complete = ThinLineRow(bench, "basis, gRPC", false, learned) && complete;
  const auto others = WatchOverGrpc(bench.server().address(), {.viewers = 20});
  others->WaitForAll(absl::Seconds(30));
  std::vector<double> firsts;
  for (int i = 0; i < kJoiners; ++i) firsts.push_back(FirstPicture(bench));
  std::sort(firsts.begin(), firsts.end());
  std::printf("a late joiner beside 20: scene and first frame after %.0f ms (median of %d, slowest %.0f)  %s\n",
              1e3 * firsts[kJoiners / 2], kJoiners, 1e3 * firsts.back(),
              Verdict(firsts[kJoiners / 2] <= kAimFirst, "<= 300 ms").c_str());
  return complete;
}

}  // namespace phrenic::bench
