#include "server/service/web/web_reply.h"

#include <array>
#include <boost/asio/write.hpp>
#include <cstdint>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "server/service/web/grpc_web.h"

namespace phrenic::service {
namespace {

namespace net = boost::asio;

std::string PrefixOf(std::size_t length) {
  const std::array<char, 5> prefix = MessagePrefix(static_cast<std::uint32_t>(length));
  return {prefix.data(), prefix.size()};
}

// Removes the first `bytes` of the buffers.
void Consume(std::size_t bytes, std::vector<net::const_buffer>& buffers) {
  for (net::const_buffer& buffer : buffers) {
    const std::size_t part = std::min(bytes, buffer.size());
    buffer += part;
    bytes -= part;
  }
  std::erase_if(buffers, [](const net::const_buffer& buffer) { return buffer.size() == 0; });
}

}  // namespace

void WebReply::Begin(std::string head, bool text) {
  head_ = std::move(head);
  text_ = text;
}

bool WebReply::SendMessage(const grpc::ByteBuffer& message, Sent sent) {
  message.Dump(&slices_);
  std::vector<net::const_buffer> payload;
  payload.reserve(slices_.size());
  for (const grpc::Slice& slice : slices_) payload.emplace_back(slice.begin(), slice.size());
  MakeChunk(PrefixOf(message.Length()), payload, false);
  return Write(std::move(sent));
}

bool WebReply::SendMessage(stream::Bytes message, Sent sent) {
  message_ = std::move(message);
  MakeChunk(PrefixOf(message_->size()), {net::buffer(*message_)}, false);
  return Write(std::move(sent));
}

bool WebReply::SendTrailers(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers,
                            Sent sent) {
  MakeChunk(TrailersFrame(status, trailers), {}, true);
  return Write(std::move(sent));
}

void WebReply::MakeChunk(std::string prefix, const std::vector<net::const_buffer>& payload, bool last) {
  if (text_) {
    for (const net::const_buffer& part : payload) prefix.append(static_cast<const char*>(part.data()), part.size());
    prefix = absl::Base64Escape(prefix);
  }
  buffers_.assign(1, {});
  if (!text_) buffers_.insert(buffers_.end(), payload.begin(), payload.end());
  const std::size_t size = prefix.size() + net::buffer_size(buffers_);
  chunk_head_ = absl::StrCat(std::exchange(head_, {}), absl::Hex(size), "\r\n", prefix);
  chunk_tail_ = last ? "\r\n0\r\n\r\n" : "\r\n";
  buffers_.front() = net::buffer(chunk_head_);
  buffers_.push_back(net::buffer(chunk_tail_));
}

bool WebReply::Write(Sent sent) {
  Consume(WriteNow(), buffers_);
  if (buffers_.empty()) {
    Clear();
    return true;
  }
  writing_ = true;
  stream_.tcp().expires_after(idle_time_);
  net::async_write(stream_, buffers_, [this, sent = std::move(sent)](boost::system::error_code error, std::size_t) {
    Clear();
    sent(error);
  });
  return false;
}

// An error other than a full socket shows when the rest is written.
std::size_t WebReply::WriteNow() {
  if (stream_.encrypted()) return 0;
  boost::system::error_code error;
  auto& socket = stream_.tcp().socket();
  if (!socket.non_blocking()) socket.non_blocking(true, error);
  return error ? 0 : socket.write_some(buffers_, error);
}

void WebReply::Clear() {
  writing_ = false;
  buffers_.clear();
  slices_.clear();
  message_ = nullptr;
}

}  // namespace phrenic::service
