#include "server/service/web/web_watch.h"

#include <boost/asio/post.hpp>

#include "server/service/watch/claimed_watch.h"

namespace phrenic::service {

WebWatch::WebWatch(WatchClaims& claims, const boost::asio::any_io_executor& strand, std::function<void()> ready)
    : wake_(std::make_shared<Wake>()) {
  wake_->strand = strand;
  wake_->ready = std::move(ready);
  claim_ = claims.Add([this](std::shared_ptr<ClaimedWatch> watch) { Accept(std::move(watch)); });
}

WebWatch::~WebWatch() {
  claim_.reset();
  if (const auto given = watch()) given->set_ready(nullptr);
}

std::shared_ptr<ClaimedWatch> WebWatch::watch() const {
  absl::MutexLock lock(&mutex_);
  return watch_;
}

void WebWatch::Accept(std::shared_ptr<ClaimedWatch> watch) {
  watch->set_ready([wake = wake_] { Post(wake); });
  {
    absl::MutexLock lock(&mutex_);
    watch_ = std::move(watch);
  }
  Post(wake_);
}

// Posts `ready` unless it is posted already. A message that becomes ready after `posted` is reset posts it again.
void WebWatch::Post(const std::shared_ptr<Wake>& wake) {
  if (wake->posted.exchange(true)) return;
  boost::asio::post(wake->strand, [wake] {
    wake->posted = false;
    wake->ready();
  });
}

stream::Bytes WebWatch::Take() {
  const auto given = watch();
  return given == nullptr ? nullptr : given->Take();
}

void WebWatch::NoteSent() {
  if (const auto given = watch()) given->NoteSent();
}

}  // namespace phrenic::service
