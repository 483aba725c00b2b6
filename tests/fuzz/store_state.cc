// Any bytes as a saved state give a state of the model, the same when it is saved again, from which every integrator
// steps or reports a divergence; or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/mechanics/compile/compile.h"
#include "server/mechanics/step/step.h"
#include "server/schema/schema.h"
#include "server/store/saved_state.h"
#include "tests/small_scenes.h"

namespace {

const phrenic::Model& Triangle() {
  static const auto& model =
      *new auto(*phrenic::Compile(*phrenic::schema::ParseScene("fuzz", phrenic::kTriangle),
                                  [](const phrenic::v1::Body&) { return absl::NotFoundError("reads no files"); }));
  return *model;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  phrenic::v1::SavedState saved;
  if (!saved.ParseFromArray(data, static_cast<int>(size))) return 0;
  const auto state = phrenic::store::Restore(Triangle(), saved);
  if (!state.ok()) {
    if (!absl::IsDataLoss(state.status())) std::abort();
    return 0;
  }
  const phrenic::v1::SavedState again = phrenic::store::Save(*state);
  if (again.positions() != saved.positions() || again.velocities() != saved.velocities()) std::abort();
  phrenic::v1::Parameters parameters = Triangle().parameters;
  for (int i = phrenic::v1::Integrator_MIN + 1; i <= phrenic::v1::Integrator_MAX; ++i) {
    if (!phrenic::v1::Integrator_IsValid(i)) continue;
    parameters.set_integrator(static_cast<phrenic::v1::Integrator>(i));
    phrenic::State copy = *state;
    phrenic::Workspace work = Triangle().MakeWorkspace();
    (void)phrenic::Step(Triangle(), parameters, 0.01, copy, work);
  }
  return 0;
}
