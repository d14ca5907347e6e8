#include "proofmass/serve/server.hpp"

#include <arpa/inet.h>
#include <atomic>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "proofmass/serve/temporary.hpp"

namespace proofmass::serve::server_test {
namespace {

using namespace std::chrono_literals;

const std::string token = "0123456789abcdef0123456789abcdef";

/// A socket to the server, as bare as it can be.
class Peer {
 public:
  explicit Peer(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{20, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    is_open_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() { ::close(socket_); }

  void send(const std::string& text) const {
    (void)::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// All that comes until the server closes the connection.
  [[nodiscard]] std::string rest() const {
    std::string all;
    char piece[4096];
    for (ssize_t got = 1; (got = ::recv(socket_, piece, sizeof piece, 0)) > 0;)
      all.append(piece, static_cast<std::size_t>(got));
    return all;
  }
  [[nodiscard]] bool is_open() const { return is_open_; }

 private:
  int socket_;
  bool is_open_ = false;
};

class ServerTest : public testing::Test {
 protected:
  void start(ServerLimits limits = {}) {
    server_ = Server::listen({.token = token,
                              .upload_folder = folder_.path(),
                              .page = "<p>nothing of the folder</p>",
                              .content_security_policy = "default-src 'none'",
                              .limits = limits},
                             [this](const Request& request) { return answer(request); })
                  .value();
    thread_ = std::thread([this] { server_->run([this] { return ended_.load(); }); });
  }
  void TearDown() override {
    ended_ = true;
    if (thread_.joinable()) thread_.join();
  }
  Response answer(const Request& request) {
    if (request.target.path == "/throws") throw std::runtime_error("odd");
    if (request.target.path == "/slow") std::this_thread::sleep_for(300ms);
    if (request.target.path == "/large") return {200, std::string(std::size_t{64} << 20, 'x')};
    if (request.method == "PUT") {
      std::ifstream in(request.body_path);
      return {200, fmt::format("put {}", std::string(std::istreambuf_iterator<char>(in), {}))};
    }
    return {200, fmt::format("{} {} {}", request.method, request.target.path, request.body)};
  }
  [[nodiscard]] std::string host() const { return fmt::format("127.0.0.1:{}", server_->port()); }
  [[nodiscard]] std::string head(const std::string& first, const std::string& more = {}) const {
    return fmt::format("{} HTTP/1.1\r\nHost: {}\r\n{}\r\n", first, host(), more);
  }
  /// The status line and all after it, of a request on a connection of its own.
  [[nodiscard]] std::string ask(const std::string& request) const {
    const Peer peer(server_->port());
    peer.send(request);
    return peer.rest();
  }
  [[nodiscard]] std::string get(const std::string& path) const {
    return ask(head(fmt::format("GET {}?token={}", path, token), "Connection: close\r\n"));
  }
  static int status(const std::string& reply) {
    return reply.size() > 12 ? std::stoi(reply.substr(9, 3)) : 0;
  }

  TemporaryFolder folder_ = TemporaryFolder::make(testing::TempDir()).value();
  std::unique_ptr<Server> server_;
  std::thread thread_;
  std::atomic<bool> ended_ = false;
};

TEST_F(ServerTest, AnswersWhoHasTheToken) {
  start();
  const std::string reply = get("/api/info");
  EXPECT_EQ(status(reply), 200);
  EXPECT_TRUE(reply.ends_with("GET /api/info "));
}

TEST_F(ServerTest, EveryAnswerForbidsWhatThePageDoesNotNeed) {
  start();
  for (const std::string& reply : {get("/x"), ask(head("GET /"))}) {
    EXPECT_NE(reply.find("Content-Security-Policy: default-src 'none'\r\n"), std::string::npos);
    EXPECT_NE(reply.find("X-Content-Type-Options: nosniff\r\n"), std::string::npos);
    EXPECT_EQ(reply.find("Access-Control"), std::string::npos);
    EXPECT_EQ(reply.find(token), std::string::npos);
  }
}

TEST_F(ServerTest, RefusesBeforeItAnswers) {
  start();
  EXPECT_EQ(status(ask(head("GET /api/info"))), 403);
  EXPECT_EQ(status(ask(head("GET /api/info?token=" + token, "Origin: http://evil.example\r\n"))),
            403);
  EXPECT_EQ(status(ask("GET /?token=" + token + " HTTP/1.1\r\nHost: evil.example\r\n\r\n")), 421);
  EXPECT_EQ(status(ask("GET /?token=" + token + " HTTP/1.1\r\n\r\n")), 421);
  EXPECT_EQ(status(ask(head("OPTIONS /?token=" + token, "Origin: http://" + host() + "\r\n"))),
            405);
  EXPECT_EQ(status(ask(head("GET /%zz"))), 400);
  EXPECT_EQ(status(ask("no http at all\r\n\r\n")), 400);
}

TEST_F(ServerTest, WithoutATokenThePageIsAShellUnder403) {
  start();
  const std::string reply = ask(head("GET /"));
  EXPECT_EQ(status(reply), 403);
  EXPECT_TRUE(reply.ends_with("<p>nothing of the folder</p>"));
  EXPECT_EQ(status(get("/")), 200);
}

TEST_F(ServerTest, BoundsHeadAndBody) {
  start({.head_bytes = 2000, .body_bytes = 100, .upload_bytes = 1000});
  const std::string target = "/?token=" + token;
  EXPECT_EQ(status(ask(head("GET " + target, "X: " + std::string(3000, 'x') + "\r\n"))), 431);
  EXPECT_EQ(status(ask(head("POST " + target, "Content-Length: 101\r\n") + std::string(101, 'x'))),
            413);
  EXPECT_EQ(status(ask(head("PUT " + target, "Content-Length: 1001\r\n") + std::string(1001, 'x'))),
            413);
  EXPECT_EQ(
      status(ask(head("POST /a?token=" + token, "Connection: close\r\nContent-Length: 100\r\n") +
                 std::string(100, 'x'))),
      200);
}

TEST_F(ServerTest, AnUploadIsAFileWhileItIsAnsweredAndGoneAfterwards) {
  start();
  const std::string reply = ask(
      head("PUT /api/files/a.csv?token=" + token, "Connection: close\r\nContent-Length: 3\r\n") +
      "abc");
  EXPECT_TRUE(reply.ends_with("put abc")) << reply;
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(ServerTest, AnUploadThatBreaksOffLeavesNoFile) {
  start({.stall = 100ms});
  {
    const Peer peer(server_->port());
    peer.send(head("PUT /api/files/a.csv?token=" + token, "Content-Length: 1000\r\n") + "abc");
    EXPECT_EQ(peer.rest(), "");
  }
  for (int k = 0; k < 6000 && !std::filesystem::is_empty(folder_.path()); ++k)
    std::this_thread::sleep_for(10ms);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(ServerTest, SilentConnectionsAreClosedInTime) {
  start({.head = 100ms});
  const Peer silent(server_->port());
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(silent.rest(), "");
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 60s);
}

TEST_F(ServerTest, TwoHundredSilentConnectionsDoNotStopTheOneThatWorks) {
  start();
  std::vector<std::unique_ptr<Peer>> silent;
  for (int k = 0; k < 200; ++k) silent.push_back(std::make_unique<Peer>(server_->port()));
  for (int k = 0; k < 20; ++k) EXPECT_EQ(status(get("/api/info")), 200);
}

TEST_F(ServerTest, ASlowReaderIsDropped) {
  start({.stall = 300ms});
  const Peer slow(server_->port());
  slow.send(head("GET /large?token=" + token));
  std::this_thread::sleep_for(1s);
  EXPECT_LT(slow.rest().size(), std::size_t{64} << 20);
}

TEST_F(ServerTest, BoundsTheRateOfRequestsAndOfRefusalsApart) {
  start({.requests_per_s = 1});
  int refused = 0, closed = 0;
  for (int k = 0; k < 30; ++k)
    if (status(ask(head("GET /api/info"))) == 0) ++closed;
  EXPECT_GT(closed, 10);
  for (int k = 0; k < 30; ++k)
    if (status(get("/x")) == 429) ++refused;
  EXPECT_GT(refused, 10);
  EXPECT_LT(refused, 30);
}

TEST_F(ServerTest, AHandlerThatThrowsIsA500AndNothingElse) {
  start();
  EXPECT_EQ(status(get("/throws")), 500);
  EXPECT_EQ(status(get("/x")), 200);
}

TEST_F(ServerTest, KeepsAConnectionForSeveralRequests) {
  start();
  const Peer peer(server_->port());
  const std::string request = head("GET /a?token=" + token);
  peer.send(request + request + head("GET /b?token=" + token, "Connection: close\r\n"));
  const std::string all = peer.rest();
  EXPECT_NE(all.find("GET /a "), all.rfind("GET /a "));
  EXPECT_TRUE(all.ends_with("GET /b "));
}

TEST_F(ServerTest, EndsWhileARequestIsAnswered) {
  start();
  const Peer peer(server_->port());
  peer.send(head("GET /slow?token=" + token));
  std::this_thread::sleep_for(50ms);
  ended_ = true;
  thread_.join();
  EXPECT_FALSE(Peer(server_->port()).is_open());
}

TEST_F(ServerTest, SaysWhyItCannotListen) {
  start();
  const auto taken = Server::listen({.port = server_->port(), .token = token}, {});
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().message.find("cannot be listened on"), std::string::npos);
  EXPECT_FALSE(Server::listen({.address = "localhost.example", .token = token}, {}));
}

}  // namespace
}  // namespace proofmass::serve::server_test
