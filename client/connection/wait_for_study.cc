#include "client/connection/wait_for_study.h"

#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/terminal/progress.h"

namespace phrenic::client {

grpc::Status WaitForStudy(const Context& context, v1::StudyService::Stub& stub, const std::string& id,
                          v1::Study* study) {
  v1::WatchStudyRequest request;
  request.set_study_id(id);
  Progress progress(id, 1);
  return StreamWithReconnect(context, [&](OnReceived received) {
    grpc::ClientContext call;
    const Interruption::Scope scope(*context.interruption, call);
    const auto reader = stub.WatchStudy(&call, request);
    for (v1::WatchStudyResponse response; reader->Read(&response);) {
      received();
      progress.SetDetail(response.study().doing());
      progress.Update(response.study().progress());
      *study = response.study();
    }
    return reader->Finish();
  });
}

}  // namespace phrenic::client
