#include "server/imaging/labels/label_words.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace phrenic::imaging {
namespace {

bool IsDigit(char c) { return absl::ascii_isdigit(static_cast<unsigned char>(c)); }

// Returns a number without zeros before it; other words unchanged.
std::string PlainNumber(std::string word) {
  if (!std::all_of(word.begin(), word.end(), IsDigit)) return word;
  const std::size_t first = word.find_first_not_of('0');
  return first == std::string::npos ? "0" : word.substr(first);
}

// Returns a word in lower case and singular, and an ordinal as a number: "rib" of "Ribs", "2" of "second".
std::string PlainWord(std::string word) {
  static constexpr const char* kOrdinals[] = {"first",   "second", "third", "fourth", "fifth",    "sixth",
                                              "seventh", "eighth", "ninth", "tenth",  "eleventh", "twelfth"};
  absl::AsciiStrToLower(&word);
  const auto* ordinal = std::find(std::begin(kOrdinals), std::end(kOrdinals), word);
  if (ordinal != std::end(kOrdinals)) return absl::StrCat(ordinal - std::begin(kOrdinals) + 1);
  if (word == "vertebrae") return "vertebra";
  if (word == "l" || word == "lt") return "left";
  if (word == "r" || word == "rt") return "right";
  if (absl::StartsWith(word, "th") && word.size() <= 4 && word.size() > 2 && IsDigit(word[2]))
    return "t" + word.substr(2);
  if (word.size() > 3 && word.back() == 's') word.pop_back();
  return PlainNumber(std::move(word));
}

}  // namespace

std::vector<std::string> PlainWords(std::string_view name) {
  constexpr std::size_t kLetters = 3;  // of a word that a digit ends
  std::vector<std::string> words;
  std::string word;
  const auto end = [&] {
    if (!word.empty()) words.push_back(PlainWord(std::exchange(word, "")));
  };
  for (const char c : name) {
    if (!absl::ascii_isalnum(static_cast<unsigned char>(c))) {
      end();
      continue;
    }
    if (IsDigit(c) && word.size() >= kLetters && !IsDigit(word.back())) end();
    word.push_back(c);
  }
  end();
  std::erase_if(words, [](const std::string& each) { return each == "of" || each == "the"; });
  return words;
}

std::string SortedWords(std::vector<std::string> words) {
  std::sort(words.begin(), words.end());
  return absl::StrJoin(words, " ");
}

}  // namespace phrenic::imaging
