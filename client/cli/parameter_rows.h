// The live parameters and the numbers of a body as rows of text, from the schema.
#ifndef PHRENIC_CLIENT_CLI_PARAMETER_ROWS_H_
#define PHRENIC_CLIENT_CLI_PARAMETER_ROWS_H_

#include <string>
#include <vector>

namespace phrenic::client {

struct ParameterRow {
  std::string group, name, unit, range, default_value, meaning;  // the unit is empty for a pure number
};

// Returns one row per live parameter, in the schema's order: those of a group stand together.
std::vector<ParameterRow> ParameterRows();
// Returns one row per number of a body.
std::vector<ParameterRow> PhysiqueRows();

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_PARAMETER_ROWS_H_
