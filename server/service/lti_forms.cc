#include "server/service/lti_forms.h"

#include <utility>

#include "absl/time/clock.h"

namespace phrenic::service {
namespace {

constexpr std::size_t kFormThreads = 4;
constexpr int kMostForms = 64;

WebSettings::Page BusyPage() {
  constexpr unsigned kUnavailable = 503;
  return {kUnavailable, "text/plain; charset=utf-8", "the server is busy: open the activity again in a minute\n"};
}

}  // namespace

LtiForms::LtiForms(lti::Settings settings, std::unique_ptr<lti::ToolKey> key, std::string lessons_folder,
                   lti::Classroom& classroom, store::Store* store)
    : settings_(settings),
      tool_({.settings = std::move(settings),
             .key = std::move(key),
             .lessons_folder = std::move(lessons_folder),
             .classroom = &classroom,
             .store = store}),
      threads_(std::make_unique<WorkerThreads>(kFormThreads)) {}

void LtiForms::AddTo(WebSettings& settings) {
  for (const lti::Platform& platform : settings_.platforms) {
    settings.framers.insert(settings.framers.end(), platform.origins.begin(), platform.origins.end());
  }
  settings.allowed_hosts.push_back(settings_.url.substr(settings_.url.find("://") + 3));
  settings.form = [this](WebSettings::Form form, std::function<void(WebSettings::Page)> done) {
    if (waiting_ >= kMostForms) return done(BusyPage());
    ++waiting_;
    threads_->Post([this, form = std::move(form), done = std::move(done)] {
      lti::Response response = tool_.Handle({form.post, form.target, form.body, form.cookies}, absl::Now());
      --waiting_;
      done({response.status, std::move(response.type), std::move(response.text), std::move(response.headers)});
    });
  };
}

SessionService::Listener LtiForms::listener() {
  return {.answered = [this](const v1::SubmitAnswerRequest& answer) { tool_.Answered(answer, absl::Now()); },
          .launched = [this](const std::string& session,
                             const std::string& respondent) { return tool_.Launched(session, respondent); },
          .names = [this](const std::string& session) { return tool_.Names(session, absl::Now()); }};
}

void LtiForms::Shutdown() {
  tool_.Cancel();
  threads_.reset();
}

}  // namespace phrenic::service
