#include "server/mechanics/stability/largest_step.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "phrenic/v1/options.pb.h"
#include "server/mechanics/integrators/catalogue.h"
#include "server/mechanics/stability/spectrum.h"

namespace phrenic {
namespace {

constexpr double kSafety = 0.95;  // of the Lanczos estimate
constexpr double kChosen = 0.9;   // of the largest stable step

// Sums the stiffness of forces on one vertex.
class VertexStiffness final : public StiffnessSink {
 public:
  explicit VertexStiffness(int vertex) : vertex_(vertex) {}
  void Add(int i, int j, const Eigen::Matrix3d& block) override {
    if (i == vertex_ && j == vertex_) sum_ += block;
  }
  void AddSprings(std::span<const SpringStiffness> springs) override {
    for (const SpringStiffness& spring : springs) {
      if (spring.a == vertex_ || spring.b == vertex_) sum_ += spring.Block();
    }
  }
  void AddOuter(double scale, const Points& g) override { sum_ += scale * g.col(vertex_) * g.col(vertex_).transpose(); }
  double Size() const { return sum_.norm(); }

 private:
  const int vertex_;
  Eigen::Matrix3d sum_ = Eigen::Matrix3d::Zero();
};

std::string StiffestElementAt(const Model& model, const EvalContext& at, int vertex) {
  std::string name = "nothing";
  double largest = 0;
  for (const auto& force : model.forces) {
    VertexStiffness stiffness(vertex);
    force->AddStiffness(at, stiffness);
    force->AddLatentStiffness(at, stiffness);
    if (stiffness.Size() <= largest) continue;
    largest = stiffness.Size();
    name = force->name();
  }
  return name;
}

std::string Verdict(const Integrator& integrator, const Spectrum& spectrum, double limit) {
  if (limit == 0) {
    return absl::StrFormat("; %s is stable at no step here: least damping %.3g 1/s, lightest vertex %.3g kg",
                           std::string(integrator.name()), spectrum.least_damping_rate, spectrum.least_mass);
  }
  if (std::isinf(limit)) return absl::StrCat("; ", std::string(integrator.name()), " is stable at any step");
  return "";
}

// Three significant digits, downwards, and just what those digits read as: people see and type it.
double RoundDown(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::stod(absl::StrFormat("%.2e", std::floor(value / unit * (1 + 1e-12)) * unit));
}

}  // namespace

bool HaveSameStableStep(const v1::Parameters& a, const v1::Parameters& b) {
  return a.elasticity() == b.elasticity() && a.integrator() == b.integrator();
}

v1::StableStep StableStepOf(const Model& model, const v1::Parameters& parameters) {
  return HaveSameStableStep(parameters, model.parameters) ? model.report.stable_step()
                                                          : LargestStableStep(model, parameters);
}

double ChosenStep(const v1::StableStep& stable) {
  // Where no step is stable: a small one, so that it can be watched going wrong.
  const double limit = stable.seconds() > 0 ? stable.seconds() : 0.1 / stable.omega_max();
  return std::isinf(limit) ? kLongestStep : std::min(RoundDown(kChosen * limit), kLongestStep);
}

v1::StableStep LargestStableStep(const Model& model, const v1::Parameters& parameters) {
  v1::StableStep report;
  const State state = model.InitialState();
  const FastestMode fastest = FindFastestMode(model, parameters, state);
  const Integrator& integrator = FindIntegrator(parameters.integrator());
  const double limit = kSafety * integrator.MaxStep(fastest.spectrum);
  report.set_omega_max(fastest.spectrum.omega_max);
  const double largest_step =
      v1::Parameters::descriptor()->FindFieldByName("time_step")->options().GetExtension(v1::quantity).maximum();
  report.set_seconds(std::min(limit, largest_step));
  if (fastest.vertex < 0) {
    report.set_reason(limit > 0 ? "nothing in the scene vibrates: any step is stable"
                                : "nothing in the scene vibrates" + Verdict(integrator, fastest.spectrum, limit));
    return report;
  }
  const BodyModel& body = model.BodyOf(fastest.vertex);
  const std::string stiffest = StiffestElementAt(model, MakeEvalContext(model, parameters, state), fastest.vertex);
  report.set_reason(absl::StrFormat("fastest vibration %.3g rad/s at vertex %d of %s, by %s; damping %.3g 1/s%s",
                                    fastest.spectrum.omega_max, fastest.vertex - body.first_vertex, body.name, stiffest,
                                    fastest.spectrum.damping_rate, Verdict(integrator, fastest.spectrum, limit)));
  return report;
}

}  // namespace phrenic
