// Raw connections for attacks: any bytes over TCP, and HTTP/2 frames that no correct client sends.
#ifndef PHRENIC_TESTS_FAULTS_RAW_H_
#define PHRENIC_TESTS_FAULTS_RAW_H_

#include <openssl/ssl.h>

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>

#include "tests/support/http2.h"

namespace phrenic::faults {

using http2::Headers;

// A TCP connection to a loopback port from 127.0.0.66, so that the server sees another machine than that of its healthy
// clients. Not thread-safe.
class RawConnection {
 public:
  // `encrypted`: with TLS, whose certificate is not checked, and HTTP/2.
  explicit RawConnection(int port, bool encrypted = false);
  ~RawConnection();
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  // False once either side has closed the connection.
  bool open() const { return socket_ >= 0; }
  // Writes all bytes, and keeps what arrives meanwhile if `read` is true. False if the connection ends, or if the
  // server takes nothing for five seconds.
  bool Send(std::string_view bytes, bool read = true);
  // Waits for up to `seconds` until something arrives. Returns all that has arrived and was not returned yet.
  std::string Receive(double seconds);
  void Close();

 private:
  bool Encrypt();
  void ReadArrived();
  bool WriteSome(std::string_view& bytes);

  int socket_ = -1;
  std::unique_ptr<SSL, decltype(&SSL_free)> tls_{nullptr, &SSL_free};
  std::string arrived_;
};

// --- HTTP/1.1 ---

// Returns the status code of the response to `request`; 0 if the connection ends without one, -1 without one in 5 s.
int StatusOf(int port, std::string_view request);

// --- HTTP/2 ---

using http2::Frame, http2::FrameType, http2::HeaderBlock, http2::CallHeaders;
using http2::kEndStream, http2::kAck, http2::kEndHeaders;

// Returns a gRPC message with its prefix.
std::string GrpcMessage(std::string_view message);

// An HTTP/2 connection that knows what the server allows it to send. Not thread-safe.
class Http2 {
 public:
  explicit Http2(int port, bool encrypted = false);

  bool open() const { return connection_.open() && !gone_; }
  // Opens a stream. Returns its number.
  std::uint32_t Open(const Headers& headers, bool end = false);
  // Sends a whole call.
  std::uint32_t Call(const std::string& path, const Headers& more, std::string_view message);
  // Sends as much of the data as the server's windows allow. Returns how much.
  std::size_t SendData(std::uint32_t stream, std::string_view data);
  bool Send(std::string_view frames, bool read = true) { return connection_.Send(frames, read); }
  // Waits for up to `seconds` for frames, and answers SETTINGS and PING.
  void Read(double seconds);

  // The number of streams that the server has ended, and of frames with data; an error alone has none.
  int ended() const { return static_cast<int>(ended_.size()); }
  int data_frames() const { return data_frames_; }

 private:
  void TakeFrame(const http2::FrameHead& head, std::string_view payload);
  void TakeSettings(std::string_view payload);

  RawConnection connection_;
  std::string unread_;
  std::uint32_t next_ = 1;
  bool gone_ = false;
  std::set<std::uint32_t> ended_;
  int data_frames_ = 0;
  std::int64_t window_ = 65535, first_window_ = 65535;
  std::map<std::uint32_t, std::int64_t> windows_;  // by stream
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_RAW_H_
