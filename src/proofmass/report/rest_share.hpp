#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "proofmass/report/json.hpp"

// How much of a recording that should be at rest is: what `noise` and `drift` say of it.
namespace proofmass::report {

/// How much of a recording is at rest, and its longest rest.
struct RestShare {
  double share = 0.0;
  double longest_start_s = 0.0, longest_end_s = 0.0;  ///< on the recording's clock; equal if none

  /// What is left out by a knock or next to the ends is no motion.
  [[nodiscard]] bool is_at_rest() const { return share >= 0.9; }
};

/// "Not at rest: … The figures are of the motion, not of the sensor's noise; …", or empty.
/// `what` is "noise" or "drift".
[[nodiscard]] std::string motion_sentence(const std::optional<RestShare>& rest,
                                          std::string_view what);

/// The same of several channels, in short: "Not at rest (x, y): the figures are of the motion."
[[nodiscard]] std::string motion_sentence_of_channels(const std::string& names);

/// The key `rest` of a channel.
[[nodiscard]] Value rest_value(const std::optional<RestShare>& rest);

/// Why something in `rest` is null; empty where nothing is.
[[nodiscard]] std::string rest_null_reason(const std::optional<RestShare>& rest);

}  // namespace proofmass::report
