#include "server/study/cost_sizes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "server/study/cost_parts.h"
#include "server/study/cost_trials.h"
#include "server/study/subject.h"
#include "server/study/thesis_tables.h"

namespace phrenic::study {
namespace {

constexpr double kSizesCompiled = 0.6;                     // fraction of the progress
constexpr double kTolerance = 0.01;                        // relative, of the thesis' number of vertices
constexpr int kIterations = 3;                             // of the resolution for that number
constexpr double kMeshedUntil = 0.75, kTimedUntil = 0.85;  // fractions of the budget
constexpr int kCubeVertices = 8;
constexpr int kCubeSteps = 100'000;  // of a trial of figure 5.10

// Mean edge length of the deformable bodies [mm]: the initial guess of the resolution if the scene names none.
double MeanEdgeMm(const Model& model) {
  double sum = 0;
  Eigen::Index count = 0;
  for (const BodyModel& body : model.bodies) {
    if (body.first_vertex < 0) continue;
    for (const auto corner : body.mesh.triangles.colwise()) {
      sum += (body.mesh.vertices.col(corner[0]) - body.mesh.vertices.col(corner[1])).norm();
      ++count;
    }
  }
  return count > 0 ? 1e3 * sum / static_cast<double>(count) : 0;
}

bool IsGenerated(const v1::Scene& scene) {
  return std::any_of(scene.bodies().begin(), scene.bodies().end(),
                     [](const v1::Body& body) { return body.role() == v1::ROLE_DEFORMABLE && body.has_generated(); });
}

double ResolutionOf(const v1::CreateStudyRequest& request, const Model& model) {
  if (request.source().has_resolution_mm()) return request.source().resolution_mm();
  for (const v1::Body& body : model.scene.bodies()) {
    if (body.role() == v1::ROLE_DEFORMABLE && body.generated().has_resolution_mm()) {
      return body.generated().resolution_mm();
    }
  }
  return MeanEdgeMm(model);
}

// A subject with the resolution of its mesh; 0 if it is not generated.
struct Sized {
  Subject subject;
  double resolution_mm = 0;
};

// Compiles the scene at a resolution [mm], with a time step that is stable for it.
absl::StatusOr<Subject> AtResolution(const v1::CreateStudyRequest& request, const Compiler& compile, double mm) {
  v1::SceneSource source = request.source();
  source.set_resolution_mm(mm);
  return MakeSubject(source, request.preset(), request.parameters(), compile);
}

// Finds the resolution that gives `vertices`: their number is proportional to 1/resolution^2. It applies to all
// generated bodies, so that bones and tissue still meet.
absl::StatusOr<Sized> WithVertices(const v1::CreateStudyRequest& request, const Subject& subject, int vertices,
                                   const Compiler& compile) {
  Sized sized{.subject = subject, .resolution_mm = ResolutionOf(request, *subject.model)};
  for (int i = 0; i < kIterations; ++i) {
    const double ratio = static_cast<double>(sized.subject.model->report.simulated_vertices()) / vertices;
    if (std::abs(ratio - 1) < kTolerance) break;
    sized.resolution_mm *= std::sqrt(ratio);
    auto made = AtResolution(request, compile, sized.resolution_mm);
    if (!made.ok()) return made.status();
    sized.subject = *std::move(made);
  }
  return sized;
}

void AddRow(const ThesisSize& thesis, const Sized& sized, const Timing& with, const Timing& without,
            v1::CostTable& table) {
  v1::SizeRow& row = *table.add_sizes();
  row.set_what(thesis.what);
  AddTrials(thesis.what, with, table);
  AddTrials(absl::StrCat(thesis.what, ", without links"), without, table);
  if (sized.resolution_mm > 0) row.set_resolution_mm(sized.resolution_mm);
  row.set_vertices(with.subject.model->report.simulated_vertices());
  row.set_links(with.subject.model->report.rigid_links());
  row.set_steps_per_s(1 / Median(with.step_s));
  row.set_steps_per_s_without_links(1 / Median(without.step_s));
  row.set_links_cost_percent(100 * (MedianRatio(with, without) - 1));
  const std::vector<double> ratios = MedianRatioOfTrials(with, without);
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  row.set_links_cost_least_percent(100 * (*least - 1));
  row.set_links_cost_most_percent(100 * (*most - 1));
  row.set_thesis_vertices(thesis.vertices);
  if (thesis.links > 0) row.set_thesis_links(thesis.links);
  row.set_thesis_steps_per_s(thesis.with_links);
  row.set_thesis_steps_per_s_without_links(thesis.without_links);
  row.set_thesis_links_cost_percent(thesis.percent);
  row.set_thesis(thesis.vertices == kCubeVertices ? thesis.figure : "fig. 5.24, 5.27");
}

// The thesis' sizes that this scene can reproduce.
std::vector<ThesisSize> SizesFor(const Model& model) {
  std::vector<ThesisSize> sizes = LikeThesisSizes(model.scene, model.report.simulated_vertices());
  if (IsGenerated(model.scene) || sizes.size() < 2) return sizes;
  const auto vertices = static_cast<double>(model.report.simulated_vertices());
  return {*std::min_element(sizes.begin(), sizes.end(), [vertices](const ThesisSize& a, const ThesisSize& b) {
    return std::abs(std::log(vertices / a.vertices)) < std::abs(std::log(vertices / b.vertices));
  })};
}

// Estimates the time [s] to mesh size i: in proportion to the vertices, after the sizes before took `spent` [s]. 0 for
// the first.
double TimeToMesh(const std::vector<ThesisSize>& sizes, size_t i, double spent) {
  double vertices = 0;
  for (size_t before = 0; before < i; ++before) vertices += sizes[before].vertices;
  return vertices > 0 ? spent * sizes[i].vertices / vertices : 0;
}

// Compiles a subject anew each time: a compiler may keep a scene that it has seen.
std::function<absl::StatusOr<Subject>()> Again(const v1::CreateStudyRequest& request, const Subject& subject,
                                               const Compiler& compile) {
  return [&request, &compile, subject, scene = subject.model->scene]() mutable {
    scene.set_description(scene.description() + " Again.");
    return Recompile(request, subject, scene, compile);
  };
}

double Squared(double x) { return x * x; }

}  // namespace

absl::Status AddSizes(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                      CostBudget& budget, const Progress& progress, v1::CostTable& table) {
  if (subject.model->report.rigid_links() == 0) return absl::OkStatus();
  const std::vector<ThesisSize> sizes = SizesFor(*subject.model);
  std::vector<Sized> made;
  std::vector<Timing> timings;
  const double began = budget.spent();
  for (size_t i = 0; i < sizes.size(); ++i) {
    const double takes = TimeToMesh(sizes, i, budget.spent() - began);
    if (takes > budget.LeftUntil(kMeshedUntil)) {
      budget.Cut(absl::StrCat("meshes of figures 5.14-5.27 from ", sizes[i].vertices, " vertices are left out"), takes);
      break;
    }
    const double done = kSizesCompiled * static_cast<double>(i) / static_cast<double>(sizes.size());
    if (!progress(done, "meshing for figures 5.14-5.27")) return Cancelled();
    absl::StatusOr<Sized> sized = Sized{.subject = subject, .resolution_mm = 0};
    if (IsGenerated(subject.model->scene)) sized = WithVertices(request, subject, sizes[i].vertices, compile);
    if (!sized.ok()) return sized.status();
    const auto without = Recompile(request, sized->subject, Without(sized->subject.model->scene, "links"), compile);
    if (!without.ok()) return without.status();
    const int steps = sizes[i].vertices == kCubeVertices ? kCubeSteps : request.cost().steps();
    for (const Subject& timed : {sized->subject, *without}) {
      timings.push_back({.subject = timed, .again = {}, .steps = steps, .step_s = {}, .part_s = {}, .problem = ""});
      if (sizes[i].vertices == kCubeVertices) timings.back().again = Again(request, timed, compile);
    }
    made.push_back(*std::move(sized));
  }
  absl::Status status =
      TimeInterleaved(timings, request.cost().trials(), budget.LeftUntil(kTimedUntil),
                      "sizes of figures 5.10 and 5.14-5.27", budget, Part(progress, kSizesCompiled, 1));
  if (!status.ok()) return status;
  for (size_t i = 0; i < made.size(); ++i) AddRow(sizes[i], made[i], timings[2 * i], timings[2 * i + 1], table);
  return absl::OkStatus();
}

double FitExponent(const std::vector<double>& vertices, const std::vector<double>& costs) {
  double x = 0, y = 0, squares = 0, products = 0;
  const auto n = static_cast<double>(vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    x += std::log(vertices[i]) / n;
    y += std::log(costs[i]) / n;
  }
  for (size_t i = 0; i < vertices.size(); ++i) {
    squares += Squared(std::log(vertices[i]) - x);
    products += (std::log(vertices[i]) - x) * (std::log(costs[i]) - y);
  }
  return squares > 0 ? products / squares : 0;
}

}  // namespace phrenic::study
