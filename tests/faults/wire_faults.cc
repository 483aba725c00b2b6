#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>

#include <algorithm>
#include <atomic>
#include <boost/asio.hpp>
#include <cmath>
#include <limits>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/compare.pb.h"
#include "phrenic/v1/control.pb.h"
#include "phrenic/v1/export.pb.h"
#include "phrenic/v1/frames.pb.h"
#include "phrenic/v1/server.pb.h"
#include "phrenic/v1/study.pb.h"
#include "phrenic/v1/upload.pb.h"
#include "tests/faults/faults.h"

namespace phrenic::faults {
namespace {

using boost::asio::ip::tcp;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// A proxy between a client and the server that delays bytes by up to `max_delay` [s], until it is cut.
class Proxy {
 public:
  explicit Proxy(const std::string& address, double max_delay = 2e-4)
      : max_delay_(max_delay), thread_([this, address] { Run(address); }) {
    while (port_ == 0) std::this_thread::yield();
  }
  ~Proxy() {
    cut_ = true;
    thread_.join();
  }
  std::string address() const { return absl::StrCat("127.0.0.1:", port_.load()); }
  void Cut() { cut_ = true; }

 private:
  // Serves one connection at a time, as the client opens no more.
  void Run(const std::string& address) {
    boost::asio::io_context io;
    tcp::acceptor acceptor(io, {boost::asio::ip::address_v4::loopback(), 0});
    acceptor.non_blocking(true);
    port_ = acceptor.local_endpoint().port();
    const auto server_port = static_cast<unsigned short>(std::stoi(address.substr(address.rfind(':') + 1)));
    boost::system::error_code error;
    while (!cut_) {
      tcp::socket client(io), server(io);
      acceptor.accept(client, error);
      if (error) {
        absl::SleepFor(absl::Milliseconds(1));
        continue;
      }
      server.connect({boost::asio::ip::address_v4::loopback(), server_port}, error);
      client.non_blocking(true), server.non_blocking(true);
      std::uniform_real_distribution<double> delay(0, max_delay_);
      while (!cut_ && Forward(client, server) && Forward(server, client)) absl::SleepFor(absl::Seconds(delay(random_)));
    }
  }
  static bool Forward(tcp::socket& from, tcp::socket& to) {
    char bytes[4096];
    boost::system::error_code error;
    const std::size_t read = from.read_some(boost::asio::buffer(bytes), error);
    if (error == boost::asio::error::would_block) return true;
    if (error) return false;
    to.non_blocking(false);
    boost::asio::write(to, boost::asio::buffer(bytes, read), error);
    to.non_blocking(true);
    return !error;
  }

  const double max_delay_;  // [s]
  std::mt19937 random_{5};
  std::atomic<bool> cut_ = false;
  std::atomic<unsigned short> port_ = 0;
  std::thread thread_;
};

std::string RandomText(std::mt19937& random) {
  static const char* const kWords[] = {"",         "victim",      "thorax", "sheet-2d", "../../etc/passwd",
                                       "\xc3\xa4", "breath_force"};
  if (random() % 2 == 0) return kWords[random() % std::size(kWords)];
  std::string text(random() % 40, 'a');
  for (char& c : text) c = static_cast<char>(32 + random() % 95);
  return text;
}

double RandomNumber(std::mt19937& random) {
  static const double kNumbers[] = {0,
                                    -1,
                                    1,
                                    1e-300,
                                    1e300,
                                    -1e18,
                                    0.001,
                                    7,
                                    1e9,
                                    std::numeric_limits<double>::quiet_NaN(),
                                    std::numeric_limits<double>::infinity()};
  return kNumbers[random() % std::size(kNumbers)];
}

void Fill(std::mt19937& random, int depth, Message& message);

void FillField(std::mt19937& random, int depth, const FieldDescriptor& field, Message& message) {
  const auto& reflection = *message.GetReflection();
  const bool many = field.is_repeated();
  const double number = RandomNumber(random);
  const auto whole = static_cast<std::int64_t>(std::isfinite(number) ? std::clamp(number, -2e9, 2e9) : random());
  const auto set = [&](auto one, auto add, auto value) {
    many ? (reflection.*add)(&message, &field, value) : (reflection.*one)(&message, &field, value);
  };
  using R = google::protobuf::Reflection;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return set(&R::SetInt32, &R::AddInt32, static_cast<std::int32_t>(whole));
    case FieldDescriptor::CPPTYPE_INT64:
      return set(&R::SetInt64, &R::AddInt64, whole);
    case FieldDescriptor::CPPTYPE_UINT32:
      return set(&R::SetUInt32, &R::AddUInt32, static_cast<std::uint32_t>(whole));
    case FieldDescriptor::CPPTYPE_UINT64:
      return set(&R::SetUInt64, &R::AddUInt64, static_cast<std::uint64_t>(whole));
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return set(&R::SetDouble, &R::AddDouble, number);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return set(&R::SetFloat, &R::AddFloat, static_cast<float>(number));
    case FieldDescriptor::CPPTYPE_BOOL:
      return set(&R::SetBool, &R::AddBool, whole % 2 == 0);
    case FieldDescriptor::CPPTYPE_ENUM:
      return set(&R::SetEnumValue, &R::AddEnumValue, static_cast<int>(random() % 8));
    case FieldDescriptor::CPPTYPE_STRING:
      return set(&R::SetString, &R::AddString,
                 field.type() == FieldDescriptor::TYPE_BYTES ? std::string(random() % 100, static_cast<char>(random()))
                                                             : RandomText(random));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return Fill(random, depth - 1,
                  many ? *reflection.AddMessage(&message, &field) : *reflection.MutableMessage(&message, &field));
  }
}

void Fill(std::mt19937& random, int depth, Message& message) {
  if (depth == 0) return;
  const auto& type = *message.GetDescriptor();
  for (int f = 0; f < type.field_count(); ++f) {
    if (random() % 2 == 0) FillField(random, depth, *type.field(f), message);
  }
}

// Returns every method of every service.
std::vector<const google::protobuf::MethodDescriptor*> Methods() {
  std::vector<const google::protobuf::MethodDescriptor*> methods;
  for (const google::protobuf::Descriptor* message :
       {v1::CompareRequest::descriptor(), v1::EnterSessionRequest::descriptor(), v1::CreateExportRequest::descriptor(),
        v1::WatchFramesRequest::descriptor(), v1::GetServerRequest::descriptor(),
        v1::CreateSessionRequest::descriptor(), v1::CreateStudyRequest::descriptor(),
        v1::ListSurfaceFormatsRequest::descriptor()}) {
    const google::protobuf::FileDescriptor& file = *message->file();
    for (int s = 0; s < file.service_count(); ++s) {
      for (int m = 0; m < file.service(s)->method_count(); ++m) methods.push_back(file.service(s)->method(m));
    }
  }
  return methods;
}

// Makes one call with a timeout of 0.5 s and ignores its result.
void CallOnce(grpc::GenericStub& stub, const google::protobuf::MethodDescriptor& method, const Message& request) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(500));
  const grpc::Slice slice(request.SerializeAsString());
  const grpc::ByteBuffer bytes(&slice, 1);
  grpc::CompletionQueue queue;
  const std::string path = absl::StrCat("/", method.service()->full_name(), "/", method.name());
  const auto call = stub.PrepareUnaryCall(&context, path, bytes, &queue);
  call->StartCall();
  grpc::ByteBuffer response;
  grpc::Status status;
  call->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  queue.Shutdown();
  while (queue.Next(&tag, &ok)) continue;
}

