#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/study/cost_sizes.h"
#include "server/study/cost_trials.h"
#include "server/study/subject.h"

namespace phrenic::study {
namespace {

constexpr double kGrowthCompiled = 0.5;  // fraction of the progress
constexpr double kSheetsUntil = 0.93;    // fraction of the budget
constexpr int kSmallestSheet = 5000;     // vertices
constexpr int kLargestOverSmallest = 8;  // least ratio of the sheets' sizes
constexpr double kCell = 0.01;           // edge of a sheet's cells [m]
constexpr double kMaxTurn = 1e7;         // largest product of vertices and steps in a turn
constexpr int kMinSteps = 10;            // of a turn

// Numbers of vertices: a geometric sequence of ratio 2 that ends with `largest`.
std::vector<int> SheetSizes(int largest) {
  std::vector<int> sizes;
  if (largest < kLargestOverSmallest) return sizes;
  const int first = std::min(kSmallestSheet, largest / kLargestOverSmallest);
  for (int size = std::max(4, first); size < largest * 0.75; size *= 2) sizes.push_back(size);
  sizes.push_back(largest);
  return sizes;
}

Timing MakeTiming(const Subject& subject, int steps) {
  const auto vertices = static_cast<double>(std::max<int64_t>(1, subject.model->report.simulated_vertices()));
  const int most = std::max(kMinSteps, static_cast<int>(kMaxTurn / vertices));
  return {.subject = subject, .again = {}, .steps = std::min(steps, most), .step_s = {}, .part_s = {}, .problem = ""};
}

// True, and noted, if the series that began at `began` [s] is out of time before its member i. Each member takes about
// as long as all before it.
bool IsTooLate(size_t i, double began, const std::string& what, CostBudget& budget) {
  const double took = i > 0 ? budget.spent() - began : 0;
  if (budget.LeftUntil(kSheetsUntil) > took) return false;
  budget.Cut(what + " are left out", took);
  return true;
}

absl::StatusOr<std::vector<Timing>> Sheets(const v1::CreateStudyRequest& request, const Subject& subject,
                                           const Compiler& compile, CostBudget& budget, const Progress& progress) {
  std::vector<Timing> timings;
  const std::vector<int> sizes = SheetSizes(request.cost().largest_sheet());
  const double began = budget.spent();
  for (size_t i = 0; i < sizes.size(); ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(sizes.size());
    if (IsTooLate(i, began, absl::StrCat("sheets of springs from ", sizes[i], " vertices"), budget)) break;
    if (!progress(done, absl::StrCat("making a sheet of ", sizes[i], " vertices"))) return Cancelled();
    v1::SceneSource source;
    *source.mutable_scene() = SheetOf(sizes[i]);
    source.mutable_scene()->mutable_parameters()->set_integrator(subject.parameters.integrator());
    const auto made = MakeSubject(source, "", {}, compile);
    if (!made.ok()) return made.status();
    timings.push_back(MakeTiming(*made, request.cost().steps()));
  }
  return timings;
}

absl::StatusOr<std::vector<Timing>> Resolutions(const v1::CreateStudyRequest& request, const Compiler& compile,
                                                CostBudget& budget, const Progress& progress) {
  std::vector<Timing> timings;
  std::vector<double> sizes(request.cost().resolutions_mm().begin(), request.cost().resolutions_mm().end());
  std::sort(sizes.rbegin(), sizes.rend());
  const double began = budget.spent();
  for (size_t i = 0; i < sizes.size(); ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(sizes.size());
    if (IsTooLate(i, began, absl::StrCat("the scene from ", sizes[i], " mm"), budget)) break;
    if (!progress(done, absl::StrCat("making the scene at ", sizes[i], " mm"))) return Cancelled();
    v1::SceneSource source = request.source();
    source.set_resolution_mm(sizes[i]);
    const auto made = MakeSubject(source, request.preset(), request.parameters(), compile);
    if (!made.ok()) return made.status();
    timings.push_back(MakeTiming(*made, request.cost().steps()));
  }
  return timings;
}

// Adds the rows of one series and returns its fitted exponent.
double AddRows(const std::string& what, const std::vector<Timing>& timings, v1::CostTable& table) {
  std::vector<double> vertices, costs;
  for (const Timing& timing : timings) {
    v1::GrowthRow& row = *table.add_growth();
    row.set_what(what);
    row.set_vertices(timing.subject.model->report.simulated_vertices());
    vertices.push_back(static_cast<double>(row.vertices()));
    costs.push_back(Median(timing.step_s));
    row.set_cpu_us_per_step(1e6 * costs.back());
    row.set_ns_per_vertex_step(1e9 * costs.back() / vertices.back());
    const size_t n = costs.size();
    if (n > 1) row.set_exponent(FitExponent({vertices[n - 2], vertices[n - 1]}, {costs[n - 2], costs[n - 1]}));
  }
  return FitExponent(vertices, costs);
}

}  // namespace

v1::Scene SheetOf(int vertices) {
  const int columns = std::max(2, static_cast<int>(std::lround(std::sqrt(vertices))));
  const int rows = std::max(2, (vertices + columns / 2) / columns);
  v1::Scene scene;
  scene.set_name("sheet");
  v1::Body& body = *scene.add_bodies();
  body.set_name("sheet");
  body.set_role(v1::ROLE_DEFORMABLE);
  body.mutable_material();
  for (int i = 0; i < columns; ++i) body.add_fixed_vertices(i);
  body.mutable_grid()->set_columns(columns);
  body.mutable_grid()->set_rows(rows);
  body.mutable_grid()->mutable_u()->set_x(kCell);
  body.mutable_grid()->mutable_v()->set_y(kCell);
  scene.add_forces()->mutable_springs()->add_bodies("sheet");
  scene.add_forces()->mutable_friction()->add_bodies("sheet");
  v1::Gravity& gravity = *scene.add_forces()->mutable_gravity();
  gravity.add_bodies("sheet");
  gravity.mutable_acceleration()->set_z(-9.81);
  return scene;
}

absl::Status AddGrowth(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                       CostBudget& budget, const Progress& progress, v1::CostTable& table) {
  auto sheets = Sheets(request, subject, compile, budget, Part(progress, 0, kGrowthCompiled / 2));
  if (!sheets.ok()) return sheets.status();
  auto resolutions = Resolutions(request, compile, budget, Part(progress, kGrowthCompiled / 2, kGrowthCompiled));
  if (!resolutions.ok()) return resolutions.status();
  const int trials = request.cost().trials();
  absl::Status status = TimeInterleaved(*sheets, trials, budget.LeftUntil(kSheetsUntil), "sheets of springs", budget,
                                        Part(progress, kGrowthCompiled, 0.8));
  if (status.ok()) {
    status = TimeInterleaved(*resolutions, trials, budget.LeftUntil(1), "resolutions of the scene", budget,
                             Part(progress, 0.8, 1));
  }
  if (!status.ok()) return status;
  const double of_sheets = AddRows("sheet of springs", *sheets, table);
  const double of_resolutions = AddRows("the scene, refined", *resolutions, table);
  if (sheets->size() > 1 || resolutions->size() > 1) {
    table.set_growth_exponent(sheets->size() > 1 ? of_sheets : of_resolutions);
  }
  return absl::OkStatus();
}

}  // namespace phrenic::study
