// The cells of a line of comma-separated numbers and names; quotes have no meaning.
#ifndef PHRENIC_SERVER_FIT_CSV_CELLS_H_
#define PHRENIC_SERVER_FIT_CSV_CELLS_H_

#include <string_view>
#include <vector>

namespace phrenic::fit {

// Returns the text without surrounding blanks; a view into it.
std::string_view Trimmed(std::string_view text);
// Returns the cells of a line, trimmed; views into it. One cell at least.
std::vector<std::string_view> CellsOf(std::string_view line);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_CSV_CELLS_H_
