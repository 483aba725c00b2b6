#include "server/fit/evidence.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/fit/read_landmarks.h"

namespace phrenic::fit {
namespace {

constexpr double kLeastError = 1e-6, kMostError = 1e9;  // [mm], [l]

bool IsSurface(const MeasuredFile& file) {
  return file.measured == Measured::kDiaphragm || file.measured == Measured::kLungs;
}

absl::Status Refusal(const MeasuredFile& file, const std::string& text) {
  return absl::InvalidArgumentError(absl::StrCat(file.name, ": ", text));
}

absl::Status CheckFile(const MeasuredFile& file) {
  if (file.error && !(*file.error >= kLeastError && *file.error <= kMostError)) {
    return Refusal(file, absl::StrCat("its error must be between ", kLeastError, " and ", kMostError, " mm or l"));
  }
  if (file.phase && !(*file.phase > 0 && *file.phase < 2)) {
    return Refusal(file, "its phase must be above 0 (end exhale) and below 2 (the next end exhale); 1 is end inhale");
  }
  if (file.phase && file.measured != Measured::kLandmarks) return Refusal(file, "only landmarks have a phase");
  return absl::OkStatus();
}

KindOfData KindFor(const MeasuredFile& file, bool with_exhale) {
  KindOfData kind = {
      std::string(NameOf(file.measured)),           file.name, file.measured == Measured::kVolume ? "l" : "mm", 1e-3, 0,
      file.measured == Measured::kLandmarks ? 3 : 1};
  kind.sd = file.error ? *file.error * kind.per_unit : DefaultError(file.measured, with_exhale);
  return kind;
}

// Appends pairs to those of other files.
void AppendPairs(const Landmarks& pairs, Landmarks& all) {
  const Eigen::Index before = all.size(), after = before + pairs.size();
  all.exhale.conservativeResize(3, after);
  all.motion.conservativeResize(3, after);
  all.phase.conservativeResize(after);
  all.exhale.rightCols(pairs.size()) = pairs.exhale;
  all.motion.rightCols(pairs.size()) = pairs.motion;
  all.phase.tail(pairs.size()) = pairs.phase;
}

absl::Status AddPairs(const MeasuredFile& file, Landmarks pairs, Evidence& evidence) {
  if (!pairs.paired()) {
    return Refusal(file,
                   "has no inhale points: add the columns inhale_x,inhale_y,inhale_z, or give points of end exhale "
                   "as --exhale");
  }
  if (pairs.phase.size() > 0 && file.phase) return Refusal(file, "has a column phase: leave the phase of the file out");
  if (pairs.phase.size() == 0) pairs.phase = Eigen::VectorXd::Constant(pairs.size(), file.phase.value_or(1));
  KindOfData kind = KindFor(file, false);
  if (evidence.landmarks.size() > 0 && kind.sd != evidence.landmarks_kind.sd) {
    return Refusal(file, "its error differs from that of other landmarks: give all landmarks one error");
  }
  if (evidence.landmarks.size() > 0) kind.source = absl::StrCat(evidence.landmarks_kind.source, ", ", kind.source);
  evidence.landmarks_kind = kind;
  AppendPairs(pairs, evidence.landmarks);
  return absl::OkStatus();
}

// Reads all landmarks: files of pairs, or two of points.
absl::Status AddLandmarkFiles(const std::vector<MeasuredFile>& files, Evidence& evidence) {
  std::vector<Landmarks> read;
  std::vector<const MeasuredFile*> own;
  for (const MeasuredFile& file : files) {
    if (file.measured != Measured::kLandmarks) continue;
    absl::StatusOr<Landmarks> landmarks = ParseLandmarks(file.name, file.bytes);
    if (!landmarks.ok()) return landmarks.status();
    read.push_back(*std::move(landmarks));
    own.push_back(&file);
  }
  if (read.size() == 2 && !read[0].paired() && !read[1].paired()) {
    absl::StatusOr<Landmarks> pairs = PairLandmarks(read[0], read[1]);
    if (!pairs.ok()) return pairs.status();
    return AddPairs(*own[1], *std::move(pairs), evidence);
  }
  for (size_t i = 0; i < read.size(); ++i) {
    if (absl::Status status = AddPairs(*own[i], std::move(read[i]), evidence); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status AddExhale(const MeasuredFile& file, Evidence& evidence) {
  const absl::StatusOr<Landmarks> points = ParseLandmarks(file.name, file.bytes);
  if (!points.ok()) return points.status();
  if (evidence.exhale.cols() > 0) return Refusal(file, "points at end exhale were given already: give one file");
  evidence.exhale = points->exhale;
  return absl::OkStatus();
}

absl::Status AddTraceFile(const MeasuredFile& file, Evidence& evidence) {
  const Traced traced = file.measured == Measured::kVolume ? Traced::kVolume : Traced::kDisplacement;
  absl::StatusOr<TracedBreaths> breaths = ParseTrace(traced, file.name, file.bytes);
  if (!breaths.ok()) return breaths.status();
  evidence.traces.push_back({KindFor(file, false), *std::move(breaths), traced, file.side});
  return absl::OkStatus();
}

absl::Status AddMarkerFile(const MeasuredFile& file, Evidence& evidence) {
  if (!evidence.markers.empty()) return Refusal(file, "markers were given already: put them into one file");
  absl::StatusOr<Markers> markers = ParseMarkers(file.name, file.bytes);
  if (!markers.ok()) return markers.status();
  evidence.markers.push_back({KindFor(file, false), *std::move(markers)});
  return absl::OkStatus();
}

const MeasuredFile* SurfaceAt(const std::vector<MeasuredFile>& files, Measured measured, bool at_exhale,
                              absl::Status& status) {
  const MeasuredFile* found = nullptr;
  for (const MeasuredFile& file : files) {
    if (file.measured != measured || file.at_exhale != at_exhale) continue;
    if (found != nullptr) status = Refusal(file, "a second surface of the same structure and time: give one file");
    found = &file;
  }
  return found;
}

absl::Status AddSurfaceFiles(const std::vector<MeasuredFile>& files, Measured measured, Evidence& evidence) {
  absl::Status status;
  const MeasuredFile* inhale = SurfaceAt(files, measured, false, status);
  const MeasuredFile* exhale = SurfaceAt(files, measured, true, status);
  if (!status.ok() || (inhale == nullptr && exhale == nullptr)) return status;
  if (inhale == nullptr) return Refusal(*exhale, "only the surface at end exhale: the one at end inhale is missing");
  absl::StatusOr<Mesh> moved = ParseBreathSurface(inhale->name, inhale->bytes);
  if (!moved.ok()) return moved.status();
  BreathSurfaces surfaces = {measured == Measured::kLungs ? SurfaceOf::kLungs : SurfaceOf::kDiaphragm,
                             *std::move(moved), std::nullopt};
  if (exhale != nullptr) {
    if (exhale->error && exhale->error != inhale->error) {
      return Refusal(*exhale, "its error differs from that of the surface at inhale: give it there");
    }
    absl::StatusOr<Mesh> rest = ParseBreathSurface(exhale->name, exhale->bytes);
    if (!rest.ok()) return rest.status();
    surfaces.exhale = *std::move(rest);
  }
  evidence.surfaces.push_back({KindFor(*inhale, exhale != nullptr), std::move(surfaces)});
  return absl::OkStatus();
}

absl::Status AddOther(const MeasuredFile& file, Evidence& evidence) {
  switch (file.measured) {
    case Measured::kExhale:
      return AddExhale(file, evidence);
    case Measured::kVolume:
    case Measured::kMMode:
      return AddTraceFile(file, evidence);
    case Measured::kMarkers:
      return AddMarkerFile(file, evidence);
    case Measured::kLandmarks:
    case Measured::kDiaphragm:
    case Measured::kLungs:
      return absl::OkStatus();
  }
  return absl::OkStatus();
}

}  // namespace

std::string_view NameOf(Measured measured) {
  constexpr std::string_view kNames[] = {"landmarks", "exhale", "surface", "lung-surface",
                                         "volume",    "m-mode", "markers"};
  return kNames[static_cast<int>(measured)];
}

double DefaultError(Measured measured, bool with_exhale) {
  switch (measured) {
    case Measured::kLandmarks:
    case Measured::kExhale:
      return 1.5e-3;
    case Measured::kDiaphragm:
    case Measured::kLungs:
      return with_exhale ? 2.5e-3 : 6e-3;
    case Measured::kVolume:
      return 5e-5;
    case Measured::kMMode:
      return 2e-3;
    case Measured::kMarkers:
      return 4e-3;
  }
  return 1;
}

absl::StatusOr<Evidence> ParseEvidence(const std::vector<MeasuredFile>& files) {
  Evidence evidence;
  evidence.landmarks.phase.resize(0);
  for (const MeasuredFile& file : files) {
    if (absl::Status status = CheckFile(file); !status.ok()) return status;
    if (file.at_exhale && !IsSurface(file)) return Refusal(file, "only surfaces are given at exhale or at inhale");
    if (absl::Status status = AddOther(file, evidence); !status.ok()) return status;
  }
  if (absl::Status status = AddLandmarkFiles(files, evidence); !status.ok()) return status;
  for (const Measured measured : {Measured::kDiaphragm, Measured::kLungs}) {
    if (absl::Status status = AddSurfaceFiles(files, measured, evidence); !status.ok()) return status;
  }
  return evidence;
}

}  // namespace phrenic::fit
