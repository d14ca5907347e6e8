#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "proofmass/acquire/stream/byte_pump.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

struct SerialSettings {
  std::string device;
  unsigned baud = 115'200;
  bool hardware_flow = false;  ///< RTS and CTS
};

/// A serial device at 8N1, opened exclusively; earlier input is discarded.
struct SerialPort {
  std::unique_ptr<BytePump> feed;
  unsigned baud = 0;  ///< as granted
};

/// Errors: device (absent, no permission, in use, not a serial device; with a remedy).
[[nodiscard]] Result<SerialPort> open_serial_port(const SerialSettings& settings);

/// Sets any baud rate, not only the named ones, and reads back the granted one; 0 if the driver
/// refuses.
[[nodiscard]] unsigned set_baud(int descriptor, unsigned baud);

}  // namespace proofmass::acquire
