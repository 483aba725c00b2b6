#include "server/stream/publisher.h"

#include <pthread.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"

namespace phrenic::stream {
namespace {

// A frame may come this much before its time, so that a viewer that asks for 60 a second gets 60.
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
  stirred_ = true;
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
  stirred_ = true;
}

void Publisher::SessionChanged() {
  session_.set_viewers(static_cast<int>(seats_.size()));
  if (seats_.empty()) return;  // who comes is told the newest
  if (!news_.empty() && news_.back().revision() == session_.revision()) news_.pop_back();
  news_.push_back(session_);
  stirred_ = true;
}

absl::StatusOr<std::shared_ptr<Viewer>> Publisher::Join(const ViewerOptions& options, std::function<void()> wake) {
  absl::MutexLock lock(&mutex_);
  if (closed_.has_value()) return *closed_;
  if (static_cast<int>(seats_.size()) >= max_viewers_) {
    return absl::ResourceExhaustedError(absl::StrCat(
        "the session has ", seats_.size(), " viewers, and no more are allowed (--max-viewers); try again later"));
  }
  if (named_.count(options.watch_id) > 0) {
    return absl::AlreadyExistsError(absl::StrCat("watch_id: somebody watches as ", options.watch_id));
  }
  auto viewer = std::make_shared<Viewer>(options, std::move(wake));
  if (!options.watch_id.empty()) named_[options.watch_id] = viewer;
  seats_.emplace_back().viewer = viewer;
  if (!thread_.joinable()) thread_ = std::thread([this] { Run(); });
  SessionChanged();
  return viewer;
}

void Publisher::Leave(const std::shared_ptr<Viewer>& viewer) {
  absl::MutexLock lock(&mutex_);
  const auto left = std::erase_if(seats_, [&](const Seat& seat) { return seat.viewer == viewer; });
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
    for (const Seat& seat : seats_) viewers.push_back(seat.viewer);
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
      return absl::NotFoundError(absl::StrCat("watch_id: nobody watches as ", request.watch_id()));
    }
    viewer = found->second;
    if (viewer->options().form.codec == v1::CODEC_BASIS && basis_ != nullptr) epoch = basis_->epoch;
  }
  v1::AckFramesResponse response = viewer->Acknowledge(request.sequence(), request.basis_epoch(), clock_.Now());
  response.set_basis_epoch(epoch);
  if (!viewer->passed_over()) return response;
  absl::MutexLock lock(&mutex_);
  stirred_ = true;
  return response;
}

std::shared_ptr<const Basis> Publisher::basis() const {
  absl::MutexLock lock(&mutex_);
  return basis_;
}

int Publisher::viewers() const {
  absl::MutexLock lock(&mutex_);
  return static_cast<int>(seats_.size());
}

std::int64_t Publisher::encodings() const {
  absl::MutexLock lock(&mutex_);
  return encodings_;
}

absl::Time Publisher::NextDue() const {
  absl::Time next = absl::InfiniteFuture();
  if (newest_ == nullptr) return next;
  for (const Seat& seat : seats_) {
    if (std::max(seat.sequence, seat.passed) < newest_->sequence) next = std::min(next, seat.due);
  }
  return next;
}

Publisher::Round Publisher::TakeRound(absl::Time now) {
  Round round;
  round.snapshot = newest_;
  round.news.swap(news_);
  round.camera = camera_;
  round.camera_moved = std::exchange(camera_moved_, false);
  const bool newcomers = std::any_of(seats_.begin(), seats_.end(), [](const Seat& seat) { return !seat.greeted; });
  if (newcomers && round.news.empty()) round.news.push_back(session_);
  for (Seat& seat : seats_) {
    (seat.greeted ? round.greeted : round.newcomers).push_back(seat.viewer);
    seat.greeted = true;
  }
  if (newest_ != nullptr) TakeFrames(now, round);
  return round;
}

void Publisher::TakeFrames(absl::Time now, Round& round) {
  const std::int64_t sequence = newest_->sequence;
  std::map<Form, std::vector<Seat*>> wanted;
  for (Seat& seat : seats_) {
    if (seat.sequence < sequence && now >= seat.due) wanted[seat.viewer->form()].push_back(&seat);
  }
  for (const auto& [form, seats] : wanted) {
    const bool taken = std::any_of(seats.begin(), seats.end(), [sequence, now](const Seat* seat) {
      return !seat->viewer->PassOver(sequence, now);
    });
    for (Seat* seat : seats) {
      seat->passed = sequence;
      if (!taken) continue;
      seat->sequence = sequence;
      const double max_fps = seat->viewer->options().max_fps;
      if (max_fps > 0) seat->due = now + absl::Seconds(1 / max_fps) - kEarly;
      round.frames[form].push_back(seat->viewer);
    }
  }
}

void Publisher::Deliver(const Round& round) {
  for (std::size_t i = 0; i < round.news.size(); ++i) {
    const News news = EncodeSession(round.news[i]);
    for (const auto& viewer : round.greeted) viewer->PutSession(news);
    if (i + 1 < round.news.size()) continue;
    for (const auto& viewer : round.newcomers) viewer->PutSession(news);
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
  for (const auto& [form, viewers] : round.frames) {
    const Bytes bytes = encoder_.Encode(*round.snapshot, form);
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
      clock_.Await(mutex_, absl::Condition(this, &Publisher::Stirred), NextDue());
      if (closed_.has_value()) return;
      stirred_ = false;
      round = TakeRound(clock_.Now());
    }
    Deliver(round);
  }
}

}  // namespace phrenic::stream
