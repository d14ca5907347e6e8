#include "record/estimate_sender.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "cli/exit_status.hpp"

namespace proofmass::app {
namespace {

constexpr std::string_view udp = "udp:", unix_socket = "unix:";

template <class Address>
std::vector<char> bytes_of(const Address* address, std::size_t size) {
  std::vector<char> bytes(size);
  std::memcpy(bytes.data(), address, size);
  return bytes;
}

}  // namespace

EstimateSender::EstimateSender(const std::string& address) {
  if (address.starts_with(udp))
    connect_udp(address.substr(udp.size()));
  else if (address.starts_with(unix_socket))
    connect_unix(address.substr(unix_socket.size()));
  else
    throw Failure(usage, fmt::format("--send-to {}: expected udp:HOST:PORT or unix:PATH", address));
}

EstimateSender::~EstimateSender() {
  ::close(socket_);
}

void EstimateSender::connect_udp(const std::string& host_and_port) {
  const std::size_t colon = host_and_port.rfind(':');
  if (colon == std::string::npos || colon == 0)
    throw Failure(usage, "--send-to: expected udp:HOST:PORT, as udp:127.0.0.1:9000");
  std::string host = host_and_port.substr(0, colon);
  const std::string port = host_and_port.substr(colon + 1);
  if (host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), port.c_str(), &wanted, &found); error != 0)
    throw Failure(usage, fmt::format("--send-to udp:{}: {}", host_and_port, ::gai_strerror(error)));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned(found, ::freeaddrinfo);
  socket_ = ::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) throw Failure(failed, std::string("--send-to: ") + std::strerror(errno));
  peer_ = bytes_of(found->ai_addr, found->ai_addrlen);
}

void EstimateSender::connect_unix(const std::string& path) {
  sockaddr_un address{};
  if (path.empty() || path.size() >= sizeof address.sun_path)
    throw Failure(usage, fmt::format("--send-to unix:PATH: expected a path of 1 to {} bytes",
                                     sizeof address.sun_path - 1));
  address.sun_family = AF_UNIX;
  path.copy(static_cast<char*>(address.sun_path), path.size());
  socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) throw Failure(failed, std::string("--send-to: ") + std::strerror(errno));
  peer_ = bytes_of(&address, sizeof address);
}

void EstimateSender::estimating(const std::vector<Channel>& columns) {
  names_.clear();
  for (const Channel& column : columns) names_.push_back(column.name);
}

void EstimateSender::estimates(const Block& rows) {
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    std::string text = fmt::format(
        "{{\"time_s\":{:.6f}",
        rows.stamps_s.empty() ? static_cast<double>(rows.first + row) : rows.stamps_s[row]);
    for (std::size_t c = 0; c < rows.channels.size() && c < names_.size(); ++c) {
      const double value = rows.channels[c][row];
      text += std::isfinite(value) ? fmt::format(",\"{}\":{:.9g}", names_[c], value)
                                   : fmt::format(",\"{}\":null", names_[c]);
    }
    send(text += '}');
  }
}

void EstimateSender::send(const std::string& datagram) {
  const auto* to = static_cast<const sockaddr*>(static_cast<const void*>(peer_.data()));
  const auto taken =
      ::sendto(socket_, datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL, to,
               static_cast<socklen_t>(peer_.size()));
  ++(taken == static_cast<ssize_t>(datagram.size()) ? sent_ : dropped_);
}

}  // namespace proofmass::app