void SendBytes(const std::string& address, const std::string& bytes) {
  boost::asio::io_context io;
  tcp::socket socket(io);
  boost::system::error_code error;
  const auto port = static_cast<unsigned short>(std::stoi(address.substr(address.rfind(':') + 1)));
  socket.connect({boost::asio::ip::address_v4::loopback(), port}, error);
  if (!error) boost::asio::write(socket, boost::asio::buffer(bytes), error);
}

}  // namespace

Tally LineCut(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  for (int i = 0; i < times; ++i) {
    Proxy proxy(rig.server().address());
    rig.driver().Connect(proxy.address());
    rig.Disturb([&proxy] { proxy.Cut(); });
    rig.Recover(tally);
  }
  return tally;
}

// Responses are late, some later than the client's timeout, so that it repeats the call.
Tally Delayed(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  for (int i = 0; i < times; ++i) {
    Proxy proxy(rig.server().address(), 0.4);
    rig.driver().Connect(proxy.address());
    rig.Disturb([] { absl::SleepFor(absl::Seconds(1)); });
    rig.Recover(tally);
  }
  return tally;
}

// Random requests may affect all sessions but the driven one, whose id they do not use.
Tally RandomRequests(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  const auto channel = grpc::CreateChannel(rig.server().address(), grpc::InsecureChannelCredentials());
  grpc::GenericStub stub(channel);
  const auto methods = Methods();
  google::protobuf::DynamicMessageFactory factory;
  constexpr int kBatch = 50;
  for (int i = 0; i < times; i += kBatch) {
    rig.Disturb([&] {
      for (int k = 0; k < kBatch; ++k) {
        const auto& method = *methods[rig.random()() % methods.size()];
        const std::unique_ptr<Message> request(factory.GetPrototype(method.input_type())->New());
        Fill(rig.random(), 4, *request);
        CallOnce(stub, method, *request);
      }
    });
    rig.Recover(tally);
    tally.tried += kBatch - 1;
  }
  return tally;
}

Tally RandomBytes(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  static const char* const kStarts[] = {"", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", "GET / HTTP/1.1\r\n",
                                        "POST /phrenic.v1.",
                                        "POST /phrenic.v1.SessionService/GetSession HTTP/1.1\r\nHost: localhost\r\n"
                                        "Content-Type: application/grpc-web+proto\r\nContent-Length: 100\r\n\r\n"};
  for (int i = 0; i < times; ++i) {
    rig.Disturb([&] {
      std::string bytes = kStarts[rig.random()() % std::size(kStarts)];
      for (int k = 0; k < 200; ++k) bytes.push_back(static_cast<char>(rig.random()()));
      SendBytes(i % 2 == 0 ? rig.server().address() : rig.server().web_address(), bytes);
    });
    rig.Recover(tally);
  }
  return tally;
}

}  // namespace phrenic::faults
