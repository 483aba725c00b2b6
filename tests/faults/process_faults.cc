#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "grpcpp/create_channel.h"
#include "tests/faults/faults.h"

namespace phrenic::faults {
namespace {

constexpr char kClockLibrary[] = "/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1";

// Returns the size of a process' address space [bytes].
rlim_t SizeOf(pid_t pid) {
  std::ifstream file(absl::StrCat("/proc/", pid, "/statm"));
  rlim_t pages = 0;
  file >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

// Creates sessions of the thorax until one is refused or the server does not answer.
void ExhaustMemory(const std::string& address) {
  const auto stub = v1::SessionService::NewStub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  for (int i = 0; i < 8; ++i) {
    v1::CreateSessionRequest request;
    request.mutable_source()->set_name("thorax");
    v1::CreateSessionResponse created;
    grpc::ClientContext call;
    call.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
    if (!stub->CreateSession(&call, request, &created).ok()) return;
  }
}

}  // namespace

Tally Killed(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  for (int i = 0; i < times; ++i) {
    rig.Disturb([&] { rig.server().Kill(); });
    rig.Recover(tally);
  }
  return tally;
}

// The server must exit by itself within 15 s with code 0.
Tally Ended(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  for (int i = 0; i < times; ++i) {
    int code = -1;
    rig.Disturb([&] { code = rig.server().Stop(15); });
    if (code != 0) {
      std::fprintf(stderr, "exit code %d after SIGTERM\n", code);
      ++tally.lost;
    }
    rig.Recover(tally);
  }
  return tally;
}

Tally Frozen(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  for (int i = 0; i < times; ++i) {
    rig.Disturb([&] {
      rig.server().Signal(SIGSTOP);
      absl::SleepFor(absl::Seconds(rig.Wait(0.5)));
      rig.server().Signal(SIGCONT);
    });
    rig.Recover(tally);
  }
  return tally;
}

// libfaketime changes the wall clock but not the monotonic clock.
Tally ClockJumps(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  if (!std::filesystem::exists(kClockLibrary)) {
    tally.skipped = "install libfaketime";
    return tally;
  }
  const std::string clock = folder + ".clock";
  const auto jump = [&clock](double seconds) { std::ofstream(clock) << absl::StrCat(seconds < 0 ? "" : "+", seconds); };
  jump(0);
  {
    Rig rig(oracle, folder,
            {absl::StrCat("LD_PRELOAD=", kClockLibrary), absl::StrCat("FAKETIME_TIMESTAMP_FILE=", clock),
             "FAKETIME_NO_CACHE=1", "FAKETIME_DONT_FAKE_MONOTONIC=1"});
    for (int i = 0; i < times; ++i) {
      rig.Disturb([&] { jump(std::round(rig.Wait(6.3e7) - 3.15e7)); });
      rig.Recover(tally);
    }
  }
  std::filesystem::remove(clock);
  return tally;
}

// No session may be lost if an allocation fails or the kernel ends the server.
Tally OutOfMemory(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  for (int i = 0; i < times; ++i) {
    rig.Disturb([&] {
      const rlim_t most = SizeOf(rig.server().pid()) + (rlim_t{20} << 20);
      const rlimit limit = {most, RLIM_INFINITY}, none = {RLIM_INFINITY, RLIM_INFINITY};
      prlimit(rig.server().pid(), RLIMIT_AS, &limit, nullptr);
      ExhaustMemory(rig.server().address());
      prlimit(rig.server().pid(), RLIMIT_AS, &none, nullptr);
    });
    rig.Recover(tally);
  }
  return tally;
}

}  // namespace phrenic::faults
