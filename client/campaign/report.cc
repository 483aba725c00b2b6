#include "client/campaign/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/print/readings.h"

namespace phrenic::client {
namespace {

using Texts = std::vector<std::string>;

struct Grid {
  Texts header;
  std::vector<Texts> rows;
};

// Returns the parameters that the runs set, in order of first appearance.
Texts ParametersOf(const v1::CampaignResult& result) {
  Texts names;
  for (const v1::CampaignRow& row : result.rows()) {
    for (const std::string& setting : Texts(absl::StrSplit(row.settings(), ' ', absl::SkipEmpty()))) {
      const std::string name = setting.substr(0, setting.find('='));
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

std::string SettingOf(const v1::CampaignRow& row, const std::string& name) {
  for (const std::string& setting : Texts(absl::StrSplit(row.settings(), ' ', absl::SkipEmpty()))) {
    const std::pair<std::string, std::string> parts = absl::StrSplit(setting, absl::MaxSplits('=', 1));
    if (parts.first == name) return parts.second;
  }
  return "";
}

using ReadingsOfCells = std::map<std::string, std::map<std::string, const v1::CampaignReading*>>;

Texts MeasuresOf(const v1::CampaignResult& result) {
  Texts names;
  for (const v1::CampaignReading& reading : result.readings()) {
    if (std::find(names.begin(), names.end(), reading.measure()) == names.end()) names.push_back(reading.measure());
  }
  return names;
}

// Returns "3.695" of "3.695 l"; the unit is in the header.
std::string NumberOf(const v1::CampaignReading& reading) {
  const std::string text = ReadingText(reading.greatest(), reading.unit());
  return text.substr(0, text.find(' '));
}

std::string UnitOf(const v1::CampaignReading& reading) {
  const std::string text = ReadingText(reading.greatest(), reading.unit());
  return text.substr(text.find(' ') + 1);
}

Grid MakeGrid(const v1::CampaignResult& result) {
  const Texts parameters = ParametersOf(result), measures = MeasuresOf(result);
  ReadingsOfCells readings;
  std::map<std::string, std::string> units;
  for (const v1::CampaignReading& reading : result.readings()) {
    readings[reading.cell()][reading.measure()] = &reading;
    units[reading.measure()] = UnitOf(reading);
  }
  Grid grid{{"scene", "mm", "preset"}, {}};
  grid.header.insert(grid.header.end(), parameters.begin(), parameters.end());
  grid.header.insert(grid.header.end(), {"outcome", "x real time", "us CPU a step"});
  for (const std::string& measure : measures)
    grid.header.push_back(absl::StrCat(measure, ", most [", units[measure], "]"));
  for (const v1::CampaignRow& row : result.rows()) {
    Texts cells = {row.scene(), row.resolution_mm() > 0 ? absl::StrFormat("%g", row.resolution_mm()) : "",
                   row.preset()};
    for (const std::string& name : parameters) cells.push_back(SettingOf(row, name));
    cells.push_back(row.outcome());
    cells.push_back(absl::StrFormat("%.3g", row.times_real_time()));
    cells.push_back(absl::StrFormat("%.3g", row.cpu_us_a_step()));
    const auto& of_cell = readings[row.cell()];
    for (const std::string& measure : measures) {
      const auto found = of_cell.find(measure);
      cells.push_back(found == of_cell.end() ? "" : NumberOf(*found->second));
    }
    grid.rows.push_back(std::move(cells));
  }
  return grid;
}

// Removes columns that are empty in every row, if there are rows.
Grid Trimmed(const Grid& grid) {
  if (grid.rows.empty()) return grid;
  Grid kept;
  kept.rows.resize(grid.rows.size());
  for (size_t c = 0; c < grid.header.size(); ++c) {
    const auto filled = [c](const Texts& row) { return !row[c].empty(); };
    if (!std::any_of(grid.rows.begin(), grid.rows.end(), filled)) continue;
    kept.header.push_back(grid.header[c]);
    for (size_t r = 0; r < grid.rows.size(); ++r) kept.rows[r].push_back(grid.rows[r][c]);
  }
  return kept;
}

std::string HtmlEscaped(const std::string& text) {
  return absl::StrReplaceAll(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

// Returns each number's position between the smallest and the greatest of its column, 0 to 1; -1 for text.
std::vector<std::vector<double>> Shades(const Grid& grid) {
  std::vector<std::vector<double>> shades(grid.rows.size(), std::vector<double>(grid.header.size(), -1));
  for (size_t c = 0; c < grid.header.size(); ++c) {
    double least = HUGE_VAL, greatest = -HUGE_VAL, value = 0;
    for (const Texts& row : grid.rows) {
      if (!absl::SimpleAtod(row[c], &value)) continue;
      least = std::min(least, value), greatest = std::max(greatest, value);
    }
    for (size_t r = 0; r < grid.rows.size() && greatest > least; ++r) {
      if (absl::SimpleAtod(grid.rows[r][c], &value)) shades[r][c] = (value - least) / (greatest - least);
    }
  }
  return shades;
}

std::string TableOf(const Grid& grid) {
  const auto shades = Shades(grid);
  std::string html = "<table><thead><tr>";
  for (const std::string& name : grid.header) absl::StrAppend(&html, "<th scope=col>", HtmlEscaped(name), "</th>");
  absl::StrAppend(&html, "</tr></thead><tbody>\n");
  for (size_t r = 0; r < grid.rows.size(); ++r) {
    absl::StrAppend(&html, "<tr>");
    for (size_t c = 0; c < grid.header.size(); ++c) {
      const double shade = shades[r][c];
      const std::string style =
          shade < 0 ? "" : absl::StrFormat(" style=\"background:rgb(31 119 180/%.2f)\"", 0.45 * shade);
      absl::StrAppend(&html, "<td", style, ">", HtmlEscaped(grid.rows[r][c]), "</td>");
    }
    absl::StrAppend(&html, "</tr>\n");
  }
  return html + "</tbody></table>\n";
}

constexpr char kHead[] =
    "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"
    "<style>body{font:15px system-ui,sans-serif;margin:2rem;color:#1b1f24}table{border-collapse:collapse}"
    "th,td{padding:.25rem .6rem;border-bottom:1px solid #d5d9de;text-align:right;white-space:nowrap}"
    "th{position:sticky;top:0;background:#fff;white-space:normal;vertical-align:bottom}"
    "th:first-child,td:first-child{text-align:left}li{margin:.2rem 0}</style>\n";

}  // namespace

Table CampaignTable(const v1::CampaignResult& result) {
  const Grid grid = Trimmed(MakeGrid(result));
  Table table(grid.header);
  for (const Texts& row : grid.rows) table.Add(row);
  return table;
}

std::string CampaignPage(const v1::Campaign& campaign, const v1::CampaignResult& result,
                         const std::vector<std::string>& exceeded_limits) {
  std::map<std::string, int> outcomes;
  for (const v1::CampaignRow& row : result.rows()) ++outcomes[row.outcome()];
  const auto count = [](std::string* out, const auto& entry) { absl::StrAppend(out, entry.second, " ", entry.first); };
  std::string html = absl::StrCat(
      kHead, "<title>", HtmlEscaped(campaign.name()), "</title><h1>", HtmlEscaped(campaign.name()), "</h1><p>",
      result.rows_size(), " runs of ", campaign.seconds(), " s: ", absl::StrJoin(outcomes, ", ", count), "; ",
      campaign.limits_size() - static_cast<int>(exceeded_limits.size()), " of ", campaign.limits_size(),
      " limits met. Shaded from the smallest to the greatest value of a column.</p>\n");
  if (!exceeded_limits.empty()) absl::StrAppend(&html, "<h2>Exceeded limits</h2><ul>\n");
  for (const std::string& sentence : exceeded_limits) absl::StrAppend(&html, "<li>", HtmlEscaped(sentence), "</li>\n");
  if (!exceeded_limits.empty()) absl::StrAppend(&html, "</ul>\n");
  return html + TableOf(Trimmed(MakeGrid(result))) + "</html>\n";
}

}  // namespace phrenic::client
