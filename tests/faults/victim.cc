#include "tests/faults/victim.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/access/token_file.h"
#include "tests/faults/attacks.h"

namespace phrenic::faults {
namespace {

constexpr double kLongestAttack = 180;  // [s]
constexpr double kLongestAnswer = 20;   // waited for after an attack [s]
constexpr double kMemoryReturns = 10;   // waited for after an attack [s]
constexpr double kMostMemory = 6000;    // of the server, to protect the machine [MB]
constexpr double kCoarse = 8;           // edge length of the healthy user's thorax [mm]

double SecondsNow() { return absl::ToDoubleSeconds(absl::Now() - absl::UnixEpoch()); }

void Raise(std::atomic<double>& number, double to) {
  if (to > number) number = to;
}

// Lets the kernel forget the largest resident memory so far.
void ForgetPeak(pid_t pid) { std::ofstream(absl::StrCat("/proc/", pid, "/clear_refs")) << "5"; }

}  // namespace

Victim::Victim(const std::string& folder, std::vector<std::string> flags, bool open) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder + "/spool");
  AddAccounts(folder + "/tokens");
  flags.insert(flags.begin(),
               {"--store", folder + "/store", "--spool", folder + "/spool", "--tokens", folder + "/tokens"});
  server_ = std::make_unique<ServerProcess>(folder + "/log", flags);
  if (absl::Status status = server_->Start(); !status.ok()) {
    problem_ = status.ToString();
  } else if (!StartSession()) {
    problem_ = "the healthy session could not be created";
  }
  if (!ready()) return;
  if (open) guard_ = std::make_unique<Guard>(folder + "/guard", server_->address(), server_->web_address());
  threads_.emplace_back([this] { Watch(); });
  threads_.emplace_back([this] { CallAgainAndAgain(); });
  threads_.emplace_back([this] { GuardMemory(); });
}

Victim::~Victim() {
  ends_ = true;
  {
    absl::MutexLock lock(&mutex_);
    if (watching_ != nullptr) watching_->TryCancel();
  }
  for (std::thread& thread : threads_) thread.join();
}

void Victim::AddAccounts(const std::string& file) {
  for (const char* name : {"healthy", "greedy", "thief"}) {
    const auto token = access::AddToken(file, {name, v1::ACCESS_ROLE_OWNER});
    if (token.ok()) tokens_[name] = *token;
  }
}

Headers Victim::As(const std::string& name) const {
  if (name.empty()) return {};
  return {{"authorization", "Bearer " + tokens_.at(name)}};
}

void Victim::Sign(const std::string& name, grpc::ClientContext& context, double seconds) const {
  for (const auto& [header, value] : As(name)) context.AddMetadata(header, value);
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(static_cast<int>(1e3 * seconds)));
}

bool Victim::StartSession() {
  const auto stub = v1::SessionService::NewStub(NewChannel());
  v1::CreateSessionRequest create;
  create.set_session_id(kWatched);
  create.mutable_source()->set_name("thorax");
  create.mutable_source()->set_resolution_mm(kCoarse);
  v1::CreateSessionResponse created;
  grpc::ClientContext creating, playing;
  Sign("healthy", creating, 120);
  Sign("healthy", playing, 30);
  if (!stub->CreateSession(&creating, create, &created).ok()) return false;
  v1::PlaySessionRequest play;
  play.set_session_id(kWatched);
  v1::PlaySessionResponse played;
  return stub->PlaySession(&playing, play, &played).ok();
}

// A frame that is still missing counts as a gap too (End).
void Victim::Watch() {
  while (!ends_ && alive_) {
    grpc::ClientContext context;
    Sign("healthy", context, 3600);
    {
      absl::MutexLock lock(&mutex_);
      watching_ = &context;
    }
    const auto stub = v1::FrameService::NewStub(NewChannel());
    v1::WatchFramesRequest request;
    request.set_session_id(kWatched);
    const auto reader = stub->WatchFrames(&context, request);
    v1::WatchFramesResponse response;
    while (!ends_ && reader->Read(&response)) {
      if (!response.has_frame()) continue;
      const double now = SecondsNow();
      if (last_frame_ > 0) Raise(gap_, now - last_frame_);
      last_frame_ = now;
    }
    context.TryCancel();
    reader->Finish();
    absl::MutexLock lock(&mutex_);
    watching_ = nullptr;
  }
}

void Victim::CallAgainAndAgain() {
  double asked = SecondsNow();
  while (!ends_ && alive_) {
    const auto stub = v1::SessionService::NewStub(NewChannel());
    grpc::ClientContext context;
    Sign("healthy", context, 2);
    v1::GetSessionRequest request;
    request.set_session_id(kWatched);
    v1::GetSessionResponse response;
    const bool answered = stub->GetSession(&context, request, &response).ok();
    const double now = SecondsNow();
    if (answered) {
      Raise(wait_, now - asked);
      last_answer_ = now;
    }
    absl::SleepFor(absl::Milliseconds(50));
    if (answered) asked = SecondsNow();
  }
}

void Victim::GuardMemory() {
  while (!ends_ && alive_) {
    if (!server_->running()) alive_ = false;
    if (Memory() > kMostMemory) server_->Signal(SIGKILL);
    absl::SleepFor(absl::Milliseconds(10));
  }
}

bool Victim::Continues() const { return alive_ && SecondsNow() - began_ < kLongestAttack; }

void Victim::Begin() {
  const double start = SecondsNow();
  while (alive_ && (last_frame_ == 0 || last_answer_ == 0) && SecondsNow() - start < kLongestAnswer) {
    absl::SleepFor(absl::Milliseconds(20));
  }
  absl::SleepFor(absl::Milliseconds(500));  // the first frames of a session are slower
  before_ = Memory();
  ForgetPeak(server_->pid());
  gap_ = wait_ = 0;
  began_ = SecondsNow();
}

Damage Victim::End() {
  const double ended = SecondsNow();
  while (alive_ && (last_answer_ <= ended || last_frame_ <= ended) && SecondsNow() - ended < kLongestAnswer) {
    absl::SleepFor(absl::Milliseconds(20));
  }
  Damage damage;
  damage.wait = last_answer_ > ended ? wait_.load() : HUGE_VAL;
  damage.gap = last_frame_ > ended ? gap_.load() : HUGE_VAL;
  damage.before = before_;
  damage.peak = 1e-6 * static_cast<double>(server_->PeakMemory());
  while (alive_ && Memory() > before_ + kReturnedMemory && SecondsNow() - ended < kMemoryReturns) {
    absl::SleepFor(absl::Milliseconds(100));
  }
  damage.afterwards = Memory();
  damage.died = !alive_;
  return damage;
}

}  // namespace phrenic::faults
