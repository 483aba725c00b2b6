// Waits for a study of the server and shows how far it is.
#ifndef PHRENIC_CLIENT_CONNECTION_WAIT_FOR_STUDY_H_
#define PHRENIC_CLIENT_CONNECTION_WAIT_FOR_STUDY_H_

#include <string>

#include "client/connection/context.h"
#include "phrenic/v1/study.grpc.pb.h"

namespace phrenic::client {

// Shows a progress bar, named `id`, until the study ends; reconnects if the server stops. `study` receives its last
// state.
grpc::Status WaitForStudy(const Context& context, v1::StudyService::Stub& stub, const std::string& id,
                          v1::Study* study);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_WAIT_FOR_STUDY_H_
