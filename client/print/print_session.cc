#include "client/print/print_session.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/time_util.h>

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

// Returns the set parameters of each group, as "breath_length=4 pause_share=0.2", in the schema's order.
std::vector<std::pair<std::string, std::string>> SettingsByGroup(const v1::Parameters& parameters) {
  std::vector<std::pair<std::string, std::string>> groups;
  for (int f = 0; f < v1::Parameters::descriptor()->field_count(); ++f) {
    const google::protobuf::FieldDescriptor& field = *v1::Parameters::descriptor()->field(f);
    if (!parameters.GetReflection()->HasField(parameters, &field)) continue;
    const std::string group = schema::GroupOf(field);
    if (groups.empty() || groups.back().first != group) groups.emplace_back(group, "");
    std::string& settings = groups.back().second;
    absl::StrAppend(&settings, settings.empty() ? "" : " ", std::string(field.name()), "=",
                    ParameterValue(parameters, field));
  }
  return groups;
}

}  // namespace

std::string StateName(v1::SessionState state) {
  switch (state) {
    case v1::SESSION_STATE_PAUSED:
      return "paused";
    case v1::SESSION_STATE_PLAYING:
      return "playing";
    case v1::SESSION_STATE_DIVERGED:
      return "diverged";
    default:
      return "unknown";
  }
}

std::string ParameterValue(const v1::Parameters& parameters, const google::protobuf::FieldDescriptor& field) {
  const google::protobuf::Reflection& reflection = *parameters.GetReflection();
  switch (field.cpp_type()) {
    case google::protobuf::FieldDescriptor::CPPTYPE_BOOL:
      return reflection.GetBool(parameters, &field) ? "on" : "off";
    case google::protobuf::FieldDescriptor::CPPTYPE_ENUM:
      return schema::ChoiceName(*reflection.GetEnum(parameters, &field));
    default:
      return absl::StrFormat("%g", reflection.GetDouble(parameters, &field));
  }
}

std::string ParametersLine(const v1::Parameters& parameters) {
  std::string line;
  for (const auto& [group, settings] : SettingsByGroup(parameters)) {
    absl::StrAppend(&line, line.empty() ? "" : " ", settings);
  }
  return line;
}

std::string ParameterLines(const v1::Parameters& parameters, const char* before) {
  std::string lines;
  for (const auto& [group, settings] : SettingsByGroup(parameters)) {
    absl::StrAppend(&lines, before, group, ": ", settings, "\n");
  }
  return lines;
}

std::string ResidualText(const v1::Session& session, const char* before, const char* after) {
  if (!session.has_constraint_residual()) return "";
  const std::string whose =
      session.residual_constraint().empty() ? "" : absl::StrCat(" (", session.residual_constraint(), ")");
  return absl::StrFormat("%s%.2g mm%s%s", before, 1e3 * session.constraint_residual(), whose, after);
}

std::string WarningLines(const google::protobuf::RepeatedPtrField<std::string>& warnings, const char* before) {
  std::string lines;
  for (const std::string& warning : warnings) absl::StrAppend(&lines, before, "warning: ", warning, "\n");
  return lines;
}

std::string SolverText(const v1::Session& session, const char* before, const char* after) {
  if (!session.has_solver_residual()) return "";
  return absl::StrFormat("%s%.1e left after %d iterations%s", before, session.solver_residual(),
                         session.solver_iterations(), after);
}

std::string ControlText(const v1::Control& control) {
  std::string text = "  everybody may control it\n";
  if (!control.controller().empty()) {
    text = absl::StrCat("  controlled by ", control.controller());
    if (control.has_expire_time()) {
      google::protobuf::Timestamp second;
      second.set_seconds(control.expire_time().seconds());
      absl::StrAppend(&text, ", until ", google::protobuf::util::TimeUtil::ToString(second),
                      " unless they send a command");
    }
    text += "\n";
  }
  for (const v1::Participant& person : control.participants()) {
    absl::StrAppend(&text, "  ", person.name(), person.owner() ? ", owner" : "",
                    person.asks() ? ", asks for control" : "", "\n");
  }
  return text;
}

void PrintSession(const v1::Session& session, std::ostream& out) {
  out << absl::StrFormat("%s: %s, %s, t = %.3f s, tick %d, revision %d, %d viewers\n", session.id(), session.scene(),
                         StateName(session.state()), session.time(), session.tick(), session.revision(),
                         session.viewers());
  if (session.pace().steps_per_second() > 0) {
    out << absl::StrFormat("  %.0f steps/s, %.2f times real time, %.3f CPU s per simulated s\n",
                           session.pace().steps_per_second(), session.pace().times_real_time(),
                           session.pace().cpu_per_simulated_second());
  }
  out << ParameterLines(session.parameters(), "  ");
  out << SolverText(session, "  solver: ", "\n");
  out << ResidualText(session, "  constraints kept within ", "\n");
  out << WarningLines(session.warnings(), "  ");
  if (!session.control().controller().empty()) out << ControlText(session.control());
  if (session.waiting_updates() > 0) out << "  " << session.waiting_updates() << " changes wait for their tick\n";
  for (const v1::Pull& pull : session.pulls()) {
    out << absl::StrFormat("  pulled by (%g, %g, %g) N at vertex %d of %s\n", pull.force().x(), pull.force().y(),
                           pull.force().z(), pull.vertex(), pull.body());
  }
  if (!session.carried_over().empty()) out << "  carried over: " << session.carried_over() << "\n";
  if (!session.not_saved().empty()) out << "  not saved: " << session.not_saved() << "\n";
  if (!session.has_divergence()) return;
  const v1::Divergence& why = session.divergence();
  out << absl::StrFormat("  diverged at t = %.4g s (tick %d): vertex %d of %s, by %s; %s\n", why.time(), why.tick(),
                         why.vertex(), why.body(), why.force(), why.remedy());
}

}  // namespace phrenic::client
