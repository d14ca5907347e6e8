#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// "Dev1/ai0:2,ai7" as "Dev1/ai0", "Dev1/ai1", "Dev1/ai2", "Dev1/ai7": a channel without a device
/// belongs to the device before it. Errors: invalid_argument.
[[nodiscard]] Result<std::vector<std::string>> daqmx_channels(std::string_view text);

/// Channel names in a recording: without the device if there is only one.
[[nodiscard]] std::vector<std::string> daqmx_names(const std::vector<std::string>& channels);

/// "Dev1" of "Dev1/ai0".
[[nodiscard]] std::string daqmx_device_of(const std::string& channel);

}  // namespace proofmass::acquire
