#pragma once

#include <iio.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Trigger and rate of a device.
struct IioTiming {
  double rate_hz = 0.0;    ///< granted; 0 unknown
  std::string why_silent;  ///< message if no sample arrives
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<Note> notes;
};

/// Sets the trigger and the rate.
///
/// - Trigger: the one requested; else the one already set; else the first that the device accepts;
///   else none.
/// - Rate: that of the trigger if it has one, else that of the device, which has no meaning with
///   the trigger of another device.
///
/// Errors: invalid_argument (no such trigger), device (the device refuses the trigger, or one of
/// the two refuses the rate: the reason, and the accepted values).
[[nodiscard]] Result<IioTiming> set_timing(const iio_context* context,
                                           iio_device* device,
                                           const std::string& trigger,
                                           std::optional<double> rate_hz);

}  // namespace proofmass::acquire
