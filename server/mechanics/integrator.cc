#include "server/mechanics/integrator.h"

#include "server/mechanics/solve/implicit_system.h"
#include "server/mechanics/solve/prefactored_system.h"
#include "server/mechanics/solve/quasi_newton.h"

namespace phrenic {

Workspace::Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;
Workspace::~Workspace() = default;

}  // namespace phrenic
