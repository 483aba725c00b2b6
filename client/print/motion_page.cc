#include "client/print/motion_page.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"

namespace phrenic::client {
namespace {

constexpr int kWidth = 340, kHeight = 300, kLeft = 46, kBottom = 38, kTop = 10;  // of a plot [px]
constexpr size_t kMostDots = 500;
constexpr double kWorst = 6;  // error of the darkest dots [mm]

constexpr char kMotionPageHead[] =
    "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"
    "<title>Breathing motion</title><style>body{font:15px system-ui,sans-serif;margin:2rem;color:#1b1f24;"
    "max-width:60rem}table{border-collapse:collapse}th,td{padding:.25rem .6rem;border-bottom:1px solid "
    "#d5d9de;text-align:right}th{vertical-align:bottom}th:first-child,td:first-child{text-align:left}tr:last-child "
    "td{font-weight:600}figure{display:inline-block;margin:0 1rem 1rem 0}figcaption{max-width:340px;font-size:13px}"
    "svg text{font:11px system-ui,sans-serif;fill:#1b1f24}</style>\n";

std::string MotionPageText(const std::string& text) {
  return absl::StrReplaceAll(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

// The axes of a plot, in mm.
struct PlotAxes {
  double x0, x1, y0, y1;
  double X(double x) const { return kLeft + (kWidth - kLeft - 10) * (x - x0) / (x1 - x0); }
  double Y(double y) const { return kHeight - kBottom - (kHeight - kBottom - kTop) * (y - y0) / (y1 - y0); }
};

// Returns the distance between ticks: 1, 2 or 5 times a power of ten, for about five of them.
double TickStep(double extent) {
  const double power = std::pow(10, std::floor(std::log10(extent / 5)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (extent / (factor * power) <= 6) return factor * power;
  }
  return 10 * power;
}

std::string DrawAxes(const PlotAxes& axes, const char* across, const char* up) {
  std::string svg = absl::StrFormat("<svg width=%d height=%d role=img>", kWidth, kHeight);
  const double bottom = axes.Y(axes.y0), right = axes.X(axes.x1);
  absl::StrAppendFormat(&svg, "<path d='M%d %d V%.1f H%.1f' fill=none stroke=#8a929c />", kLeft, kTop, bottom, right);
  const double dx = TickStep(axes.x1 - axes.x0), dy = TickStep(axes.y1 - axes.y0);
  for (double x = std::ceil(axes.x0 / dx) * dx; x <= axes.x1; x += dx) {
    absl::StrAppendFormat(&svg, "<text x=%.1f y=%.1f text-anchor=middle>%g</text>", axes.X(x), bottom + 14, x + 0.0);
  }
  for (double y = std::ceil(axes.y0 / dy) * dy; y <= axes.y1; y += dy) {
    absl::StrAppendFormat(&svg, "<text x=%d y=%.1f text-anchor=end>%g</text>", kLeft - 4, axes.Y(y) + 4, y + 0.0);
  }
  absl::StrAppendFormat(&svg, "<text x=%.1f y=%d text-anchor=middle>%s</text>", (kLeft + right) / 2, kHeight - 6,
                        across);
  absl::StrAppendFormat(&svg, "<text transform='translate(12 %d) rotate(-90)' text-anchor=middle>%s</text>",
                        (kHeight - kBottom) / 2, up);
  return svg;
}

// Returns some of the held-out landmarks, evenly chosen.
std::vector<int> DotsOf(const fit::MotionFit& fit) {
  const std::vector<int>& all = fit.halves.held_out;
  const size_t step = all.size() / kMostDots + 1;
  std::vector<int> dots;
  for (size_t i = 0; i < all.size(); i += step) dots.push_back(all[i]);
  return dots;
}

std::string Dot(const PlotAxes& axes, double x, double y, const std::string& colour) {
  return absl::StrFormat("<circle cx=%.1f cy=%.1f r=2 fill='%s'/>", axes.X(x), axes.Y(y), colour);
}

PlotAxes Around(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const auto padded = [](double low, double high) { return 0.04 * (high - low) + 1e-3; };
  const double px = padded(x.minCoeff(), x.maxCoeff()), py = padded(y.minCoeff(), y.maxCoeff());
  return {x.minCoeff() - px, x.maxCoeff() + px, y.minCoeff() - py, y.maxCoeff() + py};
}

std::string HeightPlot(const fit::MotionFit& fit) {
  const Eigen::VectorXd down = -1000 * fit.motion.row(2).transpose(), height = 1000 * fit.exhale.row(2).transpose(),
                        fitted = -1000 * fit.predicted.row(2).transpose();
  const PlotAxes axes = Around(down, height);
  std::string svg = DrawAxes(axes, "motion downwards [mm]", "height z [mm]");
  for (const int i : DotsOf(fit)) absl::StrAppend(&svg, Dot(axes, down[i], height[i], "#b3bac2"));
  for (const int i : DotsOf(fit)) absl::StrAppend(&svg, Dot(axes, fitted[i], height[i], "#1f77b4"));
  return svg + "</svg>";
}

std::string SidePlot(const fit::MotionFit& fit) {
  const Eigen::VectorXd y = 1000 * fit.exhale.row(1).transpose(), height = 1000 * fit.exhale.row(2).transpose(),
                        error = 1000 * (fit.motion - fit.predicted).colwise().norm().transpose();
  const PlotAxes axes = Around(y, height);
  std::string svg = DrawAxes(axes, "front, y [mm], back", "height z [mm]");
  for (const int i : DotsOf(fit)) {
    const double share = std::min(1.0, error[i] / kWorst);
    absl::StrAppend(
        &svg, Dot(axes, y[i], height[i], absl::StrFormat("hsl(%.0f 80%% %.0f%%)", 210 - 200 * share, 78 - 35 * share)));
  }
  return svg + "</svg>";
}

std::string StudyRow(const std::string& name, const std::vector<double>& metres) {
  std::string row = absl::StrCat("<tr><td>", MotionPageText(name), "</td>");
  for (const double value : metres) absl::StrAppendFormat(&row, "<td>%.2f</td>", 1000 * value);
  return row + "</tr>\n";
}

std::string StudyTableOf(const fit::MotionStudy& study) {
  std::string html = "<table><thead><tr><th scope=col>person</th><th scope=col>descent</th>";
  for (const fit::Baseline& each : study.people.front().fit.baselines) {
    absl::StrAppend(&html, "<th scope=col>", each.name, "</th>");
  }
  absl::StrAppend(&html, "<th scope=col>elastic lungs, ", study.numbers,
                  " numbers</th><th scope=col>their p95</th><th scope=col>from one number</th></tr></thead>\n");
  std::vector<double> sum;
  for (const fit::StudiedPerson& person : study.people) {
    std::vector<double> row = {person.fit.descent};
    for (const fit::Baseline& each : person.fit.baselines) row.push_back(each.held_out.mean);
    row.insert(row.end(), {person.fit.held_out.mean, person.fit.held_out.p95});
    if (person.from_one_number) row.push_back(person.from_one_number->mean);
    absl::StrAppend(&html, StudyRow(person.name, row));
    sum.resize(row.size());
    for (size_t i = 0; i < row.size(); ++i) sum[i] += row[i] / static_cast<double>(study.people.size());
  }
  return html + StudyRow("mean", sum) + "</table>\n";
}

}  // namespace

std::string MotionPage(const fit::MotionStudy& study) {
  std::string html =
      absl::StrCat(kMotionPageHead, "<h1>Breathing motion of ", study.people.size(),
                   " people</h1><p>Mean distance [mm] between true and "
                   "predicted motion of landmarks that were not fitted: half of each person's, drawn at random. \"From "
                   "one number\": "
                   "predicted from the descent of the lungs' lowest fifth and the other people's motion.</p>\n",
                   StudyTableOf(study));
  for (const fit::StudiedPerson& person : study.people) {
    absl::StrAppend(&html, "<h2>", MotionPageText(person.name), "</h2><figure>", HeightPlot(person.fit),
                    "<figcaption>Held-out landmarks: measured (grey) and fitted (blue).</figcaption></figure><figure>",
                    SidePlot(person.fit), "<figcaption>From the left side, by error: light blue 0, red ", kWorst,
                    " mm and more.</figcaption></figure>\n");
  }
  return html + "</html>\n";
}

}  // namespace phrenic::client
