// A server on free loopback ports, and stubs that call it over its sockets.
#ifndef PHRENIC_TESTS_SERVICE_SERVER_FIXTURE_H_
#define PHRENIC_TESTS_SERVICE_SERVER_FIXTURE_H_

#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "google/protobuf/text_format.h"
#include "phrenic/v1/control.grpc.pb.h"
#include "phrenic/v1/export.grpc.pb.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"
#include "tests/service/call.h"

namespace phrenic::service {

class ServerFixture : public testing::Test {
 protected:
  ServerFixture() {
    options_.listen = "127.0.0.1:0";
    options_.web = "127.0.0.1:0";
    options_.limits.sessions = 6;
    options_.limits.viewers = 3;
  }

  // Returns a channel with its own connection.
  std::shared_ptr<grpc::Channel> NewChannel() {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    arguments.SetMaxReceiveMessageSize(-1);
    return grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", server_->port()), grpc::InsecureChannelCredentials(),
                                     arguments);
  }

  void SetUp() override {
    auto server = Server::Start(options_);
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    channel_ = NewChannel();
    scenes_ = v1::SceneService::NewStub(channel_);
    sessions_ = v1::SessionService::NewStub(channel_);
    control_ = v1::ControlService::NewStub(channel_);
    frames_ = v1::FrameService::NewStub(channel_);
    exports_ = v1::ExportService::NewStub(channel_);
  }

  // Calls a method of SessionService and returns its status only.
  template <class Request, class Response>
  grpc::Status Session(grpc::Status (v1::SessionService::Stub::*method)(grpc::ClientContext*, const Request&,
                                                                        Response*),
                       const std::string& text) {
    Response response;
    return Call(*sessions_, method, text, &response);
  }

  void CreateCube(const std::string& id) {
    v1::CreateSessionResponse created;
    const grpc::Status status = Call(*sessions_, &v1::SessionService::Stub::CreateSession,
                                     absl::StrCat("session_id: '", id, "' source { name: 'cube-springs' }"), &created);
    ASSERT_TRUE(status.ok()) << status.error_message();
    ASSERT_EQ(created.session().id(), id);
  }

  ServerOptions options_;
  std::unique_ptr<Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::SceneService::Stub> scenes_;
  std::unique_ptr<v1::SessionService::Stub> sessions_;
  std::unique_ptr<v1::ControlService::Stub> control_;
  std::unique_ptr<v1::FrameService::Stub> frames_;
  std::unique_ptr<v1::ExportService::Stub> exports_;
};

// A WatchFrames stream that is read message by message.
class Watch {
 public:
  Watch(const std::shared_ptr<grpc::Channel>& channel, const std::string& id)
      : stub_(v1::FrameService::NewStub(channel)) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
    v1::WatchFramesRequest request;
    request.set_session_id(id);
    reader_ = stub_->WatchFrames(&context_, request);
  }
  ~Watch() {
    context_.TryCancel();
    v1::WatchFramesResponse rest;
    while (reader_->Read(&rest)) continue;
    if (!finished_) reader_->Finish();
  }

  bool Read(v1::WatchFramesResponse* response) { return reader_->Read(response); }
  // Reads up to the next message for which `wanted` is true. False if the stream ends before.
  template <class Wanted>
  bool ReadUntil(const Wanted& wanted, v1::WatchFramesResponse* response) {
    while (Read(response)) {
      if (wanted(*response)) return true;
    }
    return false;
  }
  grpc::Status Finish() {
    finished_ = true;
    return reader_->Finish();
  }

 private:
  std::unique_ptr<v1::FrameService::Stub> stub_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::WatchFramesResponse>> reader_;
  bool finished_ = false;
};

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SERVICE_SERVER_FIXTURE_H_
