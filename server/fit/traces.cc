#include "server/fit/traces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/fit/csv_table.h"
#include "server/fit/sides.h"

namespace phrenic::fit {
namespace {

constexpr double kSmoothing = 0.2;   // [s] of the moving mean by which breaths are found
constexpr double kHysteresis = 0.2;  // of the depth, about the middle
constexpr Eigen::Index kMostUsed = 4000;
constexpr double kLeastOfExtent = 1e-6;  // that breaths are of a recording's extent

struct RawTrace {
  std::vector<double> time, value;  // [s], [l] or [mm]
};

// What a recording is called and how deep people's breaths are.
struct TracedUnit {
  const char* column;
  const char* unit;
  double si;           // per unit
  double least, most;  // depth, in the unit
  double doubtful;     // below it
  const char* remedy;  // for breaths that are too shallow or doubtful
  const char* deep;    // for breaths that are too deep
};

TracedUnit UnitOfTrace(Traced traced) {
  if (traced == Traced::kVolume) {
    return {"volume_l",
            "l",
            1e-3,
            0.02,
            8,
            0.1,
            "if it is in m^3, multiply it by 1000",
            "if it is in ml, call its column volume_ml"};
  }
  return {"displacement_mm",
          "mm",
          1e-3,
          0.3,
          150,
          4,
          "if it is in cm, call its column displacement_cm; if in m, "
          "multiply it by 1000",
          "if it is in um, divide it by 1000"};
}

// A column and the factor to the unit of TracedUnit.
struct ScaledColumn {
  int column = -1;
  double scale = 1;
};

ScaledColumn FindScaled(const CsvTable& table, std::initializer_list<std::string_view> plain, std::string_view other,
                        double scale) {
  const int column = table.Find(plain);
  if (column >= 0) return {column, 1};
  return {table.Find({other}), scale};
}

absl::StatusOr<RawTrace> ReadRaw(Traced traced, std::string_view name, std::string_view bytes) {
  CsvTable table(name, bytes);
  if (absl::Status status = table.ReadHeader(); !status.ok()) return status;
  const ScaledColumn time = FindScaled(table, {"time_s", "time"}, "time_ms", 1e-3);
  const ScaledColumn value = traced == Traced::kVolume
                                 ? FindScaled(table, {"volume_l", "volume"}, "volume_ml", 1e-3)
                                 : FindScaled(table, {"displacement_mm", "displacement"}, "displacement_cm", 10);
  if (time.column < 0 || value.column < 0) {
    return table.Error(absl::StrCat("the first line must name the columns time_s and ", UnitOfTrace(traced).column));
  }
  RawTrace raw;
  while (table.Next()) {
    double t = 0, v = 0;
    if (absl::Status status = table.Read(time.column, t); !status.ok()) return status;
    if (absl::Status status = table.Read(value.column, v); !status.ok()) return status;
    if (std::abs(t) > 1e9 || std::abs(v) > 1e9) return table.Error("a number is larger than 1e9: check its unit");
    if (!raw.time.empty() && !(t * time.scale > raw.time.back())) {
      return table.Error("the times must ascend: sort the lines, and leave out those of the same time");
    }
    if (raw.time.size() == kMostTraceSamples) {
      return table.Error(absl::StrCat("more than ", kMostTraceSamples, " samples: keep every tenth"));
    }
    raw.time.push_back(t * time.scale);
    raw.value.push_back(v * value.scale);
  }
  return raw;
}

// Subtracts the line of least squares through the samples.
std::vector<double> WithoutTrend(const RawTrace& raw) {
  const auto n = static_cast<Eigen::Index>(raw.time.size());
  const Eigen::Map<const Eigen::ArrayXd> time(raw.time.data(), n), value(raw.value.data(), n);
  const Eigen::ArrayXd t = time - time.mean();
  const double slope = (t * value).sum() / std::max(t.square().sum(), 1e-30);
  const Eigen::ArrayXd flat = value - value.mean() - slope * t;
  return {flat.begin(), flat.end()};
}

double ExtentOf(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

// Returns the mean over a window about each sample.
std::vector<double> Smoothed(const std::vector<double>& time, const std::vector<double>& value) {
  std::vector<double> smooth(value.size());
  size_t first = 0, end = 0;
  double sum = 0;
  for (size_t i = 0; i < value.size(); ++i) {
    while (end < value.size() && time[end] <= time[i] + kSmoothing / 2) sum += value[end++];
    while (time[first] < time[i] - kSmoothing / 2) sum -= value[first++];
    smooth[i] = sum / static_cast<double>(end - first);
  }
  return smooth;
}

// Returns the times at which the samples cross their middle upwards, from well below to well above it.
std::vector<double> UpCrossings(const std::vector<double>& time, const std::vector<double>& value) {
  const double low = Quantile(value, 0.05), high = Quantile(value, 0.95), middle = (low + high) / 2;
  const double band = kHysteresis * (high - low);
  std::vector<double> crossings;
  bool below = false;
  double at = 0;  // the last crossing of the middle
  for (size_t i = 0; i < value.size(); ++i) {
    if (i > 0 && value[i - 1] <= middle && value[i] > middle) {
      at = time[i - 1] + (time[i] - time[i - 1]) * (middle - value[i - 1]) / (value[i] - value[i - 1]);
    }
    if (value[i] < middle - band) below = true;
    if (!below || value[i] <= middle + band) continue;
    crossings.push_back(at);
    below = false;
  }
  return crossings;
}

// The ends of the expirations: one before each crossing, and one after the last.
struct Troughs {
  std::vector<double> time, value;
  double At(double t) const {
    if (t <= time.front()) return value.front();
    if (t >= time.back()) return value.back();
    const auto k = static_cast<size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin());
    return value[k - 1] + (value[k] - value[k - 1]) * (t - time[k - 1]) / (time[k] - time[k - 1]);
  }
};

Troughs FindTroughs(const RawTrace& raw, const std::vector<double>& crossings) {
  const std::vector<double> smooth = Smoothed(raw.time, raw.value);
  Troughs troughs;
  size_t i = 0;
  for (size_t k = 0; k <= crossings.size(); ++k) {
    const double end = k < crossings.size() ? crossings[k] : raw.time.back();
    size_t lowest = i;
    for (; i < raw.time.size() && raw.time[i] <= end; ++i) {
      if (smooth[i] < smooth[lowest]) lowest = i;
    }
    // The part before the first crossing and that after the last may hold no end of an expiration.
    const bool whole = k > 0 && k < crossings.size();
    if (lowest >= raw.time.size() || (!whole && (lowest == 0 || lowest + 1 == raw.time.size()))) continue;
    if (!troughs.time.empty() && raw.time[lowest] <= troughs.time.back()) continue;
    troughs.time.push_back(raw.time[lowest]);
    troughs.value.push_back(smooth[lowest]);
  }
  return troughs;
}

// Sets phase and value of the samples in whole breaths, at most kMostUsed of them, evenly chosen. Returns how many
// there are.
Eigen::Index AddSamples(const RawTrace& raw, const std::vector<double>& crossings, const Troughs& troughs, double si,
                        TracedBreaths& breaths) {
  std::vector<double> phase, value;
  std::vector<int> breath;
  size_t k = 0;
  for (size_t i = 0; i < raw.time.size(); ++i) {
    const double t = raw.time[i];
    if (t < crossings.front() || t >= crossings.back()) continue;
    while (t >= crossings[k + 1]) ++k;
    phase.push_back((t - crossings[k]) / (crossings[k + 1] - crossings[k]));
    value.push_back(si * (raw.value[i] - troughs.At(t)));
    breath.push_back(static_cast<int>(k));
  }
  const auto count = static_cast<Eigen::Index>(phase.size()), used = std::min(count, kMostUsed);
  breaths.phase.resize(used);
  breaths.value.resize(used);
  breaths.breath.resize(used);
  for (Eigen::Index i = 0; i < used; ++i) {
    breaths.phase[i] = phase[static_cast<size_t>(i * count / used)];
    breaths.value[i] = value[static_cast<size_t>(i * count / used)];
    breaths.breath[i] = breath[static_cast<size_t>(i * count / used)];
  }
  return count;
}

absl::Status CheckBreaths(Traced traced, std::string_view name, TracedBreaths& breaths) {
  const TracedUnit unit = UnitOfTrace(traced);
  const auto refuse = [&](const std::string& text) {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": ", text));
  };
  const double length = breaths.lengths.mean();
  if (!(length >= 0.5 && length <= 30)) {
    return refuse(
        absl::StrFormat("the breaths last %.3g s, people's 0.5 to 30 s: times must be in s (in ms, call the "
                        "column time_ms)",
                        length));
  }
  const std::vector<double> values(breaths.value.begin(), breaths.value.end());
  const double depth = (Quantile(values, 0.95) - Quantile(values, 0.05)) / unit.si;
  if (depth < unit.least || depth > unit.most) {
    return refuse(absl::StrFormat("the breaths are %.3g %s deep, people's %g to %g: %s", depth, unit.unit, unit.least,
                                  unit.most, depth > unit.most ? unit.deep : unit.remedy));
  }
  if (depth < unit.doubtful) {
    breaths.doubts.push_back(
        absl::StrFormat("%s: the breaths are only %.3g %s deep: %s", std::string(name), depth, unit.unit, unit.remedy));
  }
  return absl::OkStatus();
}

}  // namespace

