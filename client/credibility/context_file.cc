#include "client/credibility/context_file.h"

#include <filesystem>
#include <set>

#include "absl/strings/str_cat.h"
#include "client/credibility/evidence.h"
#include "client/files/whole_file.h"
#include "server/schema/schema.h"

namespace phrenic::client {
namespace {

absl::Status WrongContext(const std::string& file, const std::string& path, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(file, ": ", path, ": ", what));
}

absl::Status CheckCriteria(const std::string& file, const v1::CredibilityContext& context) {
  for (int i = 0; i < context.criteria_size(); ++i) {
    const v1::CredibilityCriterion& criterion = context.criteria(i);
    const std::string path = absl::StrCat("criteria[", i, "]");
    if (criterion.section() == v1::CREDIBILITY_SECTION_UNSPECIFIED) {
      return WrongContext(file, path + ".section", "must be set");
    }
    if (!criterion.has_at_least() && !criterion.has_at_most()) {
      return WrongContext(file, path, "needs at_least or at_most");
    }
    if (criterion.has_at_least() && criterion.has_at_most() && criterion.at_least() > criterion.at_most()) {
      return WrongContext(file, path, "at_least is above at_most: no number meets it");
    }
  }
  return absl::OkStatus();
}

absl::Status CheckNames(const std::string& file, const v1::CredibilityContext& context) {
  std::set<std::string> names;
  for (const v1::CredibilityCase& one : context.cases()) {
    if (!names.insert("case." + one.name()).second) {
      return WrongContext(file, "cases", absl::StrCat("two are named ", one.name()));
    }
  }
  for (int i = 0; i < context.evidence_size(); ++i) {
    const v1::CredibilityEvidence& evidence = context.evidence(i);
    const std::string path = absl::StrCat("evidence[", i, "]");
    if (!names.insert(evidence.name()).second) {
      return WrongContext(file, path, absl::StrCat("two numbers are named ", evidence.name()));
    }
    if (evidence.from_case() == v1::CredibilityEvidence::FROM_NOT_SET) {
      return WrongContext(file, path, "needs a value, or a file with a pointer");
    }
  }
  return absl::OkStatus();
}

template <typename Study>
void FillStudyOf(const v1::CredibilityContext& context, Study& study) {
  if (study.inputs().empty()) *study.mutable_inputs() = context.inputs();
  if (study.outputs().empty()) *study.mutable_outputs() = context.outputs();
}

}  // namespace

absl::StatusOr<v1::CredibilityContext> ParseCredibilityContext(const std::string& file, const std::string& text) {
  v1::CredibilityContext context;
  if (absl::Status status = schema::ParseText(file, text, &context); !status.ok()) return status;
  if (absl::Status status = CheckCriteria(file, context); !status.ok()) return status;
  if (absl::Status status = CheckNames(file, context); !status.ok()) return status;
  if (context.has_sensitivity()) FillStudyOf(context, *context.mutable_sensitivity());
  if (context.has_uncertainty()) FillStudyOf(context, *context.mutable_uncertainty());
  if (context.has_convergence() && context.convergence().outputs().empty()) {
    *context.mutable_convergence()->mutable_outputs() = context.outputs();
  }
  if ((context.has_sensitivity() && context.sensitivity().inputs().empty()) ||
      (context.has_uncertainty() && context.uncertainty().inputs().empty())) {
    return WrongContext(file, "inputs", "sensitivity and uncertainty need at least one");
  }
  return context;
}

absl::StatusOr<std::vector<v1::NumberRow>> ReadOwnEvidence(const v1::CredibilityContext& context,
                                                           const std::string& file,
                                                           const std::map<std::string, std::string>& files) {
  std::vector<v1::NumberRow> rows;
  for (const v1::CredibilityEvidence& evidence : context.evidence()) {
    v1::NumberRow& row = rows.emplace_back();
    row.set_name(evidence.name());
    row.set_unit(evidence.unit());
    row.set_what(evidence.what());
    row.set_source(evidence.source());
    row.set_command(evidence.command());
    const auto given = files.find(evidence.name());
    if (given == files.end() && evidence.from_case() == v1::CredibilityEvidence::kValue) {
      row.set_value(evidence.value());
      continue;
    }
    const std::string from =
        given != files.end() ? given->second : (std::filesystem::path(file).parent_path() / evidence.file()).string();
    const auto text = ReadWhole(from, "the evidence");
    if (!text.ok()) return text.status();
    const auto value = NumberInJson(from, *text, evidence.pointer());
    if (!value.ok()) return value.status();
    row.set_value(*value);
  }
  return rows;
}

}  // namespace phrenic::client
