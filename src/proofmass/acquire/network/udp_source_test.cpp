#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire::udp_source_test {
namespace {

using ::testing::HasSubstr;

/// A socket of the loopback interface; bound, so that no other program uses its port.
class Socket {
 public:
  Socket() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() { ::close(socket_); }

  unsigned short bind_to_any() {
    (void)::bind(socket_, reinterpret_cast<const sockaddr*>(&address_), sizeof(address_));
    sockaddr_in bound{};
    socklen_t size = sizeof(bound);
    (void)::getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size);
    return ntohs(bound.sin_port);
  }
  void send(unsigned short port, const std::string& packet) {
    address_.sin_port = htons(port);
    (void)::sendto(socket_, packet.data(), packet.size(), 0,
                   reinterpret_cast<const sockaddr*>(&address_), sizeof(address_));
  }

 private:
  int socket_;
  sockaddr_in address_{};
};

unsigned short free_port() {
  return Socket().bind_to_any();
}

/// Sends during its lifetime: opening the source needs some rows to determine the columns.
class Sender {
 public:
  Sender(unsigned short port, std::string packet)
      : thread_([this, port, packet = std::move(packet)] {
          while (!stops_) {
            socket_.send(port, packet);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
        }) {}
  ~Sender() {
    stops_ = true;
    thread_.join();
  }

 private:
  Socket socket_;
  std::atomic<bool> stops_ = false;
  std::thread thread_;
};

Result<std::unique_ptr<Source>> opened(unsigned short port,
                                       const std::string& settings,
                                       const std::string& packet) {
  const Sender sender(port, packet);
  return open_source("udp:" + std::to_string(port) + settings,
                     {.patience = std::chrono::seconds(30)});
}

/// All rows up to the one whose second value is `last`; the first is their counter.
struct Taken {
  std::vector<double> second;
  std::uint64_t lost = 0;
};

Taken take_until(Source& source, double last) {
  Taken taken;
  Arrival arrival;
  for (int i = 0; i < 600 && (taken.second.empty() || taken.second.back() != last); ++i) {
    const auto arrived = source.read(arrival, std::chrono::milliseconds(100));
    EXPECT_TRUE(arrived);
    taken.lost += arrival.lost_before;
    taken.second.insert(taken.second.end(), arrival.channels[1].begin(), arrival.channels[1].end());
  }
  return taken;
}

TEST(UdpSource, TakesLinesAndFramesAndJson) {
  for (const auto& [settings, packet] :
       {std::pair{"", "0.5,1.5,2.5\n"}, std::pair{"?columns=x,y,z", "0.5,1.5,2.5\n0.5,1.5,2.5\n"},
        std::pair{"", "{\"acc\":{\"x\":0.5,\"y\":1.5,\"z\":2.5}}"},
        std::pair{"", "x:0.5,y:1.5,z:2.5"}}) {
    const auto source = opened(free_port(), settings, packet);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->head().recording.channels.size(), 3U) << packet;
    Arrival arrival;
    ASSERT_EQ((*source)->read(arrival, std::chrono::seconds(10)).value(), Arrived::rows);
    EXPECT_EQ(arrival.channels[2].front(), 2.5) << packet;
  }
}

TEST(UdpSource, ACounterTellsWhatIsMissing) {
  const unsigned short port = free_port();
  const auto source = opened(port, "?columns=n,x&counter=n", "0,7\n1,8\n");
  ASSERT_TRUE(source) << source.error().message;
  Socket sender;
  for (const char* packet : {"10,100\n11,101\n", "15,102\n", "16,999\n"}) sender.send(port, packet);
  const Taken taken = take_until(**source, 999.0);
  ASSERT_GE(taken.second.size(), 4U);
  EXPECT_EQ(taken.second[taken.second.size() - 2], 102.0);
  EXPECT_GE(taken.lost, 3U) << "12, 13 and 14";
}

TEST(UdpSource, NothingIsNoError) {
  const auto source = opened(free_port(), "", "1,2,3\n");
  ASSERT_TRUE(source);
  Arrival arrival;
  Arrived last = Arrived::rows;
  for (int i = 0; i < 1000 && last == Arrived::rows; ++i)
    last = (*source)->read(arrival, std::chrono::milliseconds(200)).value();
  EXPECT_EQ(last, Arrived::nothing);
}

TEST(UdpSource, APortInUseIsTold) {
  Socket other;
  const unsigned short port = other.bind_to_any();
  const auto source = open_source("udp:" + std::to_string(port));
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::device);
  EXPECT_THAT(source.error().message, HasSubstr("Address already in use"));
}

TEST(UdpSource, SilenceAtTheStartIsTold) {
  const auto source = open_source("udp:" + std::to_string(free_port()),
                                  {.patience = std::chrono::milliseconds(50)});
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::device);
}

TEST(UdpSource, NeedsAPort) {
  for (const char* uri : {"udp:", "udp:127.0.0.1", "udp:0", "udp:127.0.0.1:99999", "udp:9870?x=1"})
    EXPECT_EQ(open_source(uri).error().code, Errc::invalid_argument) << uri;
}

TEST(ShownUri, HasNoPassword) {
  EXPECT_EQ(shown_uri("mqtt://h/t?user=me&password=secret&rate=5"),
            "mqtt://h/t?user=me&password=…&rate=5");
  EXPECT_EQ(shown_uri("mqtt://h/t?password=secret"), "mqtt://h/t?password=…");
  EXPECT_EQ(shown_uri("mqtt://me:secret@h/t?rate=5"), "mqtt://…@h/t?rate=5");
  EXPECT_EQ(shown_uri("serial:/dev/tty?unit=@"), "serial:/dev/tty?unit=@");
  EXPECT_EQ(shown_uri("mqtt://h/no-password=x?rate=5"), "mqtt://h/no-password=x?rate=5");
}

}  // namespace
}  // namespace proofmass::acquire::udp_source_test
