// Which breaths a table needs.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_PLAN_H_
#define PHRENIC_SERVER_PHYSIOLOGY_PLAN_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/physiology/rows.h"

namespace phrenic::physiology {

struct PlannedBreath {
  std::string name;
  v1::Parameters parameters;  // every field set
};

// True if the scene has what the row is measured on.
bool Has(const Subject& subject, Needs needs);
// "a force of type thorax_pressures", for the note of a row whose scene lacks it.
std::string NameOf(Needs needs);

// True if the row is of one of these presets; of any, if there are none.
bool IsChosen(const Row& row, std::span<const std::string> presets);

inline constexpr size_t kMostPresets = 256;  // in one table

// Returns each preset of the scene, or those chosen, the changed breaths that a row of theirs speaks of, and what they
// are compared with; each once. INVALID_ARGUMENT, with the scene's presets, if it has no preset of that name, or if
// these are more than kMostPresets.
absl::StatusOr<std::vector<PlannedBreath>> PlanBreaths(const Subject& subject, std::span<const std::string> presets);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_PLAN_H_
