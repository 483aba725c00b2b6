#include "server/schema/names.h"

#include <algorithm>
#include <numeric>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace phrenic::schema {
namespace {

constexpr size_t kLongestGuess = 64;  // a longer name is not a misspelling

// Returns the fewest insertions, deletions, replacements and exchanges of neighbours that turn `a` into `b`, with no
// letter changed twice (Damerau 1964, optimal string alignment).
size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string NearestName(std::string_view wanted, const std::vector<std::string>& names) {
  if (wanted.empty() || wanted.size() > kLongestGuess || names.empty()) return "";
  const std::string small = absl::AsciiStrToLower(std::string(wanted));
  const auto begun = [&](const std::string& name) { return absl::StartsWithIgnoreCase(name, small); };
  if (wanted.size() > 1 && std::ranges::count_if(names, begun) == 1) return *std::ranges::find_if(names, begun);
  const auto distance = [&](const std::string& name) { return EditDistance(small, absl::AsciiStrToLower(name)); };
  const std::string nearest = *std::ranges::min_element(names, {}, distance);
  return distance(nearest) <= nearest.size() / 2 ? nearest : "";
}

std::string ThereAre(std::string_view wanted, const std::vector<std::string>& names) {
  const std::string nearest = NearestName(wanted, names);
  const std::string all = names.empty() ? "none" : absl::StrJoin(names, ", ");
  return nearest.empty() ? absl::StrCat("; there are ", all)
                         : absl::StrCat("; did you mean ", nearest, "? There are ", all);
}

}  // namespace phrenic::schema
