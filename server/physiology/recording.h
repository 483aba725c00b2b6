// One measured breath of a thorax.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_RECORDING_H_
#define PHRENIC_SERVER_PHYSIOLOGY_RECORDING_H_

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "server/physiology/columns.h"
#include "server/physiology/fibres.h"
#include "server/physiology/flaws.h"
#include "server/physiology/parts.h"

namespace phrenic::physiology {

// A model with all that measures of it need. Refers to the model. Immutable, thread-safe.
class Subject {
 public:
  // FAILED_PRECONDITION if no deformable body is a diaphragm.
  static absl::StatusOr<std::unique_ptr<const Subject>> Of(const Model& model);

  const Model& model;
  const Parts parts;
  const Columns columns;
  const Fibres fibres;
  const FlawFinder flaws;

 private:
  Subject(const Model& of, Parts found);
};

// What is read in the course of a breath.
enum Quantity {
  kVolume,              // of the lungs [m^3]
  kFlow,                // into the lungs [m^3/s]
  kPleural,             // mean of both sides [Pa]
  kAbdominal,           // [Pa]
  kTransdiaphragmatic,  // [Pa]
  kDisplaced,           // volume displaced by the abdominal wall [m^3]
  kRightApex,           // heights of the columns [m], in the order of Columns::Column
  kRightBack,
  kLeftApex,
  kLeftBack,
  kLowerRibs,  // outward displacement of ribs 7 to 10 [m]
  kRightRibs,  // of ribs 4 to 7 of one side [m]
  kLeftRibs,
  kQuantities
};

// The last of several breaths, so that it begins where breaths of this kind end.
struct Recording {
  const Subject* subject = nullptr;
  std::string breath;
  v1::Parameters parameters;                        // of the breath
  std::vector<double> time;                         // from the beginning of the measured breath [s]
  std::array<std::vector<double>, kQuantities> of;  // kNone where the scene lacks it
  size_t peak_sample = 0;  // of the greatest lung volume; without one, of the greatest signal of the breath
  State base, peak;        // at the beginning of the breath, and at that sample
  FlawValues flaws = {};   // the greatest of ten moments
  std::array<double, kFlaws> flaw_time = {};  // when [s]
  std::string problem;                        // why the breath could not be finished; empty if it was
};

// Whether crossings, pierced sheets and hollows are looked for. Without, flaws are kNone, and a breath takes half as
// long.
enum class FlawSearch { kAtTenMoments, kNever };

// Called with each sample of the measured breath: the time from its beginning [s], and the moment.
using EachSample = std::function<void(double time, const EvalContext& at)>;

// Breathes with the parameters, every field set. Before the measured breath come those that let it settle: one, and at
// least 4 s, if the scene has pressures. CANCELLED if `progress`, which gets 0 to 1, returns false. A breath that
// diverges has a problem.
absl::StatusOr<Recording> Record(const Subject& subject, const std::string& breath, const v1::Parameters& parameters,
                                 absl::FunctionRef<bool(double)> progress,
                                 FlawSearch search = FlawSearch::kAtTenMoments, const EachSample& each = nullptr);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_RECORDING_H_
