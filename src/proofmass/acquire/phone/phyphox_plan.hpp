#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/acquire/phone/phyphox_messages.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::acquire {

/// Buffers that fill together: a sensor's values and their times.
struct PhyphoxGroup {
  std::string sensor;  ///< "accelerometer", "gyroscope"; words of a label if no input fills them
  std::string time;    ///< buffer name, in seconds
  std::vector<std::string> buffers{};
  std::vector<Unit> units{};
};

/// Request of the URI; empty: the accelerometer, and the gyroscope if there is one.
struct PhyphoxWish {
  std::vector<std::string> sensors{};  ///< "gyroscope", by the names of the experiment's inputs
  std::vector<std::string> buffers{};  ///< instead of sensors
  std::string time{};                  ///< buffer of their times
};

/// Errors: invalid_argument (a requested item is not in the experiment), device (no acceleration in
/// it), each with the available items.
[[nodiscard]] Result<std::vector<PhyphoxGroup>> plan_phyphox(const PhyphoxConfig& config,
                                                             const PhyphoxWish& wish);

}  // namespace proofmass::acquire
