#include "server/service/calls/call_limits.h"

#include <algorithm>

namespace phrenic::service {
namespace {

constexpr char kSetting[] = "--max-calls";
constexpr int kCallersInFull = 4;   // that fill the server with calls in flight
constexpr int kOfUnknown = 16;      // callers without account or link share this fraction of one caller's calls
constexpr int kWaitingOfCalls = 4;  // fraction of a caller's calls that may wait for a thread of one lane
constexpr int kUnread = 24;         // requests that are being read; of one caller:
constexpr int kUnreadOfCaller = 4;
constexpr int kConversations = 64, kConversationsOfCaller = 16;
constexpr int kRequests = 128, kRequestsOfCaller = 32;  // places of large requests
constexpr int kPlacesOfLargest = 4;
constexpr std::size_t kLargeRequest = 64 << 10;       // [bytes]
constexpr int kReplies = 128, kRepliesOfCaller = 64;  // that are large, and unread

struct Threads {
  const char* calls;
  int in_all, of_caller;
};
constexpr Threads kThreads[] = {{"short calls", 8, 4},
                                {"calls to sessions", 64, 16},
                                {"long calls", 8, 4},
                                {"downloads", 32, 8},
                                {"watches", 64, 16}};

FairShare::Limits LaneLimits(Lane lane, int max_calls) {
  const Threads& threads = kThreads[static_cast<std::size_t>(lane)];
  const int waiting = lane == Lane::kWatch ? 0 : std::max(1, max_calls / kWaitingOfCalls);
  return {threads.calls, kSetting, threads.in_all, threads.of_caller, waiting};
}

std::size_t AllThreads() {
  std::size_t sum = 0;
  for (const Threads& threads : kThreads) sum += static_cast<std::size_t>(threads.in_all);
  return sum;
}

}  // namespace

CallLimits::CallLimits(int max_calls, std::chrono::milliseconds request_time, std::size_t max_message)
    : request_time_(request_time),
      bytes_of_place_(std::max<std::size_t>(kLargeRequest, max_message / kPlacesOfLargest)),
      in_flight_({"calls in flight", kSetting, kCallersInFull * max_calls, max_calls}),
      unknown_({"calls in flight without an account", kSetting, std::max(1, max_calls / kOfUnknown) * kCallersInFull,
                std::max(1, max_calls / kOfUnknown)}),
      unread_({"requests that are being read", kSetting, kUnread, kUnreadOfCaller, max_calls}),
      conversations_({"conversations", kSetting, kConversations, kConversationsOfCaller}),
      requests_({"large requests that are not answered", "--max-message-mb", kRequests, kRequestsOfCaller}),
      replies_({"large replies that are not read", kSetting, kReplies, kRepliesOfCaller}),
      lanes_{FairShare(LaneLimits(Lane::kQuick, max_calls)), FairShare(LaneLimits(Lane::kSession, max_calls)),
             FairShare(LaneLimits(Lane::kWork, max_calls)), FairShare(LaneLimits(Lane::kStream, max_calls)),
             FairShare(LaneLimits(Lane::kWatch, max_calls))},
      threads_(AllThreads()) {}

std::size_t CallLimits::PlacesOf(std::size_t request) const {
  return request <= kLargeRequest ? 0 : (request + bytes_of_place_ - 1) / bytes_of_place_;
}

}  // namespace phrenic::service
