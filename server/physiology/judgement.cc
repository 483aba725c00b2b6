#include "server/physiology/judgement.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/physiology/plan.h"

namespace phrenic::physiology {
namespace {

using Recordings = std::vector<Recording>;

const Recording* Find(const Recordings& recordings, std::string_view breath) {
  for (const Recording& each : recordings) {
    if (each.breath == breath) return &each;
  }
  return nullptr;
}

void Refuse(std::string note, v1::Verdict verdict, v1::PhysiologyRow& row) {
  row.set_verdict(verdict);
  row.set_note(std::move(note));
}

void SetValue(double value, bool judged, v1::PhysiologyRow& row) {
  row.set_value(value);
  const bool inside = row.low() <= value && value <= row.high();
  row.set_verdict(!judged ? v1::VERDICT_NOT_JUDGED : inside ? v1::VERDICT_INSIDE : v1::VERDICT_OUTSIDE);
}

v1::PhysiologyRow Judge(const Row& check, const Subject& subject, const Recordings& recordings) {
  v1::PhysiologyRow row;
  row.set_breath(check.breath);
  row.set_what(check.what);
  row.set_unit(check.unit);
  const Range range = RangeFor(check, subject.model.scene.physique());
  row.set_low(range.low);
  row.set_high(range.high);
  row.set_source(check.source);
  const Recording *breath = Find(recordings, check.breath), *other = breath;
  if (*check.other != '\0') other = Find(recordings, check.other);
  if (!Has(subject, check.needs)) {
    Refuse(absl::StrCat("the scene has no ", NameOf(check.needs)), v1::VERDICT_NOT_MODELLED, row);
  } else if (breath == nullptr || other == nullptr) {
    Refuse("the scene has no preset for this breath", v1::VERDICT_NOT_MODELLED, row);
  } else if (!breath->problem.empty() || !other->problem.empty()) {
    Refuse(breath->problem.empty() ? other->problem : breath->problem, v1::VERDICT_OUTSIDE, row);
  } else if (const double value = check.measure(*breath, *other); std::isfinite(value)) {
    SetValue(value, check.low != check.high, row);
  } else {
    Refuse("there is nothing to measure: no part of the sheet is where the row looks", v1::VERDICT_OUTSIDE, row);
  }
  return row;
}

// The greatest value over all breaths; the note names those with more than is accepted.
v1::PhysiologyRow JudgeFlaw(const FlawRow& check, const Recordings& recordings) {
  v1::PhysiologyRow row;
  row.set_breath("every breath");
  row.set_what(check.what);
  row.set_unit(check.unit);
  row.set_high(check.high);
  row.set_source("no living diaphragm does");
  double worst = kNone;
  std::string note;
  for (const Recording& each : recordings) {
    const double value = check.scale * each.flaws[check.flaw];
    if (!std::isfinite(value)) continue;
    if (!(value <= worst)) worst = value;
    if (value <= check.high) continue;
    absl::StrAppend(&note, note.empty() ? "" : "; ", each.breath,
                    absl::StrFormat(": %.4g at %.2g s", value, each.flaw_time[check.flaw]));
  }
  if (std::isfinite(worst)) {
    SetValue(worst, true, row);
    row.set_note(note);
  } else {
    Refuse(absl::StrCat("the scene has no ", NameOf(check.needs), ", or its sheet is open"), v1::VERDICT_NOT_MODELLED,
           row);
  }
  return row;
}

}  // namespace

void AddRows(const Subject& subject, const Recordings& recordings, std::span<const std::string> presets,
             v1::PhysiologyTable& table) {
  for (const auto rows : {RowsOfHealth(), RowsOfChanges()}) {
    for (const Row& row : rows) {
      if (IsChosen(row, presets)) *table.add_rows() = Judge(row, subject, recordings);
    }
  }
  for (const FlawRow& row : FlawRows()) *table.add_rows() = JudgeFlaw(row, recordings);
}

}  // namespace phrenic::physiology
