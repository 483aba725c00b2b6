#include "server/lti/pages.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/lti/form.h"
#include "server/lti/lessons.h"

namespace phrenic::lti {
namespace {

constexpr char kStyle[] = R"(:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { max-width: 42rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; }
fieldset { border: 1px solid; border-radius: 0.5rem; margin: 1rem 0; padding: 0.5rem 1rem; }
legend { font-weight: 600; }
label { display: flex; gap: 0.6rem; padding: 0.4rem 0; align-items: baseline; }
button { font: inherit; padding: 0.6rem 1.2rem; border-radius: 0.5rem; }
)";
constexpr char kScript[] = "document.forms[0].submit();\n";

// Sets the headers of a page whose forms go to `form_action`.
void Protect(const std::vector<std::string>& framers, const std::string& form_action, Response& response) {
  const std::string ancestors = framers.empty() ? "'none'" : absl::StrJoin(framers, " ");
  response.headers.emplace_back(
      "Content-Security-Policy",
      absl::StrCat("default-src 'none'; style-src 'self'; script-src 'self'; base-uri 'none'; "
                   "form-action ",
                   form_action, "; frame-ancestors ", ancestors));
  response.headers.emplace_back("Referrer-Policy", "no-referrer");
  if (framers.empty()) response.headers.emplace_back("X-Frame-Options", "DENY");
}

std::string PageText(const std::string& title, const std::string& body) {
  return absl::StrCat("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>", HtmlText(title),
                      "</title><meta name=\"viewport\" content=\"width=device-width\">"
                      "<link rel=\"stylesheet\" href=\"/lti/style.css\"></head><body><main><h1>",
                      HtmlText(title), "</h1>", body, "</main></body></html>\n");
}

unsigned HttpStatusOf(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kUnauthenticated:
      return 401;
    case absl::StatusCode::kPermissionDenied:
      return 403;
    case absl::StatusCode::kNotFound:
      return 404;
    case absl::StatusCode::kInvalidArgument:
      return 400;
    default:
      return 503;
  }
}

std::string LessonRow(const std::string& name, const v1::Lesson& lesson, bool first) {
  const int questions = QuestionCount(lesson);
  const std::string count =
      questions == 0 ? "no questions that count" : absl::StrCat(questions, questions == 1 ? " question" : " questions");
  return absl::StrCat("<label><input type=\"radio\" name=\"lesson\" value=\"", HtmlText(name), "\"",
                      first ? " checked" : "", "><span><b>", HtmlText(lesson.title()), "</b> (", count, ")<br>",
                      HtmlText(lesson.summary()), "</span></label>");
}

}  // namespace

Response ErrorPage(const absl::Status& status, const std::vector<std::string>& framers) {
  Response response{.status = HttpStatusOf(status)};
  response.text = PageText("The lesson cannot be opened",
                           absl::StrCat("<p role=\"alert\">", HtmlText(std::string(status.message())), "</p>"));
  Protect(framers, "'none'", response);
  return response;
}

Response ChoicePage(const std::vector<std::pair<std::string, v1::Lesson>>& lessons, const std::string& ticket,
                    const std::vector<std::string>& framers) {
  std::string body =
      absl::StrCat("<form method=\"post\" action=\"/lti/select\"><input type=\"hidden\" name=\"ticket\" value=\"",
                   HtmlText(ticket), "\"><fieldset><legend>Lesson</legend>");
  for (const auto& [name, lesson] : lessons) {
    absl::StrAppend(&body, LessonRow(name, lesson, name == lessons.front().first));
  }
  absl::StrAppend(&body,
                  "</fieldset><fieldset><legend>Who changes the breath</legend>"
                  "<label><input type=\"radio\" name=\"learners\" value=\"viewer\" checked><span>The teacher; learners "
                  "watch and answer</span></label>"
                  "<label><input type=\"radio\" name=\"learners\" value=\"controller\"><span>Learners too: all see the "
                  "same thorax</span></label></fieldset>"
                  "<button type=\"submit\">Add the lesson to the course</button></form>");
  Response response;
  response.text = PageText("Choose a lesson", body);
  Protect(framers, "'self'", response);
  return response;
}

Response SendPage(const std::string& address, const std::string& token, const std::vector<std::string>& framers) {
  Response response;
  response.text = PageText(
      "The lesson is added to your course",
      absl::StrCat(
          "<form method=\"post\" action=\"", HtmlText(address), "\"><input type=\"hidden\" name=\"JWT\" value=\"",
          HtmlText(token),
          "\"><button type=\"submit\">Back to the course</button></form><script src=\"/lti/send.js\"></script>"));
  // Where the platform forwards the form to another of its origins, the policy must allow that as well.
  Protect(framers, absl::StrJoin(framers, " "), response);
  return response;
}

Response Redirect(const std::string& address) {
  return {.status = 303, .text = "", .headers = {{"Location", address}, {"Referrer-Policy", "no-referrer"}}};
}

Response AssetOf(std::string_view path) {
  if (path == "/lti/style.css") return {.type = "text/css; charset=utf-8", .text = kStyle};
  if (path == "/lti/send.js") return {.type = "text/javascript; charset=utf-8", .text = kScript};
  return {.status = 404, .type = "text/plain; charset=utf-8", .text = "there is no such page below /lti/\n"};
}

std::vector<std::string> FramersOf(const Platform& platform) {
  return {platform.origins.begin(), platform.origins.end()};
}

}  // namespace phrenic::lti
