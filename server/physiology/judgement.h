// From recorded breaths to the rows of a table.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_JUDGEMENT_H_
#define PHRENIC_SERVER_PHYSIOLOGY_JUDGEMENT_H_

#include <span>
#include <string>
#include <vector>

#include "phrenic/v1/physiology.pb.h"
#include "server/physiology/rows.h"

namespace phrenic::physiology {

// Adds the rows of these presets (none: all), and those of flaws over all recordings.
void AddRows(const Subject& subject, const std::vector<Recording>& recordings, std::span<const std::string> presets,
             v1::PhysiologyTable& table);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_JUDGEMENT_H_
