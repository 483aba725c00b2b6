// Serves one viewer: writes what is in its mailbox, one message at a time, and never waits.
#ifndef PHRENIC_SERVER_SERVICE_WATCH_REACTOR_H_
#define PHRENIC_SERVER_SERVICE_WATCH_REACTOR_H_

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <functional>
#include <memory>
#include <optional>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/session/session.h"
#include "server/stream/viewer.h"

namespace phrenic::service {

// gRPC's threads and the publisher's call. Lives until gRPC is done with it and nobody is about to wake it.
class WatchReactor final : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                           public std::enable_shared_from_this<WatchReactor> {
 public:
  static std::shared_ptr<WatchReactor> Make();

  // What a viewer is besides: held until they go.
  struct Subscription {
    std::shared_ptr<void> place;                  // among the viewers of all sessions
    std::function<bool()> may_see;                // asked before each message; null: for ever
    std::function<void(std::size_t bytes)> sent;  // hears of each message
  };

  // Either is called once, before gRPC gets the reactor.
  void Watch(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options, Subscription seat);
  void Refuse(const absl::Status& status);

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  // What is to be done now: at most one of the two.
  struct Next {
    stream::Bytes write = nullptr;
    std::optional<grpc::Status> finish = std::nullopt;
  };

  WatchReactor() = default;
  Next TakeNext() ABSL_LOCKS_EXCLUDED(mutex_);
  // Starts the next write, or finishes, unless a write is under way.
  void Pump() ABSL_LOCKS_EXCLUDED(mutex_);

  absl::Mutex mutex_;
  std::shared_ptr<WatchReactor> self_ ABSL_GUARDED_BY(mutex_);  // gRPC's hold on it
  std::shared_ptr<session::Session> session_ ABSL_GUARDED_BY(mutex_);
  std::shared_ptr<stream::Viewer> viewer_ ABSL_GUARDED_BY(mutex_);
  Subscription subscription_;  // set before the viewer is
  bool writing_ ABSL_GUARDED_BY(mutex_) = false;
  bool cancelled_ ABSL_GUARDED_BY(mutex_) = false;
  bool finished_ ABSL_GUARDED_BY(mutex_) = false;
  grpc::ByteBuffer buffer_;  // of whoever set writing_, until the write is done
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WATCH_REACTOR_H_
