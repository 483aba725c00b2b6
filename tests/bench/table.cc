#include "tests/bench/table.h"

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cstdio>

namespace phrenic::bench {
namespace {

double Median(std::vector<double> values) { return values.empty() ? 0 : boost::math::statistics::median(values); }

}  // namespace

void Table::Register(const Row& row) {
  rows_.push_back({row, {}});
  benchmark::RegisterBenchmark(row.name.c_str(), [work = row.work](benchmark::State& state) {
    for (auto _ : state) work();
  })->Unit(benchmark::kMicrosecond);
}

// Random interleaving hands over the rows in any order.
void Table::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration) continue;
    for (Timed& timed : rows_) {
      if (timed.row.name != run.run_name.function_name) continue;
      timed.microseconds.push_back(1e6 * run.cpu_accumulated_time / static_cast<double>(run.iterations));
    }
  }
}

const Table::Timed* Table::Find(const std::string& name) const {
  for (const Timed& timed : rows_) {
    if (timed.row.name == name && !timed.microseconds.empty()) return &timed;
  }
  return nullptr;
}

double Table::Microseconds(const std::string& name) const {
  const Timed* const timed = Find(name);
  return timed == nullptr ? 0 : Median(timed->microseconds);
}

// In thousand millions a second.
double Table::Rate(const std::string& name, double Row::*amount) const {
  const Timed* const timed = Find(name);
  return timed == nullptr ? 0 : 1e-3 * timed->row.*amount / Median(timed->microseconds);
}

void Table::Print(const std::string& bytes_row, const std::string& flops_row) const {
  const double most_bytes = Rate(bytes_row, &Row::bytes), most_flops = Rate(flops_row, &Row::flops);
  std::printf("%-44s %10s %18s %7s %-32s %s\n", "", "CPU us", "ns each", "ratio", " to", "of the machine's limits");
  for (const Timed& timed : rows_) {
    const Row& row = timed.row;
    const double median = Median(timed.microseconds);
    if (median == 0) continue;
    std::printf("%-44s %10.1f", row.name.c_str(), median);
    if (row.count > 0) {
      std::printf(" %7.2f %-10s", 1e3 * median / row.count, row.unit.c_str());
    } else {
      std::printf("%19s", "");
    }
    const double other = Microseconds(row.against);
    if (other > 0) {
      std::printf(" %7.2f  %-32s", median / other, row.against.c_str());
    } else {
      std::printf("%42s", "");
    }
    if (row.bytes > 0 && most_bytes > 0) {
      const double rate = Rate(row.name, &Row::bytes);
      std::printf(" %5.1f GB/s (%.0f %%)", rate, 100 * rate / most_bytes);
    }
    if (row.flops > 0 && most_flops > 0) {
      const double rate = Rate(row.name, &Row::flops);
      std::printf(" %5.1f Gflop/s (%.0f %%)", rate, 100 * rate / most_flops);
    }
    std::printf("\n");
  }
}

}  // namespace phrenic::bench
