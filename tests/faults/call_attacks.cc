// Attacks by well-formed calls: too many, too large, never read.
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/async_stream.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/time/clock.h"
#include "phrenic/v1/export.grpc.pb.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "tests/faults/attacks.h"

namespace phrenic::faults {
namespace {

// Opens `times` streams of a call on one connection and holds them. A stream that ends counts as refused.
Outcome HoldCalls(const Victim& victim, int times, const std::string& path, const std::string& account,
                  const google::protobuf::Message* request, double seconds) {
  Http2 connection(victim.port());
  for (int i = 0; i < times && connection.open() && victim.Continues(); ++i) {
    const Headers more = victim.As(account);
    if (request == nullptr) connection.Open(CallHeaders(path, more));
    if (request != nullptr) connection.Call(path, more, request->SerializeAsString());
    connection.Read(0);
  }
  const absl::Time until = absl::Now() + absl::Seconds(seconds);
  while (connection.open() && victim.Continues() && absl::Now() < until) connection.Read(0.05);
  Outcome outcome;
  outcome.tried = times;
  outcome.refused = connection.open() ? std::min(times, connection.ended()) : times;
  outcome.served = times - outcome.refused;
  return outcome;
}

void CountCall(const grpc::Status& status, Outcome& outcome) {
  ++outcome.tried;
  ++(status.ok() ? outcome.served : outcome.refused);
}

// A scene whose text is short and whose model is not.
v1::SceneSource Bomb(int kind) {
  v1::SceneSource source;
  v1::Scene& scene = *source.mutable_scene();
  scene.set_name("bomb");
  v1::Body& body = *scene.add_bodies();
  body.set_name("block");
  v1::Block& block = *body.mutable_block();
  block.mutable_size()->set_x(1), block.mutable_size()->set_y(1), block.mutable_size()->set_z(1);
  if (kind % 2 == 0) {
    block.set_columns(500), block.set_rows(500), block.set_layers(500);
  } else {
    for (int i = 0; i < 100'000; ++i) scene.add_layers()->set_name(absl::StrCat("l", i));
  }
  return source;
}

grpc::Status CreateStudy(const Victim& victim, v1::StudyService::Stub& stub, const std::string& account,
                         const std::string& id) {
  v1::CreateStudyRequest request;
  request.set_study_id(id);
  request.mutable_source()->set_name("cube-springs");
  request.mutable_cost()->set_steps(1'000'000);
  v1::CreateStudyResponse response;
  grpc::ClientContext context;
  victim.Sign(account, context, 20);
  return stub.CreateStudy(&context, request, &response);
}

grpc::Status CreateExport(const Victim& victim, v1::ExportService::Stub& stub, const std::string& account,
                          const std::string& session) {
  v1::CreateExportRequest request;
  request.set_session_id(session);
  request.set_format("csv");
  request.set_seconds(3600);
  v1::CreateExportResponse response;
  grpc::ClientContext context;
  victim.Sign(account, context, 20);
  return stub.CreateExport(&context, request, &response);
}

// Returns a field of a message or text on the wire.
std::string Field(int number, const std::string& content) {
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream stream(&bytes);
    google::protobuf::io::CodedOutputStream out(&stream);
    out.WriteTag(static_cast<std::uint32_t>(number) << 3 | 2);
    out.WriteVarint64(content.size());
    out.WriteString(content);
  }
  return bytes;
}

// True if a viewer gets a frame.
bool SeesAFrame(const Victim& victim, const std::string& account, const std::string& session) {
  grpc::ClientContext context;
  victim.Sign(account, context, 10);
  const auto stub = v1::FrameService::NewStub(victim.NewChannel());
  v1::WatchFramesRequest request;
  request.set_session_id(session);
  const auto reader = stub->WatchFrames(&context, request);
  v1::WatchFramesResponse response;
  bool seen = false;
  while (!seen && reader->Read(&response)) seen = response.has_frame();
  context.TryCancel();
  reader->Finish();
  return seen;
}

}  // namespace

Outcome Reflection(const Victim& victim, int times) {
  return HoldCalls(victim, times, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", "", nullptr, 5);
}

Outcome Physiology(const Victim& victim, int times) {
  v1::CheckPhysiologyRequest request;
  request.mutable_source()->set_name("thorax");
  return HoldCalls(victim, times, "/phrenic.v1.StudyService/CheckPhysiology", "greedy", &request, 8);
}

Outcome Batches(const Victim& victim, int times) {
  v1::RunBatchRequest request;
  request.mutable_source()->set_name("cube-springs");
  request.set_seconds(3600);
  request.set_frames_per_second(0.001);
  for (int i = 0; i < 1000; ++i) request.add_runs();
  return HoldCalls(victim, times, "/phrenic.v1.StudyService/RunBatch", "greedy", &request, 8);
}

// Scenes of eight million empty bodies: 16 MB on the wire, gigabytes if they were parsed.
Outcome FoldedRequests(const Victim& victim, int times) {
  const std::string request =
      Field(1, Field(2, absl::StrReplaceAll(std::string(8'000'000, 'b'), {{"b", Field(5, "")}})));
  const grpc::Slice slice(request);
  const grpc::ByteBuffer bytes(&slice, 1);
  grpc::GenericStub stub(victim.NewChannel());
  grpc::CompletionQueue queue;
  Outcome outcome;
  for (int i = 0; i < times && victim.Continues(); ++i) {
    grpc::ClientContext context;
    victim.Sign("greedy", context, 20);
    const auto call = stub.PrepareUnaryCall(&context, "/phrenic.v1.SceneService/DescribeScene", bytes, &queue);
    grpc::ByteBuffer answer;
    grpc::Status status;
    void* tag = nullptr;
    bool ok = false;
    call->StartCall();
    call->Finish(&answer, &status, nullptr);
    queue.Next(&tag, &ok);
    CountCall(status, outcome);
  }
  return outcome;
}

// Callers that leave after a second, while another account describes and creates small scenes.
Outcome CompileBombs(const Victim& victim, int times) {
  Outcome outcome;
  std::atomic<int> left = times;
  std::atomic<int> served = 0, refused = 0;
  std::vector<std::thread> attackers;
  for (int a = 0; a < 4; ++a) {
    attackers.emplace_back([&] {
      const auto stub = v1::SceneService::NewStub(victim.NewChannel());
      for (int i = --left; i >= 0 && victim.Continues(); i = --left) {
        v1::DescribeSceneRequest request;
        *request.mutable_source() = Bomb(i);
        v1::DescribeSceneResponse response;
        grpc::ClientContext context;
        victim.Sign("greedy", context, 1);
        ++(stub->DescribeScene(&context, request, &response).ok() ? served : refused);
      }
    });
  }
  absl::SleepFor(absl::Milliseconds(500));
  const absl::Time asked = absl::Now();
  const grpc::Status modest = victim.CreateSession("healthy", "modest");
  if (!modest.ok())
    outcome.broken.push_back(absl::StrCat("another account cannot create a session: ", modest.error_message()));
  outcome.note =
      absl::StrCat("another account's CreateSession took ", absl::ToInt64Milliseconds(absl::Now() - asked), " ms");
  for (std::thread& attacker : attackers) attacker.join();
  outcome.tried = times, outcome.served = served, outcome.refused = refused;
  return outcome;
}

// Windows of 2 GB, and clients that read nothing of what they asked for.
Outcome SlowReaders(const Victim& victim, int times) {
  Outcome outcome;
  std::deque<Http2> held;
  v1::WatchFramesRequest request;
  request.set_session_id(Victim::kWatched);
  const std::string window("\0\4\x7f\xff\xff\xff", 6), more("\x7f\xfe\0\0", 4);
  for (int i = 0; i < times && victim.Continues(); ++i) {
    Http2& connection = held.emplace_back(victim.port());
    connection.Send(absl::StrCat(Frame(FrameType::kSettings, 0, 0, window), Frame(FrameType::kWindow, 0, 0, more)),
                    false);
    connection.Call("/phrenic.v1.FrameService/WatchFrames", victim.As("healthy"), request.SerializeAsString());
    ++outcome.tried;
  }
  absl::SleepFor(absl::Seconds(5));
  for (Http2& connection : held) {
    connection.Read(0);
    ++(connection.open() && connection.ended() == 0 ? outcome.served : outcome.refused);
  }
  return outcome;
}

// One account takes all it gets; another one, which has next to nothing, must still get one of each.
Outcome GreedyAccount(const Victim& victim, int times) {
  const auto channel = victim.NewChannel();
  const auto studies = v1::StudyService::NewStub(channel);
  const auto exports = v1::ExportService::NewStub(channel);
  Outcome outcome;
  for (int i = 0; i < times / 6 && victim.Continues(); ++i) {
    CountCall(victim.CreateSession("greedy", absl::StrCat("greedy-", i)), outcome);
    CountCall(CreateStudy(victim, *studies, "greedy", absl::StrCat("greedy-", i)), outcome);
    CountCall(CreateExport(victim, *exports, "greedy", "greedy-0"), outcome);
  }
  v1::WatchFramesRequest watch;
  watch.set_session_id("greedy-0");
  Http2 viewers(victim.port());
  for (int i = 0; i < times / 2 && viewers.open(); ++i) {
    viewers.Call("/phrenic.v1.FrameService/WatchFrames", victim.As("greedy"), watch.SerializeAsString());
    viewers.Read(0);
  }
  viewers.Read(0.5);
  outcome.tried += times / 2, outcome.refused += viewers.ended();
  outcome.served += times / 2 - viewers.ended();
  const auto must = [&](const grpc::Status& status, const char* what) {
    if (!status.ok())
      outcome.broken.push_back(absl::StrCat("a modest account gets no ", what, ": ", status.error_message()));
  };
  must(victim.CreateSession("thief", "modest"), "session");
  must(CreateStudy(victim, *studies, "thief", "modest"), "study");
  must(CreateExport(victim, *exports, "thief", "modest"), "export");
  if (!SeesAFrame(victim, "thief", "modest")) outcome.broken.emplace_back("a modest account gets no seat");
  return outcome;
}

}  // namespace phrenic::faults
