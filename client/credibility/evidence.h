// The numbers that a credibility report judges: each with its name, unit, source and the command that makes it again.
#ifndef PHRENIC_CLIENT_CREDIBILITY_EVIDENCE_H_
#define PHRENIC_CLIENT_CREDIBILITY_EVIDENCE_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/credibility.pb.h"
#include "phrenic/v1/study_results.pb.h"

namespace phrenic::client {

// What was run, or found in files. Absent parts were neither run nor found.
struct Evidence {
  std::optional<v1::SensitivityTable> sensitivity;
  std::optional<v1::UncertaintyTable> uncertainty;
  std::optional<v1::ConvergenceTable> convergence;
  std::optional<v1::PhysiologyTable> physiology;
  std::vector<v1::OrderRow> orders;
  std::vector<v1::ExactCaseRow> exact_cases;
  std::vector<v1::NumberRow> numbers;        // of cases and of the context's own evidence
  std::vector<std::string> absent;           // why something was not run: "uncertainty: the budget was used up"
  std::string scene, scene_hash;             // of the compile report
  std::vector<std::string> of_other_scenes;  // evidence whose hash is another: "uncertainty, scene 1a2b..."
  std::vector<std::string> without_hash;     // evidence in files that do not say of which scene they are
  std::vector<v1::VersionRow> versions;
};

// The command that makes each kind of evidence again.
struct EvidenceCommands {
  std::string sensitivity, uncertainty, convergence, physiology, orders, exact;
};

// Returns every number: those of `evidence.numbers`, and
//   exact.cases, exact.passed_percent; orders.judged, orders.passed_percent;
//   physiology.health.inside_percent, physiology.changes.inside_percent, "physiology.BREATH: WHAT";
//   convergence.time_step_percent, .mesh_percent, .integrator_percent: the largest change of an output, of the finest
//   step; convergence.failed; sensitivity.failed, "sensitivity.OUTPUT.predicted_percent",
//   "sensitivity.OUTPUT.INPUT.total_percent"; uncertainty.failed, "uncertainty.OUTPUT.p5", .p50, .p95,
//   .width_percent: p95 - p5 over the size of p50.
std::vector<v1::NumberRow> NumbersOf(const Evidence& evidence, const EvidenceCommands& commands);

// Returns the cases of a GoogleTest result (--gtest_output=json:FILE). INVALID_ARGUMENT names the file.
absl::StatusOr<std::vector<v1::ExactCaseRow>> ParseExactCases(const std::string& file, const std::string& text);

// Returns the measured order of each integrator at its smallest step that converged, against its own order within 0.2;
// one that converges faster passes too.
std::vector<v1::OrderRow> OrdersOf(const v1::ErrorTable& table);

// Returns the number at an RFC 6901 pointer. INVALID_ARGUMENT names the file and what is wrong.
absl::StatusOr<double> NumberInJson(const std::string& file, const std::string& text, const std::string& pointer);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CREDIBILITY_EVIDENCE_H_
