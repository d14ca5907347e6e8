#pragma once

#include <cstdint>
#include <optional>

namespace proofmass::io::ximu {

/// The x-IMU's rate for a register's value: 2^(value - 1) Hz up to 512; nullopt if it is off.
/// Source: x-io Technologies, x-IMU User Manual 5.2, "Data rates".
[[nodiscard]] constexpr std::optional<double> rate_hz_of(std::uint64_t value) {
  if (value < 1 || value > 10) return std::nullopt;
  return static_cast<double>(std::uint64_t{1} << (value - 1));
}

/// The rate of this many rows in this many whole seconds: the nearest available rate of the device,
/// if it is within a tenth.
[[nodiscard]] constexpr std::optional<double> rate_counted(std::uint64_t rows, double seconds) {
  constexpr double shortest_s = 10.0;  // whole seconds have an error of 1 s at both ends
  if (!(seconds >= shortest_s)) return std::nullopt;
  const double counted_hz = static_cast<double>(rows) / seconds;
  for (std::uint64_t value = 1; value <= 10; ++value) {
    const double rate_hz = *rate_hz_of(value);
    if (counted_hz > 0.9 * rate_hz && counted_hz < 1.1 * rate_hz) return rate_hz;
  }
  return std::nullopt;
}

}  // namespace proofmass::io::ximu
