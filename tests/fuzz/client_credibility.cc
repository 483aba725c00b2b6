// Any bytes as a context of use give a report with fifteen verdicts, or an error that names the file; the same bytes as
// results of GoogleTest or as JSON evidence give values or errors.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "client/credibility/command_text.h"
#include "client/credibility/context_file.h"
#include "client/credibility/report.h"

namespace phrenic::client {
namespace {

void TryContext(const std::string& text) {
  const auto context = ParseCredibilityContext("fuzz", text);
  if (!context.ok()) {
    if (context.status().message().substr(0, 5) != "fuzz:") std::abort();
    return;
  }
  const auto report = MakeCredibilityReport(*context, {}, {});
  if (report.ok() && report->sections_size() != 15) std::abort();
  StudyCommand("sensitivity", "scene", context->preset(), {}, context->sensitivity());
  StudyCommand("uncertainty", "scene", context->preset(), {}, context->uncertainty());
  StudyCommand("convergence", "scene", context->preset(), {}, context->convergence());
}

}  // namespace
}  // namespace phrenic::client

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace phrenic;  // NOLINT(google-build-using-namespace)
  const std::string text(reinterpret_cast<const char*>(data), size);
  client::TryContext(text);
  (void)client::ParseExactCases("fuzz", text);
  const size_t line = text.find('\n');
  if (line == std::string::npos) return 0;
  const auto value = client::NumberInJson("fuzz", text.substr(line + 1), text.substr(0, line));
  if (value.ok() && !std::isfinite(*value)) std::abort();
  return 0;
}
