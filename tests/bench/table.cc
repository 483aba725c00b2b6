#include "tests/bench/table.h"

#include <algorithm>
#include <cstdio>

namespace phrenic::bench {
namespace {

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void Table::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration) continue;
    const std::string name = run.run_name.function_name;
    auto row = std::find_if(rows_.begin(), rows_.end(), [&name](const Row& each) { return each.name == name; });
    if (row == rows_.end()) row = rows_.insert(row, Row{name, {}, 0, -1});
    row->microseconds.push_back(1e6 * run.cpu_accumulated_time / static_cast<double>(run.iterations));
    row->springs = run.counters.at("springs");
    row->against = static_cast<int>(run.counters.at("against"));
  }
}

// Random interleaving hands over the rows in any order: their names start with their number.
void Table::Finalize() {
  std::sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.name < b.name; });
  std::printf("%-52s %12s %12s %8s\n", "", "CPU us", "ns a spring", "ratio");
  for (const Row& row : rows_) {
    const double median = Median(row.microseconds);
    std::printf("%-52s %12.1f %12.2f", row.name.c_str(), median, 1e3 * median / row.springs);
    const std::string number = std::to_string(row.against + 1);
    const auto other = std::find_if(rows_.begin(), rows_.end(),
                                    [&number](const Row& each) { return each.name.starts_with(number + " "); });
    if (other != rows_.end()) {
      std::printf(" %8.2f of row %d", median / Median(other->microseconds), row.against + 1);
    }
    std::printf("\n");
  }
}

}  // namespace phrenic::bench
