#include "server/access/audit.h"

#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/access/rules.h"

namespace phrenic::access {
namespace {

constexpr std::size_t kMaxBytes = 16 << 20, kRotatedFiles = 4;
constexpr std::size_t kMaxText = 128;  // longer than ids and addresses

// A long text of a caller must not push earlier lines out of the rotated files.
std::string Shortened(const std::string& text) { return text.substr(0, kMaxText); }

}  // namespace

absl::StatusOr<std::unique_ptr<AuditLog>> AuditLog::Open(const std::string& file) {
  auto audit = std::make_unique<AuditLog>();
  if (file.empty()) return audit;
  const mode_t before = umask(0077);
  try {
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_mt>(file, kMaxBytes, kRotatedFiles);
    audit->log_ = std::make_shared<spdlog::logger>("audit", std::move(sink));
  } catch (const spdlog::spdlog_ex& fault) {
    umask(before);
    return absl::PermissionDeniedError(absl::StrCat("--audit: ", fault.what()));
  }
  umask(before);
  audit->log_->set_pattern("%v");
  audit->log_->flush_on(spdlog::level::info);
  return audit;
}

void AuditLog::Note(const Caller& caller, std::string_view method, const std::string& session,
                    const absl::Status& outcome) {
  if (log_ == nullptr) return;
  nlohmann::ordered_json line = {{"time", absl::FormatTime(absl::RFC3339_full, absl::Now(), absl::UTCTimeZone())},
                                 {"caller", caller.id()},
                                 {"role", NameOf(caller.account.role)},
                                 {"peer", Shortened(caller.peer)},
                                 {"method", method},
                                 {"session", Shortened(session)},
                                 {"outcome", outcome.ok() ? "admitted" : absl::StatusCodeToString(outcome.code())}};
  log_->info(line.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
}

}  // namespace phrenic::access
