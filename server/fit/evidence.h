// Measured data of a person: files of several kinds, each with its error.
#ifndef PHRENIC_SERVER_FIT_EVIDENCE_H_
#define PHRENIC_SERVER_FIT_EVIDENCE_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fit/landmarks.h"
#include "server/fit/markers.h"
#include "server/fit/residuals.h"
#include "server/fit/sides.h"
#include "server/fit/surface_residuals.h"
#include "server/fit/traces.h"

namespace phrenic::fit {

enum class Measured { kLandmarks, kExhale, kDiaphragm, kLungs, kVolume, kMMode, kMarkers };

// A file as it is given.
struct MeasuredFile {
  Measured measured = Measured::kLandmarks;
  std::string name;  // for messages; the ending gives the format
  std::string bytes;
  std::optional<double> phase;  // of landmarks
  Side side = kRight;           // of an M-mode
  bool at_exhale = false;       // a surface at end exhale instead of end inhale
  std::optional<double> error;  // standard deviation of a datum [mm], [l]; left out: the kind's
};

// The kinds' standard errors, where none is given:
//   landmarks 1.5 mm an axis (matching of CT 1.2 mm, and what 8 to 12 numbers leave: README);
//   surfaces 6 mm, of which most is the template's shape (README: a registered lung's), 2.5 mm with the shape at rest;
//   volume 0.05 l (a spirometer's 3 % or 50 ml: ATS/ERS standard, Am J Respir Crit Care Med 200, 2019);
//   M-mode 2 mm (repeated readings: Boussuges et al., Chest 135, 2009);
//   markers 4 mm (skin over ribs and fat).
double DefaultError(Measured measured, bool with_exhale);  // [m], [m^3]

struct Evidence {
  struct SurfaceFile {
    KindOfData kind;
    BreathSurfaces surfaces;
  };
  struct TraceFile {
    KindOfData kind;
    TracedBreaths breaths;
    Traced traced;
    Side side;  // of a displacement
  };
  struct MarkerFile {
    KindOfData kind;
    Markers markers;
  };

  KindOfData landmarks_kind;
  Landmarks landmarks = {Points(3, 0), Points(3, 0)};  // of all phases
  Points exhale = Points(3, 0);                        // that show the lungs' shape
  std::vector<SurfaceFile> surfaces;
  std::vector<TraceFile> traces;
  std::vector<MarkerFile> markers;
};

// Returns "landmarks", "m-mode": the kind's name in options and output.
std::string_view NameOf(Measured measured);

// Parses the files. Of landmarks: files of pairs, or two files of points, of end exhale and of end inhale. A surface at
// end exhale belongs to the one at end inhale of the same kind. INVALID_ARGUMENT names the file and its line, or what
// is missing. Thread-safe.
absl::StatusOr<Evidence> ParseEvidence(const std::vector<MeasuredFile>& files);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_EVIDENCE_H_
