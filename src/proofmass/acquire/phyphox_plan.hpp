#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/acquire/phyphox_messages.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::acquire {

/// Buffers that fill together: a sensor's values and their time.
struct PhyphoxGroup {
  std::string sensor;  ///< "accelerometer", "gyroscope"; a label's words where no input fills them
  std::string time;    ///< buffer, in seconds
  std::vector<std::string> buffers{};
  std::vector<Unit> units{};
};

/// What the URI asks for; empty: the accelerometer, and the gyroscope if there is one.
struct PhyphoxWish {
  std::vector<std::string> sensors{};  ///< "gyroscope", as the experiment's inputs are called
  std::vector<std::string> buffers{};  ///< instead of sensors
  std::string time{};                  ///< buffer of their time
};

/// Errors: invalid_argument (what was asked for is not in the experiment), device (no acceleration
/// in it), each with what there is.
[[nodiscard]] Result<std::vector<PhyphoxGroup>> plan_phyphox(const PhyphoxConfig& config,
                                                             const PhyphoxWish& wish);

}  // namespace proofmass::acquire
