// v1.AccessService: who the caller is, and join links to sessions.
#ifndef PHRENIC_SERVER_SERVICE_ACCESS_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_ACCESS_SERVICE_H_

#include "phrenic/v1/access.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
//
// Links belong to their session, whose stepping thread changes them between two steps (Session::ChangeControl), so the
// service has no state and no lock.
class AccessService final {
 public:
  // Both outlive the service.
  AccessService(AccessGuard& guard, session::Table& table) : guard_(guard), table_(table) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kQuick. Needs no account: for a caller that the server does not know the name is empty.
  grpc::Status GetAccess(grpc::CallbackServerContext* context, const v1::GetAccessRequest* request,
                         v1::GetAccessResponse* response);
  // On Lane::kSession. The response alone has the secret: the session keeps its SHA-256. Default: a viewer's link for 7
  // days. INVALID_ARGUMENT for a role above controller, RESOURCE_EXHAUSTED for more than 64 links.
  grpc::Status CreateLink(grpc::CallbackServerContext* context, const v1::CreateLinkRequest* request,
                          v1::CreateLinkResponse* response);
  // On Lane::kQuick. Leaves out links that have expired.
  grpc::Status ListLinks(grpc::CallbackServerContext* context, const v1::ListLinksRequest* request,
                         v1::ListLinksResponse* response);
  // On Lane::kSession. NOT_FOUND if the session has no such link. Frame streams that were opened with the link end
  // before their next message.
  grpc::Status RevokeLink(grpc::CallbackServerContext* context, const v1::RevokeLinkRequest* request,
                          v1::RevokeLinkResponse* response);

 private:
  // Returns FAILED_PRECONDITION if the server has no accounts, because links have no effect then.
  absl::Status CheckGuarded() const;

  AccessGuard& guard_;
  session::Table& table_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ACCESS_SERVICE_H_
