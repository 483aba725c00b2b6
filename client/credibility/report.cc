#include "client/credibility/report.h"

#include <algorithm>
#include <map>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "server/schema/fields.h"
#include "server/schema/names.h"

namespace phrenic::client {
namespace {

struct SectionText {
  v1::CredibilitySection section;
  const char* title;
  const char* asked;
};

constexpr SectionText kSections[] = {
    {v1::CREDIBILITY_SECTION_QUESTION, "Question of interest",
     "The question that the model helps to answer, and the decision that rests on the answer (V&V 40, 3.1)."},
    {v1::CREDIBILITY_SECTION_CONTEXT_OF_USE, "Context of use",
     "What is modelled, what is read off the model and how it is used (V&V 40, 3.2)."},
    {v1::CREDIBILITY_SECTION_MODEL_RISK, "Model risk",
     "How much the decision rests on the model, and the consequence of a wrong one (V&V 40, 3.3)."},
    {v1::CREDIBILITY_SECTION_CODE_VERIFICATION, "Code verification",
     "The equations are solved correctly: comparison with exact solutions, and measured orders (FDA category 1)."},
    {v1::CREDIBILITY_SECTION_CALIBRATION, "Model calibration",
     "What was fitted, to which data, and how well. Fitted numbers are no evidence of prediction (category 2)."},
    {v1::CREDIBILITY_SECTION_BENCH, "Bench test validation",
     "Comparison with measurements on a bench: phantoms, tissue, devices (category 3)."},
    {v1::CREDIBILITY_SECTION_IN_VIVO, "In vivo validation",
     "Comparison with measurements in people who were not used for calibration (category 4)."},
    {v1::CREDIBILITY_SECTION_POPULATION, "Population-based validation",
     "Comparison of distributions over many people, with their spread (category 5)."},
    {v1::CREDIBILITY_SECTION_EMERGENT_BEHAVIOUR, "Emergent model behaviour",
     "Effects that follow from causes and were not put in: each appears with its cause, and not without (category 6)."},
    {v1::CREDIBILITY_SECTION_PLAUSIBILITY, "Model plausibility",
     "Equations, parameters and outputs lie where published knowledge has them (category 7)."},
    {v1::CREDIBILITY_SECTION_CALCULATION_VERIFICATION, "Calculation verification",
     "The error of time step, mesh and solver in the outputs of this use (category 8)."},
    {v1::CREDIBILITY_SECTION_UNCERTAINTY, "Uncertainty and sensitivity",
     "How far inputs that are not known exactly move the outputs of this use (category 8; V&V 40, 5.1)."},
    {v1::CREDIBILITY_SECTION_APPLICABILITY, "Applicability",
     "Whether the evidence is about what the model is used for (V&V 40, 5.3)."},
    {v1::CREDIBILITY_SECTION_MISSING, "What is missing",
     "What is known to be wrong or absent, and whether what is required has been shown (V&V 40, 6)."},
    {v1::CREDIBILITY_SECTION_REPEATABILITY, "Repeating it",
     "Versions, hashes, and the command that makes each number again."},
};

constexpr char kHolds[] = "holds", kFails[] = "fails", kNoEvidence[] = "no evidence";

std::string AcceptedText(const v1::CredibilityCriterion& criterion) {
  if (!criterion.has_at_most()) return absl::StrCat("at least ", schema::FormatNumber(criterion.at_least()));
  if (!criterion.has_at_least()) return absl::StrCat("at most ", schema::FormatNumber(criterion.at_most()));
  return absl::StrCat(schema::FormatNumber(criterion.at_least()), " to ", schema::FormatNumber(criterion.at_most()));
}

// True if evidence of a kind that was not made may have a number of that name.
bool MayExist(const std::string& name, const v1::CredibilityContext& context, const Evidence& evidence) {
  const std::pair<const char*, bool> kinds[] = {
      {"exact.", !evidence.exact_cases.empty()},          {"orders.", !evidence.orders.empty()},
      {"physiology.", evidence.physiology.has_value()},   {"convergence.", evidence.convergence.has_value()},
      {"sensitivity.", evidence.sensitivity.has_value()}, {"uncertainty.", evidence.uncertainty.has_value()}};
  for (const auto& [prefix, made] : kinds) {
    if (absl::StartsWith(name, prefix)) return !made;
  }
  return std::any_of(context.cases().begin(), context.cases().end(),
                     [&](const v1::CredibilityCase& one) { return name == "case." + one.name(); });
}

// Makes the sections of one report.
class Judge {
 public:
  Judge(const v1::CredibilityContext& context, const Evidence& evidence, const EvidenceCommands& commands)
      : context_(context), evidence_(evidence) {
    *report_.mutable_context() = context;
    report_.set_scene(evidence.scene);
    report_.set_model_risk(ModelRiskOf(context));
    for (v1::NumberRow& row : NumbersOf(evidence, commands)) {
      numbers_.emplace(row.name(), row);
      *report_.add_numbers() = row;
    }
    for (const int section : context.required_sections()) {
      required_.push_back(static_cast<v1::CredibilitySection>(section));
    }
    if (required_.empty()) required_ = RequiredAt(report_.model_risk());
  }

