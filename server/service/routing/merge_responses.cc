#include "server/service/routing/merge_responses.h"

#include <map>
#include <set>
#include <utility>

#include "absl/strings/match.h"
#include "phrenic/v1/session.pb.h"
#include "server/service/calls/messages.h"

namespace phrenic::service {
namespace {

grpc::ByteBuffer MergeSessionPages(const grpc::ByteBuffer& request, const std::vector<grpc::ByteBuffer>& responses,
                                   const PageTokens& tokens) {
  constexpr int kDefaultPageSize = 100;
  v1::ListSessionsRequest asked;
  (void)Parse(request, asked);
  std::map<std::string, v1::Session> sessions;
  bool more = false;
  for (const grpc::ByteBuffer& response : responses) {
    v1::ListSessionsResponse page;
    if (!Parse(response, page).ok()) continue;
    more = more || !page.next_page_token().empty();
    for (v1::Session& session : *page.mutable_sessions()) {
      v1::Session& known = sessions[session.id()];
      if (known.id().empty() || known.epoch() < session.epoch()) known = std::move(session);
    }
  }
  const auto page_size = static_cast<std::size_t>(asked.page_size() > 0 ? asked.page_size() : kDefaultPageSize);
  more = more || sessions.size() > page_size;
  v1::ListSessionsResponse merged;
  for (auto& [id, session] : sessions) {
    if (static_cast<std::size_t>(merged.sessions_size()) == page_size) break;
    *merged.add_sessions() = std::move(session);
  }
  if (more && merged.sessions_size() > 0) {
    merged.set_next_page_token(tokens.Seal(merged.sessions().rbegin()->id(), ""));
  }
  const grpc::Slice slice(merged.SerializeAsString());
  return grpc::ByteBuffer(&slice, 1);
}

}  // namespace

bool IsListMethod(const std::string& method) {
  static const std::set<std::string> methods = {
      "/phrenic.v1.SessionService/ListSessions", "/phrenic.v1.ExportService/ListExports",
      "/phrenic.v1.StudyService/ListStudies", "/phrenic.v1.PatientService/ListPatients",
      "/phrenic.v1.UploadService/ListUploads"};
  return methods.contains(method);
}

// Concatenated serialized messages parse as one message whose repeated fields are concatenated
// (protobuf.dev/programming-guides/encoding, "Last One Wins").
grpc::ByteBuffer MergeResponses(const std::string& method, const grpc::ByteBuffer& request,
                                const std::vector<grpc::ByteBuffer>& responses, const PageTokens& tokens) {
  if (absl::EndsWith(method, "/ListSessions")) return MergeSessionPages(request, responses, tokens);
  std::vector<grpc::Slice> slices;
  for (const grpc::ByteBuffer& response : responses) {
    std::vector<grpc::Slice> part;
    if (response.Valid() && response.Dump(&part).ok()) slices.insert(slices.end(), part.begin(), part.end());
  }
  return grpc::ByteBuffer(slices.data(), slices.size());
}

}  // namespace phrenic::service
