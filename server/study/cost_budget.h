// The wall time of a cost study: what does not fit is left out or cut short, and named.
#ifndef PHRENIC_SERVER_STUDY_COST_BUDGET_H_
#define PHRENIC_SERVER_STUDY_COST_BUDGET_H_

#include <chrono>
#include <string>
#include <vector>

namespace phrenic::study {

// Not thread-safe.
class CostBudget {
 public:
  // Begins now, for `seconds` of wall time.
  explicit CostBudget(double seconds) : seconds_(seconds) {}

  double seconds() const { return seconds_; }
  // Wall time since the beginning [s].
  double spent() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count(); }
  // Time until this fraction of the budget is spent [s]; 0 if it is.
  double LeftUntil(double fraction) const;

  // Notes what was left out or cut short, and the time that it takes in all [s]; `what` is a clause: "the sizes of
  // figures 5.14-5.27 are left out".
  void Cut(const std::string& what, double takes);
  // Notes what is left out for another reason than time.
  void Note(const std::string& what) { notes_.push_back(what); }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  const double seconds_;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::vector<std::string> notes_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_BUDGET_H_
