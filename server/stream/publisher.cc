#include "server/stream/publisher.h"

#include <pthread.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"

namespace phrenic::stream {
namespace {

// A frame may be sent this much early, so that a viewer that requests 60 a second gets 60.
constexpr absl::Duration kEarly = absl::Milliseconds(2);

}  // namespace

Publisher::Publisher(std::shared_ptr<const Model> model, const Clock& clock, int max_viewers)
    : model_(std::move(model)), layout_(*model_), clock_(clock), max_viewers_(max_viewers), encoder_(model_, layout_) {}

Publisher::~Publisher() {
  Close(absl::UnavailableError("the session has ended"));
  std::thread thread;
  {
    absl::MutexLock lock(&mutex_);
    thread = std::move(thread_);
  }
  if (thread.joinable()) thread.join();
}

void Publisher::Offer(std::shared_ptr<const Snapshot> snapshot) {
  absl::MutexLock lock(&mutex_);
  newest_ = std::move(snapshot);
  has_work_ = true;
}

void Publisher::Announce(const v1::Session& session) {
  absl::MutexLock lock(&mutex_);
  session_ = session;
  SessionChanged();
}

void Publisher::ShowCamera(Bytes camera) {
  absl::MutexLock lock(&mutex_);
  camera_ = std::move(camera);
  camera_moved_ = camera_ != nullptr;
  has_work_ = true;
}

void Publisher::SessionChanged() {
  session_.set_viewers(static_cast<int>(subscriptions_.size()));
  if (subscriptions_.empty()) return;  // a new viewer gets the newest
  if (!updates_.empty() && updates_.back().revision() == session_.revision()) updates_.pop_back();
  updates_.push_back(session_);
  has_work_ = true;
}

absl::StatusOr<std::shared_ptr<Viewer>> Publisher::Join(const ViewerOptions& options, std::function<void()> wake) {
  absl::MutexLock lock(&mutex_);
  if (closed_.has_value()) return *closed_;
  if (static_cast<int>(subscriptions_.size()) >= max_viewers_) {
    return absl::ResourceExhaustedError(
        absl::StrCat("the session has ", subscriptions_.size(),
                     " viewers, and no more are allowed (--max-viewers); try again later"));
  }
  if (named_.count(options.watch_id) > 0) {
    return absl::AlreadyExistsError(absl::StrCat("watch_id: another viewer watches as ", options.watch_id));
  }
  auto viewer = std::make_shared<Viewer>(options, std::move(wake));
  if (!options.watch_id.empty()) named_[options.watch_id] = viewer;
  subscriptions_.emplace_back().viewer = viewer;
  if (!thread_.joinable()) thread_ = std::thread([this] { Run(); });
  SessionChanged();
  return viewer;
}

void Publisher::Leave(const std::shared_ptr<Viewer>& viewer) {
  absl::MutexLock lock(&mutex_);
  const auto left =
      std::erase_if(subscriptions_, [&](const Subscription& subscription) { return subscription.viewer == viewer; });
  if (left == 0) return;
  named_.erase(viewer->options().watch_id);
  SessionChanged();
}

void Publisher::Close(const absl::Status& reason) {
  std::vector<std::shared_ptr<Viewer>> viewers;
  {
    absl::MutexLock lock(&mutex_);
    if (closed_.has_value()) return;
    closed_ = reason;
    for (const Subscription& subscription : subscriptions_) viewers.push_back(subscription.viewer);
  }
  for (const auto& viewer : viewers) viewer->End(reason);
}

absl::StatusOr<v1::AckFramesResponse> Publisher::Acknowledge(const v1::AckFramesRequest& request) {
  std::shared_ptr<Viewer> viewer;
  std::int64_t epoch = 0;
  {
    absl::MutexLock lock(&mutex_);
    const auto found = named_.find(request.watch_id());
    if (found == named_.end()) {
      return absl::NotFoundError(absl::StrCat("watch_id: no viewer watches as ", request.watch_id()));
    }
    viewer = found->second;
    if (viewer->options().encoding.codec == v1::CODEC_BASIS && basis_ != nullptr) epoch = basis_->epoch;
  }
  v1::AckFramesResponse response = viewer->Acknowledge(request.sequence(), request.basis_epoch(), clock_.Now());
  response.set_basis_epoch(epoch);
  if (!viewer->deferred()) return response;
  absl::MutexLock lock(&mutex_);
  has_work_ = true;
  return response;
}

std::shared_ptr<const Basis> Publisher::basis() const {
  absl::MutexLock lock(&mutex_);
  return basis_;
}

int Publisher::viewers() const {
  absl::MutexLock lock(&mutex_);
  return static_cast<int>(subscriptions_.size());
}

std::int64_t Publisher::encodings() const {
  absl::MutexLock lock(&mutex_);
  return encodings_;
}

absl::Time Publisher::NextDue() const {
  absl::Time next = absl::InfiniteFuture();
  if (newest_ == nullptr) return next;
  for (const Subscription& subscription : subscriptions_) {
    if (std::max(subscription.sequence, subscription.passed) < newest_->sequence)
      next = std::min(next, subscription.due);
  }
  return next;
}

Publisher::Round Publisher::TakeRound(absl::Time now) {
  Round round;
  round.snapshot = newest_;
  round.updates.swap(updates_);
  round.camera = camera_;
  round.camera_moved = std::exchange(camera_moved_, false);
  const bool newcomers = std::any_of(subscriptions_.begin(), subscriptions_.end(),
                                     [](const Subscription& subscription) { return !subscription.greeted; });
  if (newcomers && round.updates.empty()) round.updates.push_back(session_);
  for (Subscription& subscription : subscriptions_) {
    (subscription.greeted ? round.greeted : round.newcomers).push_back(subscription.viewer);
    subscription.greeted = true;
  }
  if (newest_ != nullptr) TakeFrames(now, round);
  return round;
}

void Publisher::TakeFrames(absl::Time now, Round& round) {
  const std::int64_t sequence = newest_->sequence;
  std::map<FrameEncoding, std::vector<Subscription*>> wanted;
  for (Subscription& subscription : subscriptions_) {
    if (subscription.sequence < sequence && now >= subscription.due)
      wanted[subscription.viewer->encoding()].push_back(&subscription);
  }
  for (const auto& [encoding, subscriptions] : wanted) {
    const bool taken = std::any_of(
        subscriptions.begin(), subscriptions.end(),
        [sequence, now](const Subscription* subscription) { return !subscription->viewer->Defer(sequence, now); });
    for (Subscription* subscription : subscriptions) {
      subscription->passed = sequence;
      if (!taken) continue;
      subscription->sequence = sequence;
      const double max_fps = subscription->viewer->options().max_fps;
      if (max_fps > 0) subscription->due = now + absl::Seconds(1 / max_fps) - kEarly;
      round.frames[encoding].push_back(subscription->viewer);
    }
  }
}

void Publisher::Deliver(const Round& round) {
  for (std::size_t i = 0; i < round.updates.size(); ++i) {
    const StatusUpdate updates = EncodeSession(round.updates[i]);
    for (const auto& viewer : round.greeted) viewer->PutSession(updates);
    if (i + 1 < round.updates.size()) continue;
    for (const auto& viewer : round.newcomers) viewer->PutSession(updates);
  }
  DeliverCamera(round);
  DeliverFrames(round);
}

void Publisher::DeliverCamera(const Round& round) {
  if (round.camera == nullptr) return;
  for (const auto& viewer : round.newcomers) viewer->PutCamera(round.camera);
  if (!round.camera_moved) return;
  for (const auto& viewer : round.greeted) viewer->PutCamera(round.camera);
}

void Publisher::DeliverFrames(const Round& round) {
  for (const auto& [encoding, viewers] : round.frames) {
    const Bytes bytes = encoder_.Encode(*round.snapshot, encoding);
    {
      absl::MutexLock lock(&mutex_);
      encodings_ = encoder_.encodings();
      basis_ = encoder_.basis();
    }
    if (bytes == nullptr) continue;
    const absl::Time now = clock_.Now();
    for (const auto& viewer : viewers) viewer->PutFrame(round.snapshot->sequence, bytes, now);
  }
}

void Publisher::Run() {
  pthread_setname_np(pthread_self(), "publishing");
  for (;;) {
    Round round;
    {
      absl::MutexLock lock(&mutex_);
      clock_.Await(mutex_, absl::Condition(this, &Publisher::HasWork), NextDue());
      if (closed_.has_value()) return;
      has_work_ = false;
      round = TakeRound(clock_.Now());
    }
    Deliver(round);
  }
}

}  // namespace phrenic::stream
