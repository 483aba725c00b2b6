#include "server/service/web/web_call.h"

#include <grpcpp/support/slice.h>

#include <boost/asio/post.hpp>

namespace phrenic::service {
namespace {

std::multimap<std::string, std::string> Copy(const std::multimap<grpc::string_ref, grpc::string_ref>& metadata) {
  std::multimap<std::string, std::string> copy;
  for (const auto& [name, value] : metadata) {
    copy.emplace(std::string(name.data(), name.size()), std::string(value.data(), value.size()));
  }
  return copy;
}

}  // namespace

WebCall::WebCall(Request request, const boost::asio::any_io_executor& strand, Handlers handlers)
    : request_(std::move(request)), strand_(strand), work_(strand), handlers_(std::move(handlers)) {
  const grpc::Slice slice(request_.message);
  outgoing_ = grpc::ByteBuffer(&slice, 1);
  for (const auto& [name, value] : request_.metadata) context_.AddMetadata(name, value);
  if (request_.timeout.has_value()) context_.set_deadline(std::chrono::system_clock::now() + *request_.timeout);
}

std::shared_ptr<WebCall> WebCall::Start(grpc::GenericStub& stub, Request request,
                                        const boost::asio::any_io_executor& strand, Handlers handlers) {
  std::shared_ptr<WebCall> call(new WebCall(std::move(request), strand, std::move(handlers)));
  call->self_ = call;
  stub.PrepareBidiStreamingCall(&call->context_, call->request_.method, {}, call.get());
  call->AddHold();  // reads are started outside reactions
  call->held_ = true;
  call->reading_ = true;
  call->StartWriteLast(&call->outgoing_, {});
  call->StartRead(&call->incoming_);
  call->StartCall();
  return call;
}

void WebCall::ReadNext() {
  if (abandoned_ || reading_ || !held_) return;
  reading_ = true;
  StartRead(&incoming_);
}

void WebCall::Abandon() {
  if (abandoned_) return;
  abandoned_ = true;
  handlers_ = {};
  if (!held_) return;
  context_.TryCancel();
  if (!reading_) LetGo();
}

void WebCall::OnReadDone(bool ok) {
  boost::asio::post(strand_, [self = shared_from_this(), ok, message = incoming_] { self->ReadDone(ok, message); });
}

void WebCall::ReadDone(bool ok, const grpc::ByteBuffer& message) {
  reading_ = false;
  if (!ok || abandoned_) return LetGo();
  handlers_.message(message);
}

void WebCall::LetGo() {
  held_ = false;
  RemoveHold();
}

void WebCall::OnDone(const grpc::Status& status) {
  boost::asio::post(strand_, [self = std::move(self_), status] {
    if (!self->abandoned_) self->handlers_.done(status, Copy(self->context_.GetServerTrailingMetadata()));
    self->handlers_ = {};
    self->work_.reset();
  });
}

}  // namespace phrenic::service
