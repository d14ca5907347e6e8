#pragma once

#include <string>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

// Components of the online analyses' columns, and their common options.
namespace proofmass::estimate {

[[nodiscard]] inline Channel live_column(const char* name, Quantity quantity, const char* symbol) {
  return {name, {quantity, 1.0, 0.0, symbol}, {}};
}
[[nodiscard]] inline Channel angle_column(const char* name) {
  return live_column(name, Quantity::angle, "rad");
}
[[nodiscard]] inline Channel rate_column(const char* name) {
  return live_column(name, Quantity::angular_rate, "rad/s");
}
[[nodiscard]] inline Channel time_column(const char* name) {
  return live_column(name, Quantity::time, "s");
}
[[nodiscard]] inline Channel number_column(const char* name) {
  return live_column(name, Quantity::unknown, "");
}

struct LiveTimes {
  double rate_hz = 0.0, start_s = 0.0, lag_s = 0.0, most_rate_hz = 0.0;
};
/// Errors: invalid_argument.
[[nodiscard]] Status check_live_times(const LiveTimes& times);

}  // namespace proofmass::estimate
