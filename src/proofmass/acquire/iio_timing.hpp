#pragma once

#include <iio.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// What takes the samples of a device, and how often.
struct IioTiming {
  double rate_hz = 0.0;    ///< granted; 0 unknown
  std::string why_silent;  ///< what to say if no sample comes
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<Note> notes;
};

/// Sets the trigger (the one that is named; else the one that is set; else the first that the
/// device takes; else none) and the rate: the trigger's own where it has one, else the device's,
/// which means nothing under another's trigger. Errors: invalid_argument (no such trigger), device
/// (the device refuses the trigger, or one of the two the rate: why, and what it takes).
[[nodiscard]] Result<IioTiming> set_timing(const iio_context* context,
                                           iio_device* device,
                                           const std::string& trigger,
                                           std::optional<double> rate_hz);

}  // namespace proofmass::acquire
