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

// Thread-safe.
class WebPages {
 public:
  WebPages(const AccessGuard& guard, Metrics& metrics, const session::Table& table)
      : guard_(guard), metrics_(metrics), table_(table) {}

  // /readyz answers 503 until it is set, and again during shutdown.
  void set_ready(bool ready) { ready_ = ready; }
  bool ready() const { return ready_; }
  // Returns "/healthz", "/readyz" or, for an administrator's Authorization header, "/metrics" (401 for others); every
  // caller may read it if the server has no accounts. "/known" is 200 for callers that AccessGuard::Known has and 401
  // for others; proxies ask it before they pass a call on. Returns nullopt for other targets.
  std::optional<WebSettings::Page> Find(std::string_view target, const WebSettings::Credentials& credentials);

 private:
  const AccessGuard& guard_;
  Metrics& metrics_;
  const session::Table& table_;
  std::atomic<bool> ready_ = false;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_PAGES_H_
