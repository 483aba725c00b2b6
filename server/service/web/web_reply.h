// The body of a gRPC-web response while it is written: one chunk for each message, one for the trailers.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_REPLY_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_REPLY_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>

#include <boost/asio/buffer.hpp>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "server/service/web/web_stream.h"
#include "server/stream/viewer.h"

namespace phrenic::service {

// Not thread-safe: use it on the stream's strand. WebConnection has one, which it uses for one call after another.
//
// A chunk (RFC 9112 section 7.1) is written from where its bytes are, without a copy of the message: head, message and
// tail in one gathered write. What the socket takes at once is written without waiting; the rest is written as the
// client reads. One chunk is written at a time, so a slow client costs one message.
class WebReply {
 public:
  // Called on the strand when a chunk is written, or cannot be.
  using Sent = std::function<void(boost::system::error_code error)>;

  // `idle_time` is the timeout of what does not fit into the socket at once. `stream` outlives the reply.
  WebReply(WebStream& stream, std::chrono::milliseconds idle_time) : stream_(stream), idle_time_(idle_time) {}

  // Begins a response. `head` is written with the first chunk. `text` means that the frames are base64.
  void Begin(std::string head, bool text);
  // True while a chunk is being written.
  bool writing() const { return writing_; }

  // Each writes a chunk. Returns true if it is written at once; otherwise false, and calls `sent` later. Requires:
  // writing() is false; `sent` keeps the stream and the reply alive.
  bool SendMessage(const grpc::ByteBuffer& message, Sent sent);
  bool SendMessage(stream::Bytes message, Sent sent);
  // The last chunk of the response.
  bool SendTrailers(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers, Sent sent);

 private:
  // Makes the chunk of the frame that begins with `prefix` and goes on with `payload`.
  void MakeChunk(std::string prefix, const std::vector<boost::asio::const_buffer>& payload, bool last);
  // Writes the chunk.
  bool Write(Sent sent);
  // Writes what the socket takes without waiting, and returns the number of bytes. TLS writes nothing this way.
  std::size_t WriteNow();
  // Releases the chunk.
  void Clear();

  WebStream& stream_;
  const std::chrono::milliseconds idle_time_;
  std::string head_;   // of the response; sent with its first chunk
  bool text_ = false;  // frames are base64
  bool writing_ = false;
  // The chunk being written.
  std::string chunk_head_, chunk_tail_;             // around the message's bytes
  std::vector<grpc::Slice> slices_;                 // the message's bytes, or
  stream::Bytes message_;                           // these
  std::vector<boost::asio::const_buffer> buffers_;  // of the whole chunk; refer to those above
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_REPLY_H_