std::vector<int> SamplesOf(const TracedBreaths& breaths, bool held_out) {
  constexpr int kParts = 16;  // of a single breath
  const int count = static_cast<int>(breaths.phase.size());
  const bool single = breaths.lengths.size() < 2;
  std::array<std::vector<int>, 2> samples;
  for (int i = 0; i < count; ++i) {
    const int block = single ? kParts * i / count : breaths.breath[i];
    samples[block % 2].push_back(i);
  }
  if (samples[0].empty()) std::swap(samples[0], samples[1]);
  return samples[held_out ? 1 : 0];
}

std::vector<int> BreathsOf(const TracedBreaths& breaths, bool held_out) {
  std::vector<int> of;
  for (int k = held_out ? 1 : 0; k < static_cast<int>(breaths.lengths.size()); k += 2) of.push_back(k);
  return of;
}

absl::StatusOr<TracedBreaths> ParseTrace(Traced traced, std::string_view name, std::string_view bytes) {
  const absl::StatusOr<RawTrace> raw = ReadRaw(traced, name, bytes);
  if (!raw.ok()) return raw.status();
  const auto none = absl::InvalidArgumentError(absl::StrCat(
      std::string(name), ": no whole breath is in it: record from before one inspiration to after the next"));
  if (raw->time.size() < 8) return none;
  const std::vector<double> flat = WithoutTrend(*raw);
  if (!(ExtentOf(flat) > kLeastOfExtent * ExtentOf(raw->value))) return none;  // a line
  const std::vector<double> crossings = UpCrossings(raw->time, Smoothed(raw->time, flat));
  if (crossings.size() < 2) return none;
  const Troughs troughs = FindTroughs(*raw, crossings);
  if (troughs.time.empty()) return none;
  TracedBreaths breaths;
  breaths.lengths.resize(static_cast<Eigen::Index>(crossings.size()) - 1);
  for (Eigen::Index k = 0; k < breaths.lengths.size(); ++k) {
    breaths.lengths[k] = crossings[static_cast<size_t>(k) + 1] - crossings[static_cast<size_t>(k)];
    if (!(breaths.lengths[k] > 0)) return none;
  }
  const Eigen::Index samples = AddSamples(*raw, crossings, troughs, UnitOfTrace(traced).si, breaths);
  if (samples < 8 * breaths.lengths.size()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s: %d samples of %d breaths do not show their shape: record 8 "
                        "samples a breath at least",
                        std::string(name), samples, breaths.lengths.size()));
  }
  if (absl::Status status = CheckBreaths(traced, name, breaths); !status.ok()) return status;
  return breaths;
}

}  // namespace phrenic::fit
