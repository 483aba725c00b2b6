// The gateway's generated pages: liveness, readiness and metrics.
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

// Thread-safe. The gateway calls Find for each GET and HEAD, before it looks for a file. Generated pages are not
// cached.
class WebPages {
 public:
  // All outlive the pages.
  WebPages(const AccessGuard& guard, Metrics& metrics, const session::Table& table)
      : guard_(guard), metrics_(metrics), table_(table) {}

  // /readyz answers 503 until it is set, and again during shutdown. Server sets it, by whether a call that it makes to
  // itself every 2 s succeeds within 1 s.
  void set_ready(bool ready) { ready_ = ready; }
  // True if /readyz answers 200.
  bool ready() const { return ready_; }
  // Returns "/healthz", "/readyz" or, for an administrator's Authorization header, "/metrics" (401 for others); every
  // caller may read it if the server has no accounts. "/known" is 200 for callers that AccessGuard::Known has and 401
  // for others; proxies ask it before they pass a call on. Returns nullopt for other targets. "/healthz" is always 200.
  // Texts are plain; "/metrics" has Prometheus' text format 0.0.4. A query after the target makes it another target.
  std::optional<WebSettings::Page> Find(std::string_view target, const WebSettings::Credentials& credentials);

 private:
  const AccessGuard& guard_;
  Metrics& metrics_;
  const session::Table& table_;
  std::atomic<bool> ready_ = false;  // written by Server, read by the gateway
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_PAGES_H_
