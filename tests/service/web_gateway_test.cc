#include "tests/support/raw_socket.h"
// After Boost, which needs <utility> first.
#include <filesystem>
#include <fstream>
#include <thread>

#include "absl/strings/escaping.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

std::string Post(const std::string& method, const std::string& body, const std::string& headers = "",
                 const std::string& type = "application/grpc-web+proto") {
  return absl::StrCat("POST /phrenic.v1.", method, " HTTP/1.1\r\nHost: phrenic.test\r\nContent-Type: ", type,
                      "\r\nX-Grpc-Web: 1\r\n", headers, "Content-Length: ", body.size(), "\r\n\r\n", body);
}

template <class Request>
std::string Text(const std::string& text) {
  Request request;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &request)) << text;
  return WebMessage(request.SerializeAsString());
}

class WebGatewayTest : public ServerFixture {
 protected:
  WebGatewayTest() {
    root_ = fs::path(testing::TempDir()) / absl::StrCat("phrenic-web-", getpid());
    fs::create_directories(root_ / "site" / "assets");
    std::ofstream(root_ / "secret.txt") << "secret";
    std::ofstream(root_ / "site" / "index.html") << "<!doctype html><title>Phrenic</title>";
    std::ofstream(root_ / "site" / "assets" / "main-1a2b.js") << "export {};";
    options_.web_root = (root_ / "site").string();
    options_.max_connections = 8;
    options_.allowed_hosts = {"phrenic.test"};
    options_.limits.viewers = 16;
  }
  ~WebGatewayTest() override { fs::remove_all(root_); }

  RawSocket Connect() { return RawSocket(server_->web_port()); }
  RawSocket::Response Ask(const std::string& request) {
    RawSocket socket(server_->web_port());
    auto response = socket.Ask(request);
    EXPECT_TRUE(response.has_value()) << "the server disconnected after " << request.substr(0, 60);
    return response.value_or(RawSocket::Response());
  }
  RawSocket::Response Get(const std::string& target, const std::string& headers = "") {
    return Ask("GET " + target + " HTTP/1.1\r\nHost: phrenic.test\r\n" + headers + "\r\n");
  }

  fs::path root_;
};

TEST_F(WebGatewayTest, AUnaryCallIsAMessageAndTrailers) {
  CreateCube("cube");
  const auto response = Ask(Post("SessionService/GetSession", Text<v1::GetSessionRequest>("session_id: 'cube'")));
  EXPECT_EQ(response.result(), http::status::ok);
  EXPECT_EQ(response[http::field::content_type], "application/grpc-web+proto");
  const auto frames = WebFrames(response.body());
  ASSERT_EQ(frames.size(), 2u);
  v1::GetSessionResponse got;
  EXPECT_EQ(frames[0].flags, 0);
  ASSERT_TRUE(got.ParseFromString(frames[0].bytes));
  EXPECT_EQ(got.session().id(), "cube");
  EXPECT_EQ(frames[1].flags, 0x80);
  EXPECT_EQ(frames[1].bytes, "grpc-status: 0\r\n");
}

TEST_F(WebGatewayTest, AnErrorIsTrailersWithStatusAndEscapedMessage) {
  const auto response =
      Ask(Post("SessionService/GetSession", Text<v1::GetSessionRequest>("session_id: '\\303\\244%'")));
  const auto frames = WebFrames(response.body());
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].flags, 0x80);
  EXPECT_THAT(frames[0].bytes,
              StartsWith("grpc-status: 5\r\ngrpc-message: session_id: there is no session \"%C3%A4%25\""));
}

TEST_F(WebGatewayTest, TextIsBase64BothWays) {
  CreateCube("cube");
  const std::string body = absl::Base64Escape(Text<v1::GetSessionRequest>("session_id: 'cube'"));
  const auto response = Ask(Post("SessionService/GetSession", body, "", "application/grpc-web-text"));
  EXPECT_EQ(response[http::field::content_type], "application/grpc-web-text+proto");
  // Each frame is base64 with its own padding.
  std::string bytes, decoded, rest = response.body();
  while (!rest.empty()) {
    const std::size_t padding = rest.find('=');
    const std::size_t end = padding == std::string::npos ? rest.size() : rest.find_first_not_of('=', padding);
    ASSERT_TRUE(absl::Base64Unescape(rest.substr(0, end), &decoded));
    bytes += decoded;
    rest = end == std::string::npos ? "" : rest.substr(end);
  }
  const auto frames = WebFrames(bytes);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].bytes, "grpc-status: 0\r\n");
}

