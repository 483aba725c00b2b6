// A session as text.
#ifndef PHRENIC_CLIENT_PRINT_PRINT_SESSION_H_
#define PHRENIC_CLIENT_PRINT_PRINT_SESSION_H_

#include <ostream>
#include <string>

#include "phrenic/v1/session.pb.h"

namespace phrenic::client {

// Returns "paused", "playing", "diverged" or "unknown".
std::string StateName(v1::SessionState state);

// Returns the value of a parameter: "1.5", "on", "velocity_verlet".
std::string ParameterValue(const v1::Parameters& parameters, const google::protobuf::FieldDescriptor& field);

// Returns the parameters that are set: "breath_length=4 breath_force=1.5 ...". In the order of the schema, separated by
// blanks.
std::string ParametersLine(const v1::Parameters& parameters);

// Returns a line for each group of parameters that has a set one: "BEFOREBreathing: breath_length=4 ...\n".
std::string ParameterLines(const v1::Parameters& parameters, const char* before);

// Returns the largest constraint residual, "1.2e-07 mm (rigid-links:cube)", between `before` and `after`; empty if the
// session has no constraints.
std::string ResidualText(const v1::Session& session, const char* before, const char* after);

// Returns a line for each warning, "BEFOREwarning: rigid-links:cube does not hold, ...\n".
std::string WarningLines(const google::protobuf::RepeatedPtrField<std::string>& warnings, const char* before);

// Returns the relative residual of the last implicit step's solver, "8.1e-04 left after 12 iterations", between
// `before` and `after`; empty if no implicit step ran.
std::string SolverText(const v1::Session& session, const char* before, const char* after);

// Returns one line for the controller and one for each participant. Says that everybody controls if there is no
// controller.
std::string ControlText(const v1::Control& control);

// Prints state, time, pace, parameters, residuals, control, pulls and, after a divergence, its cause and remedy. Units
// are those of the fields; residuals are in millimetres, pulls in newtons. Each line ends with "\n".
void PrintSession(const v1::Session& session, std::ostream& out);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_PRINT_SESSION_H_
