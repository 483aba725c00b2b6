// The acceptance table: what is measured in which breath, and between which values it lies in people.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_ROWS_H_
#define PHRENIC_SERVER_PHYSIOLOGY_ROWS_H_

#include <span>

#include "phrenic/v1/scene.pb.h"
#include "server/physiology/measures.h"

namespace phrenic::physiology {

// A breath that is no preset of a scene, but a preset with parameters changed.
struct ChangedBreath {
  const char* name;
  const char* preset;
  const char* changes;  // text of v1::Parameters
};

// What a scene may lack.
enum class Needs { kSheet, kFibres, kWall, kBones, kLungs, kPressures };

// The size with which a range scales. The ranges are those of the adult, a man of 30 years and 1.75 m, and are
// multiplied by the ratio of the body's size to the adult's (schema/body_size.h). kLungs: total lung capacity.
enum class Follows { kNothing, kLength, kLungs, kInspired, kVital };

struct Row {
  const char* breath;
  const char* what;
  const char* unit;
  double low, high;  // equal: there is no published range
  BreathMeasure measure;
  Needs needs;
  const char* source;
  const char* other = "";  // the breath that it is compared with
  Follows follows = Follows::kNothing;
};

struct Range {
  double low, high;
};

// What holds in every breath: none of these may exceed the value.
struct FlawRow {
  Flaw flaw;
  const char* what;
  const char* unit;
  double scale;  // from SI to that unit
  double high;
  Needs needs;
};

std::span<const ChangedBreath> ChangedBreaths();
std::span<const Row> RowsOfHealth();
std::span<const Row> RowsOfChanges();
std::span<const FlawRow> FlawRows();

// Returns the range of a row for a body of this physique.
Range RangeFor(const Row& row, const v1::Physique& physique);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_ROWS_H_
