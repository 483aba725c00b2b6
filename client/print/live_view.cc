#include "client/print/live_view.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/print/print_session.h"
#include "client/print/readings.h"
#include "client/terminal/sparkline.h"
#include "client/terminal/terminal.h"

namespace phrenic::client {
namespace {

constexpr size_t kMostValues = 400;  // more than a terminal is wide
constexpr int kBar = 12, kSpace = 2, kShortestSparkline = 8;

std::string ValueText(double value, const std::string& unit) {
  return unit.empty() ? absl::StrFormat("%.3f", value) : ReadingText(value, unit);
}

std::string PadRight(const std::string& text, int width) {
  return text + std::string(std::max(0, width - ColumnsOf(text)), ' ');
}

}  // namespace

void LiveView::Put(size_t index, const std::string& name, const std::string& unit, double value) {
  if (index == rows_.size()) rows_.push_back({name, unit, value, value, {}});
  Row& row = rows_[index];
  row.least = std::min(row.least, value);
  row.greatest = std::max(row.greatest, value);
  row.values.push_back(value);
  if (row.values.size() > kMostValues) row.values.pop_front();
}

void LiveView::Add(const v1::Frame& frame) {
  if (frame.tick() < tick_) rows_.clear();  // the session was reset
  time_ = frame.time();
  tick_ = frame.tick();
  size_t index = 0;
  Put(index++, "breath", "", frame.breath());
  for (const v1::MeasureReading& reading : frame.measures()) {
    Put(index++, reading.name(), reading.unit(), reading.value());
  }
  for (const v1::ProbeReading& probe : frame.probes()) {
    Put(index++, probe.name(), "m", std::hypot(probe.dx(), probe.dy(), probe.dz()));
  }
}

std::string LiveView::Heading() const {
  std::string text =
      absl::StrFormat("%s  %s  t %.2f s  tick %d", session_.id(), StateName(session_.state()), time_, tick_);
  if (session_.pace().times_real_time() > 0) {
    absl::StrAppendFormat(&text, "  %.2f x real time", session_.pace().times_real_time());
  }
  return text + ResidualText(session_, "  constraints within ", "") + SolverText(session_, "  solver: ", "");
}

std::string LiveView::Line(const Row& row, int name_width, int value_width, const Canvas& canvas) const {
  const double value = row.values.back();
  std::string line = PadRight(row.name, name_width) + std::string(kSpace, ' ') +
                     PadRight(ValueText(value, row.unit), value_width) + std::string(kSpace, ' ');
  const int left = canvas.width - ColumnsOf(line);
  if (left < kBar) return Clipped(line, canvas.width);
  line += Bar(value, row.least, row.greatest, kBar, canvas.unicode);
  const int room = left - kBar - kSpace;
  if (room < kShortestSparkline) return line;
  const size_t shown = std::min(row.values.size(), static_cast<size_t>(room));
  const std::vector<double> last(row.values.end() - static_cast<std::ptrdiff_t>(shown), row.values.end());
  return line + std::string(kSpace, ' ') + Sparkline(last, row.least, row.greatest, canvas.unicode);
}

std::vector<std::string> LiveView::Lines(const Canvas& canvas) const {
  int name_width = 0, value_width = 0;
  for (const Row& row : rows_) {
    name_width = std::max(name_width, ColumnsOf(row.name));
    for (const double value : {row.least, row.greatest, row.values.back()}) {
      value_width = std::max(value_width, ColumnsOf(ValueText(value, row.unit)));
    }
  }
  std::vector<std::string> lines = {Clipped(Heading(), canvas.width)};
  for (const Row& row : rows_) lines.push_back(Line(row, name_width, value_width, canvas));
  return lines;
}

}  // namespace phrenic::client
