// v1.AccessService: who the caller is, and join links to sessions.
#ifndef PHRENIC_SERVER_SERVICE_ACCESS_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_ACCESS_SERVICE_H_

#include "phrenic/v1/access.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. Errors as in the proto of each method.
class AccessService final : public v1::AccessService::Service {
 public:
  AccessService(AccessGuard& guard, session::Table& table) : guard_(guard), table_(table) {}

  grpc::Status GetAccess(grpc::ServerContext* context, const v1::GetAccessRequest* request,
                         v1::GetAccessResponse* response) override;
  grpc::Status CreateLink(grpc::ServerContext* context, const v1::CreateLinkRequest* request,
                          v1::CreateLinkResponse* response) override;
  grpc::Status ListLinks(grpc::ServerContext* context, const v1::ListLinksRequest* request,
                         v1::ListLinksResponse* response) override;
  grpc::Status RevokeLink(grpc::ServerContext* context, const v1::RevokeLinkRequest* request,
                          v1::RevokeLinkResponse* response) override;

 private:
  // Returns FAILED_PRECONDITION if the server has no accounts, because links have no effect then.
  absl::Status CheckGuarded() const;

  AccessGuard& guard_;
  session::Table& table_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ACCESS_SERVICE_H_
