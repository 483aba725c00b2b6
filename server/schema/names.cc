#include "server/schema/names.h"

#include <algorithm>
#include <numeric>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace phrenic::schema {
namespace {

constexpr size_t kLongestGuess = 64;  // a longer name is not a misspelling

// Returns the Levenshtein distance: the fewest insertions, deletions and replacements that turn `a` into `b`.
size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string NearestName(std::string_view wanted, const std::vector<std::string>& names) {
  if (wanted.empty() || wanted.size() > kLongestGuess || names.empty()) return "";
  const auto begun = [&](const std::string& name) { return name.starts_with(wanted); };
  if (wanted.size() > 1 && std::ranges::count_if(names, begun) == 1) return *std::ranges::find_if(names, begun);
  const std::string nearest =
      *std::ranges::min_element(names, {}, [&](const std::string& name) { return EditDistance(wanted, name); });
  return EditDistance(wanted, nearest) <= nearest.size() / 2 ? nearest : "";
}

std::string ThereAre(std::string_view wanted, const std::vector<std::string>& names) {
  const std::string nearest = NearestName(wanted, names);
  const std::string all = names.empty() ? "none" : absl::StrJoin(names, ", ");
  return nearest.empty() ? absl::StrCat("; there are ", all)
                         : absl::StrCat("; did you mean ", nearest, "? There are ", all);
}

}  // namespace phrenic::schema
