// Attacks by calls that compute: fits, and the tissue of lungs.
#include <grpcpp/client_context.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

#include "absl/strings/str_cat.h"
#include "phrenic/v1/fit.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "phrenic/v1/tissue.grpc.pb.h"
#include "tests/faults/attacks.h"

namespace phrenic::faults {
namespace {

constexpr int kCallers = 8;           // at a time, each on a connection of its own
constexpr double kLongestCall = 20;   // [s]
constexpr double kCoarseThorax = 20;  // [mm]
constexpr char kOwnThorax[] = "greedy-thorax";

using OneCall = std::function<grpc::Status(const std::shared_ptr<grpc::Channel>& channel, int number)>;

// Makes `times` calls, kCallers of them at a time.
Outcome CallTogether(const Victim& victim, int times, const OneCall& call) {
  std::atomic<int> next = 0, served = 0, refused = 0;
  std::vector<std::jthread> callers;
  for (int c = 0; c < kCallers; ++c) {
    callers.emplace_back([&] {
      const auto channel = victim.NewChannel();
      for (int i = next++; i < times && victim.Continues(); i = next++) {
        ++(call(channel, i).ok() ? served : refused);
      }
    });
  }
  callers.clear();
  Outcome outcome;
  outcome.served = served, outcome.refused = refused;
  outcome.tried = served + refused;
  return outcome;
}

// Reads a stream to its end.
template <typename Response, typename Reader>
grpc::Status ReadAll(Reader& reader) {
  Response response;
  while (reader->Read(&response)) continue;
  return reader->Finish();
}

// As many landmarks as a request may have, all over the lungs.
v1::FitMotionRequest LargestFit() {
  constexpr int kPairs = 20'000;
  std::string text = "exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z\n";
  for (int i = 0; i < kPairs; ++i) {
    const auto spread = [i](double step, double width) { return width * (std::fmod(step * i, 1.0) - 0.5); };
    const double x = (i % 2 == 0 ? -65 : 65) + spread(0.618, 50), y = spread(0.7548, 120), z = spread(0.5698, 200);
    absl::StrAppend(&text, x, ",", y, ",", z, ",", x, ",", y - 2, ",", z - 0.075 * (100 - z), "\n");
  }
  v1::FitMotionRequest request;
  request.mutable_source()->set_name("thorax");
  request.mutable_source()->set_resolution_mm(kCoarseThorax);
  v1::LandmarkFile& file = *request.add_landmarks();
  file.set_name("pairs.csv");
  file.set_content(text);
  request.set_modes(12);
  request.set_assimilate(true);
  return request;
}

grpc::Status CreateThorax(const Victim& victim) {
  v1::CreateSessionRequest request;
  request.set_session_id(kOwnThorax);
  request.mutable_source()->set_name("thorax");
  request.mutable_source()->set_resolution_mm(kCoarseThorax);
  v1::CreateSessionResponse response;
  grpc::ClientContext context;
  victim.Sign("greedy", context, 120);
  return v1::SessionService::NewStub(victim.NewChannel())->CreateSession(&context, request, &response);
}

grpc::Status GetTissue(const Victim& victim, v1::TissueService::Stub& stub, const std::string& session) {
  v1::GetTissueRequest request;
  request.set_session_id(session);
  grpc::ClientContext context;
  victim.Sign("greedy", context, kLongestCall);
  const auto reader = stub.GetTissue(&context, request);
  return ReadAll<v1::GetTissueResponse>(reader);
}

grpc::Status ReadTissue(const Victim& victim, v1::TissueService::Stub& stub, const std::string& session, int points) {
  v1::ReadTissueRequest request;
  request.set_session_id(session);
  for (int i = 0; i < points; ++i) request.add_points()->set_x(i % 2 == 0 ? std::nan("") : 1e300);
  v1::ReadTissueResponse response;
  grpc::ClientContext context;
  victim.Sign("greedy", context, kLongestCall);
  return stub.ReadTissue(&context, request, &response);
}

}  // namespace

Outcome Fits(const Victim& victim, int times) {
  const v1::FitMotionRequest request = LargestFit();
  return CallTogether(victim, times, [&](const std::shared_ptr<grpc::Channel>& channel, int /*number*/) {
    const auto stub = v1::FitService::NewStub(channel);
    grpc::ClientContext context;
    victim.Sign("greedy", context, kLongestCall);
    const auto reader = stub->FitMotion(&context, request);
    return ReadAll<v1::FitMotionResponse>(reader);
  });
}

// Shapes and points of one's own session and of another account's, which must stay unknown.
Outcome Tissue(const Victim& victim, int times) {
  const grpc::Status own = CreateThorax(victim);
  std::atomic<int> seen = 0;
  Outcome outcome = CallTogether(victim, times, [&](const std::shared_ptr<grpc::Channel>& channel, int number) {
    const auto stub = v1::TissueService::NewStub(channel);
    const std::string session = number % 2 == 0 ? kOwnThorax : Victim::kWatched;
    const int points = number % 4 < 2 ? 64 : 100'000;
    const grpc::Status status =
        number % 8 < 4 ? GetTissue(victim, *stub, session) : ReadTissue(victim, *stub, session, points);
    if (session == Victim::kWatched && status.error_code() != grpc::StatusCode::NOT_FOUND) ++seen;
    return status;
  });
  if (!own.ok()) outcome.broken.push_back(absl::StrCat("an account gets no thorax: ", own.error_message()));
  if (seen > 0)
    outcome.broken.push_back(absl::StrCat("another account's lungs were not unknown ", seen.load(), " times"));
  return outcome;
}

}  // namespace phrenic::faults
