// gRPC's server reflection: tells clients such as grpcurl and buf the services and their messages.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_REFLECTION_H_
#define PHRENIC_SERVER_SERVICE_CALLS_REFLECTION_H_

#include <string>
#include <vector>

#include "server/service/calls/call_table.h"

namespace phrenic::service {

// Adds ServerReflectionInfo of grpc.reflection.v1 and v1alpha. gRPC's own plug-in holds a thread for each stream and
// asks for no account; this one is a conversation of the table, for callers with an account or a link. Call it last,
// since it lists the services that the table has then. A stream without a further request for a minute ends with
// DEADLINE_EXCEEDED.
void AddReflection(CallTable& calls);

// Returns the serialized ServerReflectionResponse to a serialized ServerReflectionRequest: the services, or the files
// that declare a symbol or have a name, with those that they import. Pure function, thread-safe. `services` are full
// names. Errors are in the response, as the protocol has them: NOT_FOUND for an unknown symbol or file,
// INVALID_ARGUMENT for a request that asks nothing. Knows the files that are linked into the program.
std::string Reflect(const std::string& request, const std::vector<std::string>& services);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_REFLECTION_H_