  absl::StatusOr<v1::CredibilityReport> Make() {
    for (const SectionText& text : kSections) {
      v1::SectionReport& section = *report_.add_sections();
      section.set_section(text.section);
      section.set_title(text.title);
      section.set_asked(text.asked);
      section.set_required(IsRequired(text.section));
    }
    AddOwnCriteria();
    for (const v1::CredibilityCriterion& criterion : context_.criteria()) {
      if (absl::Status status = AddCriterion(criterion); !status.ok()) return status;
    }
    AddFindings();
    for (v1::SectionReport& section : *report_.mutable_sections()) {
      if (section.section() != v1::CREDIBILITY_SECTION_MISSING) Conclude(section);
    }
    JudgeMissing();
    AddTables();
    return std::move(report_);
  }

 private:
  bool IsRequired(v1::CredibilitySection section) const {
    return std::find(required_.begin(), required_.end(), section) != required_.end();
  }
  v1::SectionReport& At(v1::CredibilitySection section) { return *report_.mutable_sections(section - 1); }

  // Adds a criterion of the report's own.
  void Own(v1::CredibilitySection section, const std::string& what, const std::string& accepted, bool holds,
           const std::string& reason, std::optional<double> value = std::nullopt, const std::string& unit = "") {
    v1::CriterionRow& row = *At(section).add_criteria();
    row.set_number(what);
    row.set_accepted(accepted);
    if (value) row.set_value(*value);
    row.set_unit(unit);
    row.set_verdict(holds ? kHolds : kFails);
    row.set_reason(reason);
  }
  void OwnText(v1::CredibilitySection section, const std::string& what, const std::string& text) {
    Own(section, what, "is stated", !text.empty(), text);
  }

  void AddOwnCriteria() {
    OwnText(v1::CREDIBILITY_SECTION_QUESTION, "question", context_.question());
    OwnText(v1::CREDIBILITY_SECTION_QUESTION, "decision", context_.decision());
    OwnText(v1::CREDIBILITY_SECTION_CONTEXT_OF_USE, "context of use", context_.context_of_use());
    Own(v1::CREDIBILITY_SECTION_CONTEXT_OF_USE, "outputs that are read off the model", "at least 1",
        context_.outputs_size() + context_.cases_size() > 0, "outputs and cases of the context",
        context_.outputs_size() + context_.cases_size());
    AddLevel("model influence", context_.model_influence(), context_.model_influence_reason());
    AddLevel("decision consequence", context_.decision_consequence(), context_.decision_consequence_reason());
    for (const v1::ApplicabilityAspect& aspect : context_.applicability()) {
      Own(v1::CREDIBILITY_SECTION_APPLICABILITY, aspect.aspect(),
          absl::StrCat("shown: ", aspect.shown(), "; used: ", aspect.used()), aspect.covered(), aspect.reason());
    }
    AddRepeatability();
  }

  void AddLevel(const std::string& what, v1::RiskLevel level, const std::string& reason) {
    const bool stated = level != v1::RISK_LEVEL_UNSPECIFIED && !reason.empty();
    const std::string name = schema::ChoiceName(*v1::RiskLevel_descriptor()->FindValueByNumber(level));
    Own(v1::CREDIBILITY_SECTION_MODEL_RISK, what, "is stated, with a reason", stated, absl::StrCat(name, ": ", reason));
  }

  void AddRepeatability() {
    const auto section = v1::CREDIBILITY_SECTION_REPEATABILITY;
    double with_command = 0;
    for (const v1::NumberRow& row : report_.numbers()) with_command += row.command().empty() ? 0 : 1;
    const double all = report_.numbers_size();
    Own(section, "numbers with the command that makes them", "100 %", all > 0 && with_command == all, "",
        all > 0 ? 100 * with_command / all : 0, "%");
    Own(section, "evidence of another scene", "none", evidence_.of_other_scenes.empty(),
        absl::StrJoin(evidence_.of_other_scenes, "; "), static_cast<double>(evidence_.of_other_scenes.size()));
    Own(section, "evidence that does not say of which scene it is", "none", evidence_.without_hash.empty(),
        absl::StrJoin(evidence_.without_hash, "; "), static_cast<double>(evidence_.without_hash.size()));
    Own(section, "hash of the scene", "is known", !evidence_.scene_hash.empty(), evidence_.scene_hash);
  }

