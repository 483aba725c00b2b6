#include "server/study/cost_variants.h"

#include <algorithm>
#include <map>
#include <optional>

#include "absl/strings/str_cat.h"
#include "server/study/cost_parts.h"
#include "server/study/cost_trials.h"
#include "server/study/subject.h"
#include "server/study/thesis_tables.h"

namespace phrenic::study {
namespace {

constexpr double kCompiled = 0.3;                                           // fraction of the progress
constexpr double kVariantsCompiledUntil = 0.25, kVariantsTimedUntil = 0.4;  // fractions of the budget

// One row before it is timed.
struct Variant {
  std::string name;
  std::string note;
  size_t never_had = 0;  // index of the variant that never had the part, for comparison; its own index if none
  std::optional<ThesisTrial> trial;
};

// Variants and their timings, by index; the first is the full scene.
struct Variants {
  std::vector<Variant> variants;
  std::vector<Timing> timings;

  size_t Add(Variant variant, const Subject& subject, int steps) {
    const size_t index = variants.size();
    variants.push_back(std::move(variant));
    timings.push_back({.subject = subject, .again = {}, .steps = steps, .step_s = {}, .part_s = {}, .problem = ""});
    return index;
  }
};

std::optional<ThesisTrial> TrialWithout(const std::string& part) {
  static const std::map<std::string, ThesisTrial> trials = {{"links", ThesisTrial::kNoLinks},
                                                            {"attachments", ThesisTrial::kNoAttachments},
                                                            {"ribs", ThesisTrial::kNoRibs},
                                                            {"muscles", ThesisTrial::kNoMuscles}};
  const auto found = trials.find(part);
  return found == trials.end() ? std::nullopt : std::optional(found->second);
}

// The compile report's reason for an element that it left out and that `never_had` does not have.
std::string WhyLeftOut(const Model& model, const Model& never_had) {
  if (model.forces.size() != never_had.forces.size() || model.constraints.size() != never_had.constraints.size()) {
    return "the compile step did NOT leave it out";
  }
  for (const v1::LeftOut& left_out : model.report.left_out()) {
    const auto& known = never_had.report.left_out();
    const bool same = std::any_of(known.begin(), known.end(),
                                  [&](const v1::LeftOut& other) { return other.what() == left_out.what(); });
    if (!same) return absl::StrCat(left_out.what(), ": ", left_out.why());
  }
  return "the compile step left it out";
}

// Notes that other elements of the scene need a part, so that there is no scene without it; other errors are returned.
absl::Status NoteNeeded(const std::string& part, const absl::Status& status, CostBudget& budget) {
  if (!absl::IsInvalidArgument(status)) return status;
  budget.Note(absl::StrCat("the scene without ", part,
                           " is left out, others of its elements need them: ", std::string(status.message())));
  return absl::OkStatus();
}

absl::Status AddLeftOut(const v1::CreateStudyRequest& request, const Subject& subject, const std::string& part,
                        size_t without, const Compiler& compile, CostBudget& budget, Variants& all) {
  const std::optional<v1::Scene> scene = LeftOut(*subject.model, part);
  if (!scene.has_value()) return absl::OkStatus();
  const auto left_out = Recompile(request, subject, *scene, compile);
  if (!left_out.ok()) return NoteNeeded(part, left_out.status(), budget);
  const std::string why = WhyLeftOut(*left_out->model, *all.timings[without].subject.model);
  all.Add({.name = part + " left out", .note = why, .never_had = without, .trial = {}}, *left_out,
          request.cost().steps());
  return absl::OkStatus();
}

// Adds the variants without one part: removed, made empty, switched off.
absl::Status AddPart(const v1::CreateStudyRequest& request, const Subject& subject, const std::string& part,
                     const Compiler& compile, CostBudget& budget, Variants& all) {
  const int steps = request.cost().steps();
  const auto without = Recompile(request, subject, Without(subject.model->scene, part), compile);
  if (!without.ok()) return NoteNeeded(part, without.status(), budget);
  const size_t index = all.variants.size();
  all.Add({.name = "without " + part, .note = "", .never_had = index, .trial = TrialWithout(part)}, *without, steps);
  if (absl::Status status = AddLeftOut(request, subject, part, index, compile, budget, all); !status.ok())
    return status;
  Subject off = subject;
  if (!SwitchOff(part, off.parameters)) return absl::OkStatus();
  all.Add({.name = part + " switched off", .note = "by a live parameter", .never_had = index, .trial = {}}, off, steps);
  return absl::OkStatus();
}

absl::StatusOr<Variants> MakeVariants(const v1::CreateStudyRequest& request, const Subject& subject,
                                      const Compiler& compile, CostBudget& budget, const Progress& progress) {
  Variants all;
  const bool links = subject.model->report.rigid_links() > 0;
  all.Add({.name = "full", .note = "", .never_had = 0, .trial = links ? ThesisTrial::kFull : ThesisTrial::kNoLinks},
          subject, request.cost().steps());
  v1::Scene again = subject.model->scene;
  again.set_description(again.description() + " Repeated.");
  const auto repeated = Recompile(request, subject, again, compile);
  if (!repeated.ok()) return repeated.status();
  all.Add({.name = "full, repeated", .note = "noise of the measurement", .never_had = 0, .trial = {}}, *repeated,
          request.cost().steps());
  const std::vector<std::string> parts = PartsOf(subject.model->scene);
  const double began = budget.spent();
  for (size_t i = 0; i < parts.size(); ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(parts.size());
    const double took = i > 0 ? (budget.spent() - began) / static_cast<double>(i) : 0;
    if (took > budget.LeftUntil(kVariantsCompiledUntil)) {
      budget.Cut(absl::StrCat("the scene without ", parts[i], " and what follows is left out"),
                 took * static_cast<double>(parts.size() - i));
      break;
    }
    if (!progress(done, "compiling the scene without " + parts[i])) return Cancelled();
    absl::Status status = AddPart(request, subject, parts[i], compile, budget, all);
    if (!status.ok()) return status;
  }
  return all;
}

void SetTimes(const Timing& timing, v1::CostRow& row) {
  const double seconds = Median(timing.step_s);
  row.set_cpu_us_per_step(1e6 * seconds);
  row.set_steps_per_s(seconds > 0 ? 1 / seconds : 0);
  row.set_ns_per_vertex_step(1e9 * seconds / static_cast<double>(std::max<int64_t>(1, row.vertices())));
  row.set_spread(Spread(timing.step_s));
}

void SetThesis(const Variant& variant, const Model& full, v1::CostRow& row) {
  if (!variant.trial.has_value()) return;
  const auto figure = LikeThesisFigure(full.scene, full.report.simulated_vertices(), *variant.trial);
  if (!figure.has_value()) return;
  row.set_thesis_steps_per_s(figure->steps_per_second);
  row.set_times_thesis(row.steps_per_s() / figure->steps_per_second);
  row.set_thesis(figure->what);
}

void AddRow(const Variants& all, size_t index, v1::CostTable& table) {
  const Variant& variant = all.variants[index];
  const Timing& timing = all.timings[index];
  const v1::CompileReport& report = timing.subject.model->report;
  v1::CostRow& row = *table.add_rows();
  row.set_variant(variant.name);
  row.set_vertices(report.simulated_vertices());
  row.set_springs(report.springs());
  row.set_links(report.rigid_links());
  row.set_note(timing.problem.empty() || variant.note.empty() ? variant.note + timing.problem
                                                              : absl::StrCat(variant.note, "; ", timing.problem));
  SetTimes(timing, row);
  AddTrials(variant.name, timing, table);
  row.set_share(MedianRatio(timing, all.timings.front()));
  if (variant.never_had != index) row.set_over_never_had(MedianRatio(timing, all.timings[variant.never_had]));
  SetThesis(variant, *all.timings.front().subject.model, row);
}

}  // namespace

absl::Status AddVariants(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                         CostBudget& budget, const Progress& progress, v1::CostTable& table) {
  auto all = MakeVariants(request, subject, compile, budget, Part(progress, 0, kCompiled));
  if (!all.ok()) return all.status();
  absl::Status status = TimeInterleaved(all->timings, request.cost().trials(), budget.LeftUntil(kVariantsTimedUntil),
                                        "variants of the scene", budget, Part(progress, kCompiled, 1));
  if (!status.ok()) return status;
  for (size_t index = 0; index < all->variants.size(); ++index) AddRow(*all, index, table);
  return absl::OkStatus();
}

}  // namespace phrenic::study
