// A session as people read it.
#ifndef PHRENIC_CLIENT_PRINT_PRINT_SESSION_H_
#define PHRENIC_CLIENT_PRINT_PRINT_SESSION_H_

#include <ostream>
#include <string>

#include "phrenic/v1/session.pb.h"

namespace phrenic::client {

// "paused", "playing", "diverged".
std::string StateName(v1::SessionState state);

// "breath_force=1.5 breath_length=4 ...".
std::string ParametersLine(const v1::Parameters& parameters);

// How well the session keeps its constraints, "1.2e-07 mm (rigid-links:cube)" between two words; "" where it has none.
std::string ResidualText(const v1::Session& session, const char* before, const char* after);

// What the last implicit step's solver left, "8.1e-04 left after 12 iterations" between two words; "" where none ran.
std::string SolverText(const v1::Session& session, const char* before, const char* after);

// Who controls a session, who is there and who asks, a line each.
std::string ControlText(const v1::Control& control);

// A few lines: state, time, pace, parameters, constraints, pulls, and why it diverged where it has.
void PrintSession(const v1::Session& session, std::ostream& out);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_PRINT_SESSION_H_
