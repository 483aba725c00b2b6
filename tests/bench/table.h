// Prints what was timed as one table: medians of CPU time over the repetitions, ratios to other rows, and how near to
// what the machine can do.
#ifndef PHRENIC_TESTS_BENCH_TABLE_H_
#define PHRENIC_TESTS_BENCH_TABLE_H_

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

namespace phrenic::bench {

// One row: `work` is timed. `count` things of the name `unit` are worked out each time; the time is held against that
// of the row `against`, where it is not empty. `bytes` read and written and `flops`, at least, where they are known.
struct Row {
  std::string name;
  std::function<void()> work;
  double count = 0;
  std::string unit;
  std::string against;
  double bytes = 0, flops = 0;
};

// Rows are printed in the order in which they were registered.
class Table final : public benchmark::BenchmarkReporter {
 public:
  void Register(const Row& row);
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;
  // Prints; `fastest` are the names of the rows that show the machine's own limits, of bytes and of flops.
  void Print(const std::string& bytes_row, const std::string& flops_row) const;
  // Median CPU time of a row [us]; 0 where it did not run.
  double Microseconds(const std::string& name) const;

 private:
  struct Timed {
    Row row;
    std::vector<double> microseconds;  // CPU time, one a repetition
  };
  const Timed* Find(const std::string& name) const;
  double Rate(const std::string& name, double Row::*amount) const;

  std::vector<Timed> rows_;
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_TABLE_H_
