// The words of label names and file names, so that programs' spellings of one structure compare as equal.
#ifndef PHRENIC_SERVER_IMAGING_LABELS_LABEL_WORDS_H_
#define PHRENIC_SERVER_IMAGING_LABELS_LABEL_WORDS_H_

#include <string>
#include <string_view>
#include <vector>

namespace phrenic::imaging {

// Returns the name's words in their order: lower case, singular, ordinals and numbers without zeros before them as
// numbers, "l" and "r" as sides, "th12" as "t12", without "of" and "the". Other bytes than ASCII letters and digits
// part words, and so does a digit after three letters: "Rib7_L" is rib, 7, left. Pure function.
std::vector<std::string> PlainWords(std::string_view name);

// Returns the sorted words, parted by spaces: equal for spellings of one structure. Pure function.
std::string SortedWords(std::vector<std::string> words);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABELS_LABEL_WORDS_H_