  absl::Status AddCriterion(const v1::CredibilityCriterion& criterion) {
    v1::CriterionRow& row = *At(criterion.section()).add_criteria();
    row.set_number(criterion.number());
    row.set_accepted(AcceptedText(criterion));
    row.set_reason(criterion.reason());
    row.set_verdict(kNoEvidence);
    const auto found = numbers_.find(criterion.number());
    if (found == numbers_.end()) {
      if (MayExist(criterion.number(), context_, evidence_)) return absl::OkStatus();
      return Unknown(criterion.number());
    }
    row.set_unit(found->second.unit());
    if (!found->second.has_value()) return absl::OkStatus();
    const double value = found->second.value();
    row.set_value(value);
    const bool low = criterion.has_at_least() && value < criterion.at_least();
    const bool high = criterion.has_at_most() && value > criterion.at_most();
    row.set_verdict(low || high ? kFails : kHolds);
    return absl::OkStatus();
  }

  absl::Status Unknown(const std::string& number) const {
    std::vector<std::string> names;
    names.reserve(numbers_.size());
    for (const auto& [name, row] : numbers_) names.push_back(name);
    return absl::InvalidArgumentError(
        absl::StrCat("criteria: there is no number \"", number, "\"", schema::ThereAre(number, names)));
  }

  // Sentences of what was made.
  void AddFindings() {
    for (const auto& [section, names] :
         std::initializer_list<std::pair<v1::CredibilitySection, std::vector<const char*>>>{
             {v1::CREDIBILITY_SECTION_CODE_VERIFICATION,
              {"exact.cases", "exact.passed_percent", "orders.passed_percent"}},
             {v1::CREDIBILITY_SECTION_EMERGENT_BEHAVIOUR, {"physiology.changes.inside_percent"}},
             {v1::CREDIBILITY_SECTION_PLAUSIBILITY, {"physiology.health.inside_percent"}}}) {
      for (const char* name : names) {
        const auto found = numbers_.find(name);
        if (found == numbers_.end() || !found->second.has_value()) continue;
        At(section).add_found(absl::StrFormat("%s: %.4g %s, %s.", name, found->second.value(),
                                              found->second.unit() == "1" ? "" : found->second.unit(),
                                              found->second.what()));
      }
    }
    for (const v1::CredibilityEvidence& own : context_.evidence()) {
      if (own.section() == v1::CREDIBILITY_SECTION_UNSPECIFIED) continue;
      const auto found = numbers_.find(own.name());
      if (found == numbers_.end() || !found->second.has_value()) continue;
      At(own.section())
          .add_found(absl::StrFormat("%s: %.4g %s (%s).", own.what(), found->second.value(), own.unit(), own.source()));
    }
    for (const v1::CredibilityCase& one : context_.cases()) {
      const auto found = numbers_.find("case." + one.name());
      if (found == numbers_.end() || !found->second.has_value()) continue;
      const std::string sentence =
          absl::StrFormat("%s: %.4g %s.", one.what(), found->second.value(), found->second.unit());
      for (v1::SectionReport& section : *report_.mutable_sections()) {
        const auto judged = [&](const v1::CriterionRow& row) { return row.number() == "case." + one.name(); };
        if (std::any_of(section.criteria().begin(), section.criteria().end(), judged)) section.add_found(sentence);
      }
    }
  }

  // Sets the verdict from the criteria, and says what is missing.
  void Conclude(v1::SectionReport& section) {
    int holding = 0;
    std::vector<std::string> open;
    for (const v1::CriterionRow& row : section.criteria()) {
      if (row.verdict() == kHolds) {
        ++holding;
        continue;
      }
      open.push_back(row.number());
      const std::string now = row.has_value()
                                  ? absl::StrFormat("it is %.4g %s", row.value(), row.unit() == "1" ? "" : row.unit())
                                  : row.verdict();
      AddMissing(section, absl::StrCat(row.number(), " must be ", row.accepted(), ": ", now));
    }
    const int all = section.criteria_size();
    if (all == 0) {
      section.set_verdict(v1::SECTION_VERDICT_NOT_SHOWN);
      section.set_reason("There is no evidence, and no criterion.");
      AddMissing(section, "no evidence, and no criterion in the context");
      return;
    }
    section.set_verdict(holding == all ? v1::SECTION_VERDICT_MET
                                       : (holding > 0 ? v1::SECTION_VERDICT_PARTLY : v1::SECTION_VERDICT_NOT_SHOWN));
    section.set_reason(absl::StrFormat("%d of %d criteria hold%s%s.", holding, all, open.empty() ? "" : "; not ",
                                       absl::StrJoin(open, ", ")));
  }

  void AddMissing(v1::SectionReport& section, const std::string& what) {
    section.add_missing(what);
    v1::MissingRow& row = *report_.add_missing();
    row.set_section(section.title());
    row.set_what(what);
  }

