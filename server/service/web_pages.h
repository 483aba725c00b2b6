// The gateway's pages that are no files: whether the server lives, whether it serves, and its numbers.
#ifndef PHRENIC_SERVER_SERVICE_WEB_PAGES_H_
#define PHRENIC_SERVER_SERVICE_WEB_PAGES_H_

#include <atomic>
#include <optional>
#include <string_view>

#include "server/service/calls/access_guard.h"
#include "server/service/calls/metrics.h"
#include "server/service/web/web_connection.h"
#include "server/session/table.h"

namespace phrenic::service {

// Any thread may call.
class WebPages {
 public:
  WebPages(const AccessGuard& guard, Metrics& metrics, const session::Table& table)
      : guard_(guard), metrics_(metrics), table_(table) {}

  // Before it is called, and once the server ends, /readyz answers 503.
  void set_ready(bool ready) { ready_ = ready; }
  // "/healthz" and "/readyz" for everybody; "/metrics" for an administrator, or everybody where there are no accounts.
  std::optional<WebSettings::Page> Find(std::string_view target, std::string_view authorization);

 private:
  const AccessGuard& guard_;
  Metrics& metrics_;
  const session::Table& table_;
  std::atomic<bool> ready_ = false;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_PAGES_H_
