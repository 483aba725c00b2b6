#include "client/print/watch_printer.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/print/live_view.h"
#include "client/print/output.h"
#include "client/print/print_session.h"
#include "client/print/readings.h"
#include "client/print/table.h"
#include "client/terminal/terminal.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

// "  predicted: 12912 bytes within 0.1 mm, 4 ms old"; empty if the frame has no vertices.
std::string SendingText(const v1::Frame& frame) {
  if (frame.positions().empty()) return "";
  const std::string name = absl::AsciiStrToLower(v1::Codec_Name(frame.codec()).substr(sizeof "CODEC_" - 1));
  const double age = absl::ToDoubleMilliseconds(absl::Now() - absl::FromUnixNanos(frame.unix_nanos()));
  return absl::StrFormat("  %s: %d bytes within %g mm, %.0f ms old", name, frame.positions().size(),
                         frame.max_error_mm(), age);
}

// "t 1.250 s  tick 2500  breath 0.500  right dome -0.1 -0.4 -9.2 mm  lung volume 2.513 l".
std::string FrameLine(const v1::Frame& frame) {
  std::string line = absl::StrFormat("t %.3f s  tick %d  breath %.3f", frame.time(), frame.tick(), frame.breath());
  for (const v1::ProbeReading& probe : frame.probes()) {
    absl::StrAppendFormat(&line, "  %s %.1f %.1f %.1f mm", probe.name(), 1e3 * probe.dx(), 1e3 * probe.dy(),
                          1e3 * probe.dz());
  }
  for (const v1::MeasureReading& reading : frame.measures()) {
    absl::StrAppendFormat(&line, "  %s %s", reading.name(), ReadingText(reading.value(), reading.unit()));
  }
  return line + SendingText(frame);
}

class JsonPrinter final : public WatchPrinter {
 public:
  void Print(const v1::WatchFramesResponse& event) override { std::cout << Json(event) << std::endl; }
};

// SI units, all digits. The first frame determines the header.
class CsvPrinter final : public WatchPrinter {
 public:
  void Print(const v1::WatchFramesResponse& event) override {
    if (!event.has_frame()) return;
    const v1::Frame& frame = event.frame();
    std::vector<std::string> names = {"time [s]", "tick", "breath"};
    std::vector<std::string> cells = {schema::FormatNumber(frame.time()), absl::StrCat(frame.tick()),
                                      schema::FormatNumber(frame.breath())};
    for (const v1::ProbeReading& probe : frame.probes()) {
      for (const char* axis : {"dx", "dy", "dz"}) names.push_back(absl::StrCat(probe.name(), " ", axis, " [m]"));
      for (const double value : {probe.dx(), probe.dy(), probe.dz()}) cells.push_back(schema::FormatNumber(value));
    }
    for (const v1::MeasureReading& reading : frame.measures()) {
      names.push_back(absl::StrCat(reading.name(), " [", reading.unit(), "]"));
      cells.push_back(schema::FormatNumber(reading.value()));
    }
    if (!has_header_) PrintCsvLine(names, std::cout);
    has_header_ = true;
    PrintCsvLine(cells, std::cout);
    std::cout << std::flush;
  }

 private:
  bool has_header_ = false;
};

class LinePrinter final : public WatchPrinter {
 public:
  void Print(const v1::WatchFramesResponse& event) override {
    if (event.has_frame()) {
      std::cout << FrameLine(event.frame()) << residual_ << std::endl;
      return;
    }
    const v1::Session& session = event.session();
    if (std::exchange(warned_, session.warnings_size() > 0) != warned_) {
      std::cerr << WarningLines(session.warnings(), "phrenic: ");
    }
    residual_ = SolverText(session, "  solver: ", "") + ResidualText(session, "  constraints within ", "");
    if (session.revision() == revision_) return;
    revision_ = session.revision();
    PrintSession(session, std::cout);
  }

 private:
  std::int64_t revision_ = -1;
  bool warned_ = false;
  std::string residual_;  // at most about a second old
};

// Draws each picture over the one before. The terminal's width may change in between.
class LivePrinter final : public WatchPrinter {
 public:
  void Print(const v1::WatchFramesResponse& event) override {
    if (!event.has_frame()) {
      view_.Add(event.session());
      return;
    }
    view_.Add(event.frame());
    std::vector<std::string> lines = view_.Lines({WidthOf(STDOUT_FILENO) - 1, ShowsUnicode()});
    // Lines that scrolled off the top of the terminal cannot be overwritten.
    lines.resize(std::min(lines.size(), static_cast<size_t>(std::max(2, HeightOf(STDOUT_FILENO) - 1))));
    std::string picture = drawn_ > 0 ? absl::StrFormat("\x1b[%dA", drawn_) : "";
    for (size_t i = 0; i < lines.size(); ++i) {
      picture += "\r" + (i == 0 ? Painted(lines[i], Ink::kBold, STDOUT_FILENO) : lines[i]) + "\x1b[K\n";
    }
    std::cout << picture << "\x1b[J" << std::flush;
    drawn_ = static_cast<int>(lines.size());
  }

  void Detach() override { drawn_ = 0; }

 private:
  LiveView view_;
  int drawn_ = 0;
};

}  // namespace

std::unique_ptr<WatchPrinter> MakeWatchPrinter(const Context& context) {
  if (context.json()) return std::make_unique<JsonPrinter>();
  if (context.output == Output::kCsv) return std::make_unique<CsvPrinter>();
  if (IsTerminal(STDOUT_FILENO)) return std::make_unique<LivePrinter>();
  return std::make_unique<LinePrinter>();
}

}  // namespace phrenic::client
