#include "server/study/stability.h"

#include "absl/strings/str_format.h"
#include "server/study/extremes.h"
#include "server/study/stability_limits.h"
#include "server/study/stability_map.h"
#include "server/study/subject.h"

namespace phrenic::study {
namespace {

// Fractions of the study's progress at which its parts end.
constexpr double kLimitsEnd = 0.3;
constexpr double kMapEnd = 0.8;

absl::Status AddLimits(const Subject& subject, const v1::StabilityStudy& study, const Progress& progress,
                       v1::StabilityTable& table) {
  const std::vector<double> factors = StiffnessFactors(study.stiffest());
  const std::vector<v1::Integrator> integrators = IntegratorsFor(study.integrators());
  const auto all = static_cast<double>(factors.size() * integrators.size());
  double done = 0;
  for (const double factor : factors) {
    for (const v1::Integrator integrator : integrators) {
      v1::LimitRow& row = *table.add_limits();
      row.set_integrator(NameOf(integrator));
      row.set_stiffness(factor);
      const Subject part = With(Stiffened(subject, factor), integrator);
      absl::Status status = MeasureLimit(part, study.seconds(), study.most_seconds_a_run(),
                                         Part(progress, done / all, (done + 1) / all), row);
      if (!status.ok()) return status;
      ++done;
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::StabilityTable> StudyStability(const v1::CreateStudyRequest& request, const Subject& subject,
                                                  const Progress& progress) {
  const v1::StabilityStudy& study = request.stability();
  v1::StabilityTable table;
  if (absl::Status status = AddLimits(subject, study, Part(progress, 0, kLimitsEnd), table); !status.ok()) {
    return status;
  }
  const double map_end = study.leave_out_extremes() ? 1 : kMapEnd;
  if (absl::Status status = AddMap(subject, study, Part(progress, kLimitsEnd, map_end), table); !status.ok()) {
    return status;
  }
  if (study.leave_out_extremes()) return table;
  if (absl::Status status = AddExtremes(study, Part(progress, kMapEnd, 1), table); !status.ok()) return status;
  return table;
}

}  // namespace phrenic::study
