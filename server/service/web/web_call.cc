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

WebCall::WebCall(const boost::asio::any_io_executor& strand, Handlers handlers)
    : strand_(strand), work_(strand), handlers_(std::move(handlers)) {}

absl::StatusOr<std::shared_ptr<WebCall>> WebCall::Start(grpc::GenericStub& stub, Request request,
                                                        const boost::asio::any_io_executor& strand, Handlers handlers) {
  std::shared_ptr<WebCall> call(new WebCall(strand, std::move(handlers)));
  absl::Status status = PrepareContext(request.method, request.metadata, call->context_);
  if (!status.ok()) return status;
  if (request.timeout.has_value()) call->context_.set_deadline(std::chrono::system_clock::now() + *request.timeout);
  const grpc::Slice slice(request.message);
  call->outgoing_ = grpc::ByteBuffer(&slice, 1);
  call->self_ = call;
  stub.PrepareBidiStreamingCall(&call->context_, request.method, {}, call.get());
  call->AddHold();  // ReadNext starts reads outside of reactions
  call->held_ = true;
  call->reading_ = true;
  call->StartWriteLast(&call->outgoing_, {});
  call->StartRead(&call->incoming_);
  call->StartCall();
  return call;
}

void WebCall::ReadNext() {
  if (cancelled_ || reading_ || !held_) return;
  reading_ = true;
  StartRead(&incoming_);
}

void WebCall::Cancel() {
  if (cancelled_) return;
  cancelled_ = true;
  handlers_ = {};
  if (!held_) return;
  context_.TryCancel();
  if (!reading_) ReleaseHold();
}

void WebCall::OnReadDone(bool ok) {
  boost::asio::post(strand_, [self = shared_from_this(), ok, message = incoming_] { self->HandleRead(ok, message); });
}

void WebCall::HandleRead(bool ok, const grpc::ByteBuffer& message) {
  reading_ = false;
  if (!ok || cancelled_) return ReleaseHold();
  handlers_.message(message);
}

void WebCall::ReleaseHold() {
  held_ = false;
  RemoveHold();
}

void WebCall::OnDone(const grpc::Status& status) {
  const std::lock_guard<std::mutex> lock(posting_);
  boost::asio::post(strand_, [self = std::move(self_), status] {
    { const std::lock_guard<std::mutex> posted(self->posting_); }
    if (!self->cancelled_) self->handlers_.done(status, Copy(self->context_.GetServerTrailingMetadata()));
    self->handlers_ = {};
    self->work_.reset();
  });
}

}  // namespace phrenic::service
