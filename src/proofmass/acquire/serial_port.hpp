#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "proofmass/acquire/byte_feed.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

struct SerialSettings {
  std::string device;
  unsigned baud = 115'200;
  bool hardware_flow = false;  ///< RTS and CTS
};

/// A serial device at 8N1, ours alone; what had come before is thrown away.
struct SerialPort {
  std::unique_ptr<ByteFeed> feed;
  unsigned baud = 0;  ///< as granted
};

/// Errors: device (not there, no permission, in use, no serial device; what to do).
[[nodiscard]] Result<SerialPort> open_serial_port(const SerialSettings& settings);

/// Sets any baud rate, not only those that have a name, and reads back what was granted; 0 where
/// the driver refuses.
[[nodiscard]] unsigned set_baud(int descriptor, unsigned baud);

}  // namespace proofmass::acquire
