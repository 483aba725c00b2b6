#include "tests/cluster/scale/viewers.h"

#include <utility>

#include "absl/synchronization/notification.h"
#include "phrenic/v1/frames.grpc.pb.h"

namespace phrenic::cluster {
namespace {

constexpr double kFps = 30;

class Reader final : public Viewer, public grpc::ClientReadReactor<v1::WatchFramesResponse> {
 public:
  Reader(std::shared_ptr<grpc::Channel> channel, const std::string& session, bench::Seen& seen)
      : channel_(std::move(channel)), stub_(v1::FrameService::NewStub(channel_)), seen_(seen) {
    request_.set_session_id(session);
    request_.set_max_fps(kFps);
    context_.AddMetadata("x-session-id", session);
    stub_->async()->WatchFrames(&context_, &request_, this);
    StartRead(&event_);
    StartCall();
  }
  ~Reader() override {
    context_.TryCancel();
    done_.WaitForNotification();
  }

  void OnReadDone(bool ok) override {
    if (!ok) return;
    if (event_.has_frame()) {
      seen_.Add(event_.frame(), static_cast<std::int64_t>(event_.ByteSizeLong()), last_);
      last_ = event_.frame().sequence();
    }
    StartRead(&event_);
  }
  void OnDone(const grpc::Status& /*status*/) override { done_.Notify(); }

 private:
  const std::shared_ptr<grpc::Channel> channel_;
  const std::unique_ptr<v1::FrameService::Stub> stub_;
  bench::Seen& seen_;
  grpc::ClientContext context_;
  v1::WatchFramesRequest request_;
  v1::WatchFramesResponse event_;
  std::int64_t last_ = 0;
  absl::Notification done_;
};

}  // namespace

std::unique_ptr<Viewer> Watch(std::shared_ptr<grpc::Channel> channel, const std::string& session, bench::Seen& seen) {
  return std::make_unique<Reader>(std::move(channel), session, seen);
}

}  // namespace phrenic::cluster
