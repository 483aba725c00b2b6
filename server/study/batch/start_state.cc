#include "server/study/batch/start_state.h"

#include <cstring>

#include "absl/strings/str_cat.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic::study {
namespace {

constexpr double kLatest = 1e9;  // [s], [breaths]

absl::Status Invalid(const std::string& path, std::string_view field, std::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat(path, ".", std::string(field), ": ", std::string(what)));
}

// Copies float64 numbers.
template <class Array>
absl::Status Copy(const std::string& bytes, const std::string& path, std::string_view field, double bound, Array& to) {
  const auto wanted = sizeof(double) * static_cast<size_t>(to.size());
  if (bytes.size() != wanted) {
    return Invalid(path, field, absl::StrCat("has ", bytes.size(), " bytes; a state of the scene has ", wanted));
  }
  if (wanted == 0) return absl::OkStatus();
  std::memcpy(to.data(), bytes.data(), wanted);
  if (to.allFinite() && to.cwiseAbs().maxCoeff() <= bound) return absl::OkStatus();
  return Invalid(path, field, absl::StrCat("a number is not finite or beyond ", bound));
}

}  // namespace

absl::StatusOr<State> StartState(const Model& model, const v1::Parameters& parameters, const v1::StateArrays& arrays,
                                 const std::string& path) {
  State state = model.InitialState();
  if (!(arrays.tick() >= 0)) return Invalid(path, "tick", "is below 0");
  if (!(arrays.time() >= 0 && arrays.time() <= kLatest)) return Invalid(path, "time", "is not within 0 to 1e9 s");
  if (!(arrays.phase() >= 0 && arrays.phase() <= kLatest))
    return Invalid(path, "phase", "is not within 0 to 1e9 breaths");
  state.tick = arrays.tick();
  state.time = arrays.time();
  state.phase = arrays.phase();
  constexpr double kAny = std::numeric_limits<double>::max();
  for (const absl::Status& status : {Copy(arrays.positions(), path, "positions", model.bound, state.x),
                                     Copy(arrays.velocities(), path, "velocities", kAny, state.v),
                                     Copy(arrays.scalars(), path, "scalars", kAny, state.scalars.q),
                                     Copy(arrays.scalar_rates(), path, "scalar_rates", kAny, state.scalars.v)}) {
    if (!status.ok()) return status;
  }
  const Workspace work = model.MakeWorkspace();
  model.plan->DriveMotions(parameters, 0, work.scratch, state);
  return state;
}

}  // namespace phrenic::study
