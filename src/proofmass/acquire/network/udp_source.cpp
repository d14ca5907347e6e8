#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include "proofmass/acquire/source_list.hpp"
#include "proofmass/acquire/stream/byte_pump.hpp"

namespace proofmass::acquire {
namespace {

struct Addresses {
  addrinfo* list = nullptr;
  Addresses() = default;
  Addresses(const Addresses&) = delete;
  Addresses& operator=(const Addresses&) = delete;
  ~Addresses() {
    if (list != nullptr) ::freeaddrinfo(list);
  }
};

Error cannot_listen(const HostPort& at, const char* why) {
  return {Errc::device, fmt::format("cannot listen at {} port {}: {}", at.host, *at.port, why)};
}

/// Datagrams of a bound socket.
class UdpFeed final : public BytePump {
 public:
  explicit UdpFeed(int socket) : socket_(socket) {}
  ~UdpFeed() override { ::close(socket_); }

  Result<Fed> read(std::span<char> into, std::chrono::milliseconds patience) override {
    if (!wait_readable(socket_, patience)) return Fed{};
    iovec space{into.data(), into.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(std::uint32_t))> control{};
    msghdr message{};
    message.msg_iov = &space;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t bytes = ::recvmsg(socket_, &message, MSG_DONTWAIT);
    if (bytes >= 0) return Fed{static_cast<std::size_t>(bytes), false, dropped(message)};
    if (errno == EINTR || errno == EAGAIN) return Fed{};
    return Error{Errc::device, fmt::format("the socket fails: {}", std::strerror(errno))};
  }

 private:
  /// Datagrams dropped by the kernel since the previous one. Source: socket(7), SO_RXQ_OVFL.
  std::uint64_t dropped(msghdr& message) {
    const std::uint32_t before = overflow_;
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c))
      if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL)
        std::memcpy(&overflow_, CMSG_DATA(c), sizeof(overflow_));
    return overflow_ - before;  // a 32-bit count that wraps
  }

  int socket_;
  std::uint32_t overflow_ = 0;
};

/// Requests the largest buffer; returns the granted size.
int widen(int socket) {
  constexpr int wished_bytes = 16 << 20;
  // Only root may exceed the system's limit.
  if (::setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &wished_bytes, sizeof(wished_bytes)) != 0)
    (void)::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &wished_bytes, sizeof(wished_bytes));
  int granted = 0;
  socklen_t size = sizeof(granted);
  (void)::getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &granted, &size);
  return granted;
}

Result<int> bound_socket(const HostPort& at) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  Addresses found;
  const int problem =
      ::getaddrinfo(at.host.c_str(), std::to_string(*at.port).c_str(), &wanted, &found.list);
  if (problem != 0) return cannot_listen(at, ::gai_strerror(problem));
  const addrinfo& address = *found.list;
  const int socket = ::socket(address.ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return cannot_listen(at, std::strerror(errno));
  if (::bind(socket, address.ai_addr, address.ai_addrlen) == 0) return socket;
  const int why = errno;
  ::close(socket);
  return cannot_listen(at, std::strerror(why));
}

/// "9870" is that port on the loopback interface, which no other computer can reach.
Result<HostPort> host_port_of(const std::string& place) {
  const bool is_port = !place.empty() && place.find_first_not_of("0123456789") == std::string::npos;
  auto at = parse_host_port(is_port ? "127.0.0.1:" + place : place);
  if (at && !at->port)
    return Error{Errc::invalid_argument, "expected a port, as in udp:9870 or udp:0.0.0.0:9870"};
  return at;
}

}  // namespace

Result<std::unique_ptr<Source>> open_udp(SourceUri& uri, const OpenOptions& options) {
  const auto at = host_port_of(uri.place());
  if (!at) return at.error();
  const auto framing = framing_options(uri, Carrier::datagrams);
  if (!framing) return framing.error();
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  const auto socket = bound_socket(*at);
  if (!socket) return socket.error();
  auto feed = std::make_unique<UdpFeed>(*socket);
  constexpr int on = 1;
  (void)::setsockopt(*socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on));
  SourceHead head;
  head.recording.source = uri.text();
  head.recording.format = "UDP";
  head.settings.emplace_back("address", fmt::format("{} port {}", at->host, *at->port));
  head.settings.emplace_back("receive buffer", fmt::format("{} bytes", widen(*socket)));
  return open_stream(std::move(feed), *framing, std::move(head), options);
}

}  // namespace proofmass::acquire
