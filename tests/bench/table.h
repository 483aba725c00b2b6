// Prints what was timed as one table: medians of CPU time over the repetitions, ratios to the plain loop.
#ifndef PHRENIC_TESTS_BENCH_TABLE_H_
#define PHRENIC_TESTS_BENCH_TABLE_H_

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace phrenic::bench {

// Each benchmark has two counters: "springs", how many it works out each time; "against", the row, from 0, that its
// time is held against, or -1.
class Table final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  struct Row {
    std::string name;
    std::vector<double> microseconds;  // CPU time, one a repetition
    double springs = 0;
    int against = -1;
  };
  std::vector<Row> rows_;
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_TABLE_H_
