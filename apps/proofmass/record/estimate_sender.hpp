#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::app {

/// `record --send-to`: each estimate as one datagram of JSON, {"time_s": 1.25, "angle": 0.1, …}, to
/// udp:HOST:PORT, or to a Unix datagram socket that the reader has bound to unix:PATH.
///
/// The recorder never waits for a reader: what the socket does not take at once is dropped and
/// counted, also while nobody listens.
class EstimateSender {
 public:
  /// Throws Failure (usage) for an address that is none, or a host without an address.
  explicit EstimateSender(const std::string& address);
  ~EstimateSender();
  EstimateSender(const EstimateSender&) = delete;
  EstimateSender& operator=(const EstimateSender&) = delete;

  void estimating(const std::vector<Channel>& columns);
  void estimates(const Block& rows);

  [[nodiscard]] std::uint64_t sent() const { return sent_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  void connect_udp(const std::string& host_and_port);
  void connect_unix(const std::string& path);
  void send(const std::string& datagram);

  int socket_ = -1;
  std::vector<char> peer_;  ///< address of the reader
  std::vector<std::string> names_;
  std::uint64_t sent_ = 0, dropped_ = 0;
};

}  // namespace proofmass::app