TEST_F(WebGatewayTest, CallsFollowEachOtherOnOneConnection) {
  CreateCube("cube");
  RawSocket socket = Connect();
  for (int i = 0; i < 20; ++i) {
    const auto response =
        socket.Ask(Post("SessionService/GetSession", Text<v1::GetSessionRequest>("session_id: 'cube'")));
    ASSERT_TRUE(response.has_value()) << i;
    EXPECT_EQ(WebFrames(response->body()).size(), 2u);
  }
  const auto page = socket.Ask("GET / HTTP/1.1\r\nHost: phrenic.test\r\n\r\n");
  ASSERT_TRUE(page.has_value());
  EXPECT_EQ(page->result(), http::status::ok);
}

TEST_F(WebGatewayTest, AServerStreamEndsWhenTheBrowserDisconnects) {
  CreateCube("cube");
  v1::PlaySessionResponse played;
  ASSERT_TRUE(Call(*sessions_, &v1::SessionService::Stub::PlaySession, "session_id: 'cube'", &played).ok());
  const auto viewers = [&] {
    v1::GetSessionResponse got;
    EXPECT_TRUE(Call(*sessions_, &v1::SessionService::Stub::GetSession, "session_id: 'cube'", &got).ok());
    return got.session().viewers();
  };
  {
    RawSocket socket = Connect();
    socket.Send(Post("FrameService/WatchFrames", Text<v1::WatchFramesRequest>("session_id: 'cube'")));
    const std::string bytes = socket.ReadSome(4000);
    EXPECT_GE(bytes.size(), 4000u);
    EXPECT_THAT(bytes, HasSubstr("Transfer-Encoding: chunked"));
    EXPECT_EQ(viewers(), 1);
  }
  bool left = false;
  for (int i = 0; i < 500 && !left; ++i) {
    left = viewers() == 0;
    if (!left) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(left) << "the call continues without a browser";
}

TEST_F(WebGatewayTest, AStreamEndsWithItsStatusInTrailers) {
  CreateCube("cube");
  RawSocket socket = Connect();
  socket.Send(Post("FrameService/WatchFrames", Text<v1::WatchFramesRequest>("session_id: 'cube'")));
  socket.ReadSome(100);
  v1::DeleteSessionResponse deleted;
  ASSERT_TRUE(Call(*sessions_, &v1::SessionService::Stub::DeleteSession, "session_id: 'cube'", &deleted).ok());
  std::string tail, more;
  while (tail.find("\r\n0\r\n\r\n") == std::string::npos && !(more = socket.ReadSome(1)).empty()) tail += more;
  EXPECT_THAT(tail, HasSubstr("grpc-status: 5\r\ngrpc-message: session cube was deleted\r\n"));
}

TEST_F(WebGatewayTest, ADeadlineEndsACall) {
  CreateCube("cube");
  const auto response = Ask(
      Post("FrameService/WatchFrames", Text<v1::WatchFramesRequest>("session_id: 'cube'"), "Grpc-Timeout: 200m\r\n"));
  const auto frames = WebFrames(response.body());
  ASSERT_FALSE(frames.empty());
  EXPECT_THAT(frames.back().bytes, StartsWith("grpc-status: 4\r\n"));
}

TEST_F(WebGatewayTest, AMethodThatDoesNotExistIsUnimplemented) {
  const auto response = Ask(Post("SessionService/Nonsense", WebMessage("")));
  ASSERT_EQ(WebFrames(response.body()).size(), 1u);
  EXPECT_THAT(WebFrames(response.body())[0].bytes, StartsWith("grpc-status: 12\r\n"));
}

TEST_F(WebGatewayTest, ABodyThatIsNotOneMessageIsRefused) {
  for (const std::string& body : {std::string(), std::string("\0\0\0", 3), std::string("\0\0\0\0\x09xx", 7),
                                  std::string("\x01\0\0\0\0", 5), WebMessage("") + "x"}) {
    const auto frames = WebFrames(Ask(Post("SessionService/ListSessions", body)).body());
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_THAT(frames[0].bytes, StartsWith("grpc-status: 3\r\n"));
  }
}

TEST_F(WebGatewayTest, OnlyPagesOfAllowedOriginsMayCall) {
  const std::string call = WebMessage("");
  const auto status = [&](const std::string& origin) {
    return Ask(Post("SessionService/ListSessions", call, "Origin: " + origin + "\r\n"));
  };
  for (const char* good : {"http://phrenic.test", "http://localhost:5173", "http://127.0.0.1:1234"}) {
    const auto response = status(good);
    EXPECT_EQ(response.result(), http::status::ok) << good;
    EXPECT_EQ(response[http::field::access_control_allow_origin], good);
    EXPECT_THAT(std::string(response[http::field::access_control_expose_headers]), HasSubstr("grpc-status"));
  }
  for (const char* bad : {"http://evil.test", "null", "http://phrenic.test.evil.test", "http://localhost.evil.test",
                          "file://phrenic.test"}) {
    const auto response = status(bad);
    EXPECT_EQ(response.result(), http::status::forbidden) << bad;
    EXPECT_EQ(response.count(http::field::access_control_allow_origin), 0u) << bad;
  }
}

TEST_F(WebGatewayTest, APreflightAllowsTheRequestedHeaders) {
  const auto response =
      Ask("OPTIONS /phrenic.v1.SessionService/ListSessions HTTP/1.1\r\nHost: phrenic.test\r\nOrigin: "
          "http://localhost:5173\r\n"
          "Access-Control-Request-Method: POST\r\nAccess-Control-Request-Headers: content-type,x-grpc-web\r\n\r\n");
  EXPECT_EQ(response.result(), http::status::no_content);
  EXPECT_EQ(response[http::field::access_control_allow_origin], "http://localhost:5173");
  EXPECT_EQ(response[http::field::access_control_allow_headers], "content-type,x-grpc-web");
  EXPECT_THAT(std::string(response[http::field::access_control_allow_methods]), HasSubstr("POST"));
}

TEST_F(WebGatewayTest, FilesHaveTypeCachingAndPolicy) {
  const auto page = Get("/?session=thorax");
  EXPECT_EQ(page.result(), http::status::ok);
  EXPECT_THAT(page.body(), HasSubstr("<title>Phrenic</title>"));
  EXPECT_EQ(page[http::field::content_type], "text/html; charset=utf-8");
  EXPECT_EQ(page[http::field::cache_control], "no-cache");
  EXPECT_THAT(std::string(page["Content-Security-Policy"]), HasSubstr("script-src 'self'"));
  EXPECT_THAT(std::string(page["Content-Security-Policy"]), HasSubstr("frame-ancestors 'none'"));
  EXPECT_EQ(page["X-Content-Type-Options"], "nosniff");
  EXPECT_EQ(page["X-Frame-Options"], "DENY");
  EXPECT_EQ(page["Referrer-Policy"], "no-referrer");
  EXPECT_EQ(page["Cross-Origin-Opener-Policy"], "same-origin");
  EXPECT_EQ(page.count("Strict-Transport-Security"), 0u) << "HSTS without TLS";
  const auto script = Get("/assets/main-1a2b.js");
  EXPECT_EQ(script[http::field::content_type], "text/javascript; charset=utf-8");
  EXPECT_THAT(std::string(script[http::field::cache_control]), HasSubstr("immutable"));
  const auto again = Get("/", "If-None-Match: " + std::string(page[http::field::etag]) + "\r\n");
  EXPECT_EQ(again.result(), http::status::not_modified);
  EXPECT_TRUE(again.body().empty());
}

TEST_F(WebGatewayTest, AFileIsSentCompressedToThoseWhoAcceptIt) {
  const fs::path script = root_ / "site" / "assets" / "main-1a2b.js";
  std::ofstream(script.string() + ".br") << "as brotli";
  std::ofstream(script.string() + ".gz") << "as gzip";
  const auto get = [&](const std::string& accepted) {
    return Get("/assets/main-1a2b.js", accepted.empty() ? "" : "Accept-Encoding: " + accepted + "\r\n");
  };
  const std::pair<const char*, const char*> cases[] = {{"gzip, deflate, br", "br"},
                                                       {"br;q=1.0, gzip;q=0.8", "br"},
                                                       {"gzip", "gzip"},
                                                       {"br;q=0, gzip", "gzip"},
                                                       {"identity", ""},
                                                       {"", ""},
                                                       {"brotli", ""},
                                                       {";,;q=,br;q=0", ""}};
  for (const auto& [accepted, encoding] : cases) {
    const auto response = get(accepted);
    EXPECT_EQ(response[http::field::content_encoding], encoding) << accepted;
    EXPECT_EQ(response[http::field::vary], "Accept-Encoding") << accepted;
    EXPECT_EQ(response[http::field::content_type], "text/javascript; charset=utf-8") << accepted;
    EXPECT_EQ(response.body() == "export {};", *encoding == '\0') << accepted;
  }
  EXPECT_NE(get("br")[http::field::etag], get("gzip")[http::field::etag]);
  // What an earlier build left is not sent.
  fs::last_write_time(script.string() + ".br", fs::last_write_time(script) - std::chrono::hours(1));
  EXPECT_EQ(get("br")[http::field::content_encoding], "");
  EXPECT_EQ(get("br").body(), "export {};");
}

class FramedGatewayTest : public WebGatewayTest {
 protected:
  FramedGatewayTest() { options_.allowed_origins = {"https://course.example"}; }
};

TEST_F(FramedGatewayTest, AnAllowedOriginMayFrameTheViewer) {
  const auto page = Get("/?session=thorax&embed");
  EXPECT_THAT(std::string(page["Content-Security-Policy"]), HasSubstr("frame-ancestors https://course.example"));
}

TEST_F(WebGatewayTest, NoFileOutsideTheFolderIsServed) {
  fs::create_symlink(root_ / "secret.txt", root_ / "site" / "link.txt");
  for (const char* target : {"/../secret.txt", "/%2e%2e/secret.txt", "/assets/../../secret.txt", "/..%2fsecret.txt",
                             "//etc/passwd", "/%2fetc/passwd", "/link.txt", "/assets", "/missing.js"}) {
    const auto response = Get(target);
    EXPECT_EQ(response.result(), http::status::not_found) << target;
    EXPECT_EQ(response.body().find("secret"), std::string::npos) << target;
  }
  for (const char* target : {"/%00", "/%zz", "*"}) EXPECT_EQ(Get(target).result(), http::status::bad_request) << target;
}

TEST_F(WebGatewayTest, RandomBytesDoNoHarm) {
  const std::string large_header =
      "GET / HTTP/1.1\r\nHost: localhost\r\nX-Long: " + std::string(40'000, 'x') + "\r\n\r\n";
  for (const std::string& garbage :
       {std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11), std::string("GET\r\n\r\n"),
        std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"), std::string(20'000, '\0'), large_header,
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n"),
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n"),
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n")}) {
    RawSocket socket = Connect();
    const auto response = socket.Ask(garbage);
    if (!response.has_value()) continue;  // closing the connection is allowed, too
    EXPECT_GE(response->result_int(), 400u) << garbage.substr(0, 40);
    EXPECT_FALSE(socket.Ask("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").has_value())
        << "the connection stays open after garbage";
  }
  EXPECT_EQ(Get("/").result(), http::status::ok);
}

TEST_F(WebGatewayTest, UnsupportedMethodsAndTypesAreRefused) {
  EXPECT_EQ(Ask("PUT / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n").result(),
            http::status::method_not_allowed);
  EXPECT_EQ(Ask(Post("SessionService/ListSessions", "{}", "", "application/json")).result(),
            http::status::unsupported_media_type);
}

TEST_F(WebGatewayTest, ConnectionsAboveTheLimitAreRefusedWhileAllAreBusy) {
  CreateCube("cube");
  std::vector<std::unique_ptr<RawSocket>> sockets;
  for (int i = 0; i < 8; ++i) {
    sockets.push_back(std::make_unique<RawSocket>(server_->web_port()));
    sockets.back()->Send(Post("FrameService/WatchFrames", Text<v1::WatchFramesRequest>("session_id: 'cube'")));
    ASSERT_FALSE(sockets.back()->ReadSome(100).empty());
  }
  const auto refused = Connect().Read();
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->result(), http::status::service_unavailable);
  sockets.clear();
  bool room = false;
  for (int i = 0; i < 250 && !room; ++i) {
    const auto response = Connect().Ask("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    room = response.has_value() && response->result() == http::status::ok;
    if (!room) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(room);
}

TEST_F(WebGatewayTest, ANewConnectionReplacesTheOneThatWaitedLongest) {
  std::vector<std::unique_ptr<RawSocket>> sockets;
  for (int i = 0; i < 8; ++i) {
    sockets.push_back(std::make_unique<RawSocket>(server_->web_port()));
    ASSERT_TRUE(sockets.back()->Ask("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").has_value());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // until it waits for a request
  }
  EXPECT_EQ(Get("/").result(), http::status::ok);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(sockets.front()->ReadSome(1), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << "it was not closed";
  EXPECT_TRUE(sockets.back()->Ask("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").has_value());
}

TEST_F(WebGatewayTest, ShutdownEndsOpenStreams) {
  CreateCube("cube");
  RawSocket socket = Connect();
  socket.Send(Post("FrameService/WatchFrames", Text<v1::WatchFramesRequest>("session_id: 'cube'")));
  socket.ReadSome(100);
  const auto start = std::chrono::steady_clock::now();
  server_->Shutdown();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
}

}  // namespace
}  // namespace phrenic::service