  void JudgeMissing() {
    const auto section = v1::CREDIBILITY_SECTION_MISSING;
    std::vector<std::string> open;
    for (const v1::SectionReport& each : report_.sections()) {
      if (each.section() == section || !each.required() || each.verdict() == v1::SECTION_VERDICT_MET) continue;
      open.push_back(each.title());
    }
    for (const std::string& absent : evidence_.absent) At(section).add_found(absent);
    for (const std::string& limitation : context_.limitations()) At(section).add_found(limitation);
    Own(section, "required sections that are not met", "none", open.empty(), absl::StrJoin(open, ", "),
        static_cast<double>(open.size()));
    Own(section, "limitations", "are stated", context_.limitations_size() > 0, "", context_.limitations_size());
    Conclude(At(section));
    const bool itself = !At(section).required() || At(section).verdict() == v1::SECTION_VERDICT_MET;
    report_.set_adequate(open.empty() && itself);
  }

  void AddTables() {
    for (const v1::VersionRow& row : evidence_.versions) *report_.add_versions() = row;
    for (const v1::ExactCaseRow& row : evidence_.exact_cases) *report_.add_exact_cases() = row;
    for (const v1::OrderRow& row : evidence_.orders) *report_.add_orders() = row;
    if (evidence_.sensitivity) *report_.mutable_sensitivity() = *evidence_.sensitivity;
    if (evidence_.uncertainty) *report_.mutable_uncertainty() = *evidence_.uncertainty;
    if (evidence_.convergence) *report_.mutable_convergence() = *evidence_.convergence;
    if (!evidence_.physiology) return;
    *report_.mutable_physiology() = *evidence_.physiology;
    report_.mutable_physiology()->clear_curves();
  }

  const v1::CredibilityContext& context_;
  const Evidence& evidence_;
  std::vector<v1::CredibilitySection> required_;
  std::map<std::string, v1::NumberRow> numbers_;
  v1::CredibilityReport report_;
};

}  // namespace

v1::RiskLevel ModelRiskOf(const v1::CredibilityContext& context) {
  if (context.model_influence() == v1::RISK_LEVEL_UNSPECIFIED ||
      context.decision_consequence() == v1::RISK_LEVEL_UNSPECIFIED) {
    return v1::RISK_LEVEL_UNSPECIFIED;
  }
  const int sum = context.model_influence() + context.decision_consequence();
  if (sum <= v1::RISK_LEVEL_LOW + v1::RISK_LEVEL_MEDIUM) return v1::RISK_LEVEL_LOW;
  return sum == 2 * v1::RISK_LEVEL_MEDIUM ? v1::RISK_LEVEL_MEDIUM : v1::RISK_LEVEL_HIGH;
}

std::vector<v1::CredibilitySection> RequiredAt(v1::RiskLevel risk) {
  std::vector<v1::CredibilitySection> sections;
  for (const SectionText& text : kSections) {
    if (text.section == v1::CREDIBILITY_SECTION_MISSING) continue;
    const bool always = text.section <= v1::CREDIBILITY_SECTION_CODE_VERIFICATION ||
                        text.section == v1::CREDIBILITY_SECTION_EMERGENT_BEHAVIOUR ||
                        text.section == v1::CREDIBILITY_SECTION_PLAUSIBILITY ||
                        text.section == v1::CREDIBILITY_SECTION_CALCULATION_VERIFICATION ||
                        text.section == v1::CREDIBILITY_SECTION_APPLICABILITY ||
                        text.section == v1::CREDIBILITY_SECTION_REPEATABILITY;
    const bool at_medium = text.section == v1::CREDIBILITY_SECTION_CALIBRATION ||
                           text.section == v1::CREDIBILITY_SECTION_IN_VIVO ||
                           text.section == v1::CREDIBILITY_SECTION_UNCERTAINTY;
    if (always || (at_medium && risk != v1::RISK_LEVEL_LOW) || risk == v1::RISK_LEVEL_HIGH ||
        risk == v1::RISK_LEVEL_UNSPECIFIED) {
      sections.push_back(text.section);
    }
  }
  return sections;
}

absl::StatusOr<v1::CredibilityReport> MakeCredibilityReport(const v1::CredibilityContext& context,
                                                            const Evidence& evidence,
                                                            const EvidenceCommands& commands) {
  return Judge(context, evidence, commands).Make();
}

const char* TitleOf(v1::CredibilitySection section) {
  return section == v1::CREDIBILITY_SECTION_UNSPECIFIED ? "" : kSections[section - 1].title;
}

const char* TextOf(v1::SectionVerdict verdict) {
  switch (verdict) {
    case v1::SECTION_VERDICT_MET:
      return "met";
    case v1::SECTION_VERDICT_PARTLY:
      return "partly";
    default:
      return "NOT SHOWN";
  }
}

}  // namespace phrenic::client
