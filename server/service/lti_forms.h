// Brings the tool of learning platforms (lti/) to the web gateway and to the sessions' answers.
#ifndef PHRENIC_SERVER_SERVICE_LTI_FORMS_H_
#define PHRENIC_SERVER_SERVICE_LTI_FORMS_H_

#include <atomic>
#include <memory>
#include <string>

#include "server/lti/tool.h"
#include "server/service/calls/worker_threads.h"
#include "server/service/session_service.h"
#include "server/service/web/web_connection.h"

namespace phrenic::service {

// Thread-safe. Four threads answer requests, which may wait for platforms and for sessions; 64 requests wait at most,
// and others get 503.
class LtiForms {
 public:
  // `classroom` and `store` (null: none) outlive it.
  LtiForms(lti::Settings settings, std::unique_ptr<lti::ToolKey> key, std::string lessons_folder,
           lti::Classroom& classroom, store::Store* store);

  lti::Tool& tool() { return tool_; }
  // Makes the gateway answer /lti/ at the host of --lti-url, and lets the platforms frame the viewer. The gateway must
  // be shut down before Shutdown, and destroyed after it.
  void AddTo(WebSettings& settings);
  // Returns what hears of answers.
  SessionService::Listener listener();
  // Ends requests to platforms, and waits for the threads. Idempotent.
  void Shutdown();

 private:
  const lti::Settings settings_;
  lti::Tool tool_;
  std::atomic<int> waiting_ = 0;            // requests that are not answered
  std::unique_ptr<WorkerThreads> threads_;  // last: its tasks use the others
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_LTI_FORMS_H_
