// v1.AccessService: who the caller is, and join links to sessions.
#ifndef PHRENIC_SERVER_SERVICE_ACCESS_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_ACCESS_SERVICE_H_

#include "phrenic/v1/access.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
class AccessService final {
 public:
  AccessService(AccessGuard& guard, session::Table& table) : guard_(guard), table_(table) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  grpc::Status GetAccess(grpc::CallbackServerContext* context, const v1::GetAccessRequest* request,
                         v1::GetAccessResponse* response);
  grpc::Status CreateLink(grpc::CallbackServerContext* context, const v1::CreateLinkRequest* request,
                          v1::CreateLinkResponse* response);
  grpc::Status ListLinks(grpc::CallbackServerContext* context, const v1::ListLinksRequest* request,
                         v1::ListLinksResponse* response);
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
