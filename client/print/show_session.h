// Shows the session that a call returned: the end of every command that creates or changes one. On the main thread.
#ifndef PHRENIC_CLIENT_PRINT_SHOW_SESSION_H_
#define PHRENIC_CLIENT_PRINT_SHOW_SESSION_H_

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/print/output.h"
#include "client/print/print_session.h"

namespace phrenic::client {

// Prints the session of a response on standard output: a table, or with -o json the response as one document with the
// proto's field names. `viewer` is the link to the session in the viewer, the field `viewer` of the document; empty:
// none. Response: any message with a field `session`.
//
// Returns the exit code: kOk; kFailed if the session diverged, whose reason is printed with it; what Fail returns if
// `status` is an error, of which nothing is printed on standard output.
template <typename Response>
int ShowSession(const Context& context, const grpc::Status& status, const Response& response,
                const std::string& viewer = "") {
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    auto answer = nlohmann::ordered_json::parse(Json(response));
    if (!viewer.empty()) answer["viewer"] = viewer;
    std::cout << answer.dump() << "\n";
  } else {
    PrintSession(response.session(), std::cout);
    if (!viewer.empty()) std::cout << "  viewer: " << viewer << "\n";
  }
  return response.session().state() == v1::SESSION_STATE_DIVERGED ? kFailed : kOk;
}

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_SHOW_SESSION_H_
