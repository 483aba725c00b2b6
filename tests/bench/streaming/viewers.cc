#include "tests/bench/streaming/viewers.h"

#include <grpcpp/create_channel.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/notification.h"
#include "phrenic/v1/frames.grpc.pb.h"

namespace phrenic::bench {
namespace {

class GrpcViewer final : public grpc::ClientReadReactor<v1::WatchFramesResponse> {
 public:
  GrpcViewer(const std::string& address, const Wanted& wanted, int number, Seen& seen, std::function<void()> first)
      : wanted_(wanted), seen_(seen), first_(std::move(first)), request_(RequestOf(wanted, number)) {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);  // a connection of its own
    stub_ =
        v1::FrameService::NewStub(grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments));
    acknowledged_.set_session_id(request_.session_id());
    acknowledged_.set_watch_id(request_.watch_id());
    stub_->async()->WatchFrames(&context_, &request_, this);
    if (wanted.reads) StartRead(&event_);
    StartCall();
  }

  ~GrpcViewer() override {
    context_.TryCancel();
    if (!wanted_.reads) StartRead(&event_);
    done_.WaitForNotification();
    absl::MutexLock lock(&mutex_);
    mutex_.Await(absl::Condition(this, &GrpcViewer::Quiet));
  }

  void OnReadDone(bool ok) override {
    if (!ok) return;
    if (event_.has_frame()) {
      seen_.Add(event_.frame(), static_cast<std::int64_t>(event_.ByteSizeLong()), last_);
      if (last_ == 0) first_();
      last_ = event_.frame().sequence();
      if (wanted_.window > 0) Acknowledge(last_);
    }
    StartRead(&event_);
  }

  void OnDone(const grpc::Status& /*status*/) override { done_.Notify(); }

 private:
  bool Quiet() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return !asking_; }

  // As the viewer in the browser: the newest alone, one call at a time, for half of those that may be on their way.
  void Acknowledge(std::int64_t sequence) {
    {
      absl::MutexLock lock(&mutex_);
      newest_ = sequence;
      if (++taken_ < enough_ || asking_) return;
      asking_ = true;
      taken_ = 0;
    }
    Tell(sequence);
  }

  void Tell(std::int64_t sequence) {
    acknowledged_.set_sequence(sequence);
    call_ = std::make_unique<grpc::ClientContext>();
    stub_->async()->AckFrames(call_.get(), &acknowledged_, &answer_,
                              [this, sequence](const grpc::Status& status) { Told(sequence, status.ok()); });
  }

  void Told(std::int64_t sequence, bool ok) {
    acknowledged_.set_basis_epoch(answer_.basis_epoch());  // as one who has fetched it: nothing is decoded here
    std::int64_t newest = 0;
    {
      absl::MutexLock lock(&mutex_);
      newest = newest_;
      enough_ = std::max(1, answer_.max_unacked_frames() / 2);
      asking_ = ok && taken_ >= enough_ && newest > sequence;
      if (!asking_) return;
      taken_ = 0;
    }
    Tell(newest);
  }

  const Wanted wanted_;
  Seen& seen_;
  const std::function<void()> first_;
  const v1::WatchFramesRequest request_;
  std::unique_ptr<v1::FrameService::Stub> stub_;
  grpc::ClientContext context_;
  v1::WatchFramesResponse event_;
  std::int64_t last_ = 0;
  absl::Notification done_;
  absl::Mutex mutex_;
  bool asking_ ABSL_GUARDED_BY(mutex_) = false;
  std::int64_t newest_ ABSL_GUARDED_BY(mutex_) = 0;
  int taken_ ABSL_GUARDED_BY(mutex_) = 0;   // since the last acknowledgement
  int enough_ ABSL_GUARDED_BY(mutex_) = 1;  // for another
  // Of the acknowledgement under way.
  std::unique_ptr<grpc::ClientContext> call_;
  v1::AckFramesRequest acknowledged_;
  v1::AckFramesResponse answer_;
};

class GrpcViewers final : public Viewers {
 public:
  GrpcViewers(const std::string& address, const Wanted& wanted) : Viewers(wanted.reads ? wanted.viewers : 0) {
    for (int i = 0; i < wanted.viewers; ++i) {
      viewers_.push_back(std::make_unique<GrpcViewer>(address, wanted, i, seen(), [this] { FirstCame(); }));
    }
  }

 private:
  std::vector<std::unique_ptr<GrpcViewer>> viewers_;
};

}  // namespace

v1::WatchFramesRequest RequestOf(const Wanted& wanted, int number) {
  static int groups = 0;
  if (number == 0) ++groups;
  v1::WatchFramesRequest request;
  request.set_session_id(kSession);
  request.set_codec(wanted.codec);
  request.set_max_fps(wanted.max_fps);
  if (wanted.bound_mm > 0) request.set_max_error_mm(wanted.bound_mm);
  request.set_watch_id(absl::StrCat("bench-", groups, "-", number));
  request.set_max_unacked_frames(wanted.window);
  return request;
}

void Viewers::FirstCame() {
  absl::MutexLock lock(&mutex_);
  --missing_;
}

bool Viewers::WaitForAll(absl::Duration longest) {
  absl::MutexLock lock(&mutex_);
  const auto none = [](int* missing) { return *missing == 0; };
  return mutex_.AwaitWithTimeout(absl::Condition(+none, &missing_), longest);
}

std::unique_ptr<Viewers> WatchOverGrpc(const std::string& address, const Wanted& wanted) {
  return std::make_unique<GrpcViewers>(address, wanted);
}

}  // namespace phrenic::bench
