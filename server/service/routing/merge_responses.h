// Merges the responses of several servers to one list call.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_MERGE_RESPONSES_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_MERGE_RESPONSES_H_

#include <grpcpp/support/byte_buffer.h>

#include <string>
#include <vector>

#include "server/service/calls/page_tokens.h"

namespace phrenic::service {

// True for methods that list what a server has: ListSessions, ListExports, ListStudies, ListPatients, ListUploads. In a
// cluster each server is asked and the responses are merged. `method` is a path,
// "/phrenic.v1.SessionService/ListSessions". Thread-safe.
bool IsListMethod(const std::string& method);

// Returns the responses to a list method as one. Sessions are sorted by id, the copy with the highest epoch is kept,
// and the page has at most the size that `request` asks for; other lists are concatenated. Empty buffers are skipped.
// `tokens` seals the token of the next page. Thread-safe. The default size of a page is 100 sessions. Responses that
// are no ListSessionsResponse are skipped. The entries of other lists are in the order of `responses`. A next page
// exists if a server has one or if sessions were left out. Requires: IsListMethod(method).
grpc::ByteBuffer MergeResponses(const std::string& method, const grpc::ByteBuffer& request,
                                const std::vector<grpc::ByteBuffer>& responses, const PageTokens& tokens);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_MERGE_RESPONSES_H_
