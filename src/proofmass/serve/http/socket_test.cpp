// The WebSocket of a server, from a client as bare as it can be (RFC 6455, section 5.2).
#include <arpa/inet.h>
#include <atomic>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <memory>
#include <mutex>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "proofmass/serve/live/request.hpp"
#include "proofmass/serve/server.hpp"

namespace proofmass::serve::socket_test {
namespace {

using namespace std::chrono_literals;

const std::string token = "0123456789abcdef0123456789abcdef";

class Client {
 public:
  explicit Client(std::uint16_t port, int receive_bytes = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{60, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (receive_bytes > 0)
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    (void)::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { ::close(socket_); }

  void send(const std::string& bytes) const {
    (void)::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  /// A masked frame with FIN; the mask is 0, which is allowed.
  void frame(int opcode, const std::string& text) const {
    std::string out{static_cast<char>(0x80 | opcode)};
    if (text.size() < 126) {
      out += static_cast<char>(0x80 | text.size());
    } else {
      out += static_cast<char>(0xfe);
      out += static_cast<char>(text.size() >> 8U);
      out += static_cast<char>(text.size() & 0xffU);
    }
    send(out + std::string(4, '\0') + text);
  }
  [[nodiscard]] std::string bytes(std::size_t count) const {
    std::string out(count, '\0');
    const ssize_t got = ::recv(socket_, out.data(), count, MSG_WAITALL);
    out.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return out;
  }
  [[nodiscard]] std::string head() const {
    std::string out;
    while (!out.ends_with("\r\n\r\n")) {
      const std::string one = bytes(1);
      if (one.empty()) break;
      out += one;
    }
    return out;
  }
  /// The next text message; empty once the connection is closed.
  [[nodiscard]] std::string message() const {
    const std::string begin = bytes(2);
    if (begin.size() < 2 || (begin[0] & 0x0f) != 1) return {};
    std::size_t size = static_cast<unsigned char>(begin[1]);
    if (size >= 126) {
      const std::string more = bytes(size == 126 ? 2 : 8);
      size = 0;
      for (const char c : more) size = size << 8U | static_cast<unsigned char>(c);
    }
    return bytes(size);
  }
  [[nodiscard]] bool is_closed() const {
    for (;;) {
      const std::string one = bytes(1);
      if (one.empty()) return true;
    }
  }

 private:
  int socket_;
};

class SocketTest : public testing::Test {
 protected:
  void start(ServerLimits limits = {}) {
    server_ =
        Server::listen(
            {.token = token,
             .live = [this](const auto& from, std::string_view text) { return take(from, text); },
             .limits = limits},
            [](const Request&) { return Response{200, "ok"}; })
            .value();
    thread_ = std::thread([this] { server_->run([this] { return ended_.load(); }); });
  }
  void TearDown() override {
    ended_ = true;
    if (thread_.joinable()) thread_.join();
  }
  Status take(const std::shared_ptr<LiveListener>& from, std::string_view text) {
    const auto request = parse_live_request(text);
    if (!request) return request.error();
    const std::lock_guard lock(mutex_);
    listeners_.push_back(from);
    return Done{};
  }
  void send_to_all(const std::shared_ptr<const LiveFrame>& frame) {
    const std::lock_guard lock(mutex_);
    for (const auto& one : listeners_)
      if (const auto listener = one.lock()) listener->take(7, frame);
  }
  void wait_for_listeners(std::size_t count) {
    for (int k = 0; k < 6000; ++k) {
      {
        const std::lock_guard lock(mutex_);
        if (listeners_.size() >= count) return;
      }
      std::this_thread::sleep_for(10ms);
    }
    FAIL() << "no listener came";
  }
  [[nodiscard]] std::string request(const std::string& target, const std::string& more = {}) const {
    return fmt::format(
        "GET {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n{}\r\n",
        target, server_->port(), more);
  }
  [[nodiscard]] std::string good() const { return request("/api/live/socket?token=" + token); }
  [[nodiscard]] int status(const std::string& text) const {
    const Client client(server_->port());
    client.send(text);
    const std::string head = client.head();
    return head.size() > 12 ? std::stoi(head.substr(9, 3)) : 0;
  }
  [[nodiscard]] std::unique_ptr<Client> open(int receive_bytes = 0) const {
    auto client = std::make_unique<Client>(server_->port(), receive_bytes);
    client->send(good());
    // The key above and this answer are those of RFC 6455, section 1.3.
    EXPECT_NE(client->head().find("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="), std::string::npos);
    return client;
  }

  std::unique_ptr<Server> server_;
  std::thread thread_;
  std::atomic<bool> ended_ = false;
  std::mutex mutex_;
  std::vector<std::weak_ptr<LiveListener>> listeners_;
};

std::shared_ptr<const LiveFrame> rows_frame(std::size_t number, std::size_t bytes) {
  return frame_of(
      fmt::format("{{\"rows\":{{\"n\":{},\"x\":\"{}\"}}}}", number, std::string(bytes, 'x')));
}

TEST_F(SocketTest, PassesTheSameChecksAsEveryRequest) {
  start();
  EXPECT_EQ(status(good()), 101);
  EXPECT_EQ(status(request("/api/live/socket")), 403);
  EXPECT_EQ(status(request("/api/live/socket?token=" + std::string(32, '0'))), 403);
  EXPECT_EQ(status(request("/api/live/socket?token=" + token, "Origin: http://evil.example\r\n")),
            403);
  EXPECT_EQ(status(request("/api/live/socket?token=" + token, "Origin: null\r\n")), 403);
  EXPECT_EQ(status("GET /api/live/socket?token=" + token +
                   " HTTP/1.1\r\nHost: evil.example\r\nUpgrade: websocket\r\n"
                   "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                   "Sec-WebSocket-Version: 13\r\n\r\n"),
            421);
  EXPECT_EQ(status(request("/api/other?token=" + token)), 404);
}

TEST_F(SocketTest, BringsFramesInTheirOrderWithTheirSource) {
  start();
  const auto client = open();
  client->frame(1, R"({"watch": 7})");
  wait_for_listeners(1);
  send_to_all(frame_of(R"({"head":{"rate_hz":1000}})"));
  send_to_all(rows_frame(0, 10));
  const auto first = nlohmann::json::parse(client->message());
  EXPECT_EQ(first["source"], 7);
  EXPECT_EQ(first["left_out"], 0);
  EXPECT_EQ(first["frame"]["head"]["rate_hz"], 1000);
  EXPECT_EQ(nlohmann::json::parse(client->message())["frame"]["rows"]["n"], 0);
}

TEST_F(SocketTest, AMessageThatIsNoneClosesTheConnection) {
  start();
  for (const char* text : {"", "{}", R"({"watch": -1})", R"({"stop": 7})", "\xff"}) {
    const auto client = open();
    client->frame(1, text);
    EXPECT_TRUE(client->is_closed()) << text;
  }
  const auto binary = open();
  binary->frame(2, R"({"watch": 7})");
  EXPECT_TRUE(binary->is_closed());
  const auto unmasked = open();
  unmasked->send(std::string("\x81\x0c") + R"({"watch": 7})");
  EXPECT_TRUE(unmasked->is_closed());
}

TEST_F(SocketTest, ALongMessageClosesTheConnectionBeforeItIsRead) {
  start({.socket_message_bytes = 100});
  const auto client = open();
  client->frame(1, R"({"watch": 7})" + std::string(100, ' '));
  EXPECT_TRUE(client->is_closed());
  // A length of 2^62 bytes is refused by its head.
  const auto huge = open();
  huge->send(std::string("\x81\xff\x40\0\0\0\0\0\0\0\0\0\0\0", 14));
  EXPECT_TRUE(huge->is_closed());
}

TEST_F(SocketTest, WhoeverAsksTooOftenLosesTheConnection) {
  start();
  const auto client = open();
  for (int k = 0; k < 100; ++k) client->frame(1, R"({"watch": 7})");
  EXPECT_TRUE(client->is_closed());
  const std::lock_guard lock(mutex_);
  EXPECT_LT(listeners_.size(), 60U);
}

TEST_F(SocketTest, BoundsTheNumberOfBrowsers) {
  start({.sockets = 2});
  const auto one = open(), two = open();
  EXPECT_EQ(status(good()), 503);
}

TEST_F(SocketTest, ASlowBrowserLosesTheOldestFramesAndSeesTheirNumber) {
  start({.socket_queue_frames = 8});
  const auto client = open(4096);
  client->frame(1, R"({"watch": 7})");
  wait_for_listeners(1);
  // Far more than the buffers of the two sockets hold.
  constexpr std::size_t frames = 200, bytes = 100'000;
  for (std::size_t k = 0; k < frames; ++k) send_to_all(rows_frame(k, bytes));
  std::size_t seen = 0, last = 0, left_out = 0;
  while (last + 1 < frames) {
    const auto said = nlohmann::json::parse(client->message());
    const auto number = said["frame"]["rows"]["n"].get<std::size_t>();
    EXPECT_TRUE(seen == 0 || number > last);
    last = number;
    left_out = said["left_out"].get<std::size_t>();
    ++seen;
  }
  EXPECT_EQ(seen + left_out, frames);
  EXPECT_GT(left_out, 100U);
}

TEST_F(SocketTest, FramesThatMustNotBeLeftOutEndASlowBrowser) {
  start({.socket_queue_bytes = 1'000'000});
  const auto client = open(4096);
  client->frame(1, R"({"watch": 7})");
  wait_for_listeners(1);
  for (int k = 0; k < 100; ++k)
    send_to_all(frame_of(fmt::format("{{\"event\":\"{}\"}}", std::string(100'000, 'x'))));
  EXPECT_TRUE(client->is_closed());
}

TEST_F(SocketTest, ABrowserThatTakesNothingIsDropped) {
  start({.stall = 300ms});
  const auto client = open(4096);
  client->frame(1, R"({"watch": 7})");
  wait_for_listeners(1);
  for (std::size_t k = 0; k < 60; ++k) send_to_all(rows_frame(k, 100'000));
  for (int k = 0; k < 6000; ++k) {
    {
      const std::lock_guard lock(mutex_);
      if (listeners_.front().expired()) return;
    }
    std::this_thread::sleep_for(10ms);
  }
  FAIL() << "it is still there";
}

TEST_F(SocketTest, TwoHundredSilentConnectionsDoNotStopTheOneThatWorks) {
  start();
  const auto client = open();
  client->frame(1, R"({"watch": 7})");
  wait_for_listeners(1);
  std::vector<std::unique_ptr<Client>> silent;
  for (int k = 0; k < 200; ++k) silent.push_back(std::make_unique<Client>(server_->port()));
  for (std::size_t k = 0; k < 20; ++k) {
    send_to_all(rows_frame(k, 1000));
    EXPECT_EQ(nlohmann::json::parse(client->message())["frame"]["rows"]["n"], k);
  }
  EXPECT_EQ(status(good()), 101);
}

TEST_F(SocketTest, EndsWithTheServer) {
  start();
  const auto client = open();
  ended_ = true;
  thread_.join();
  EXPECT_TRUE(client->is_closed());
}

}  // namespace
}  // namespace proofmass::serve::socket_test
