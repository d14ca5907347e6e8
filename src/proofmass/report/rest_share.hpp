#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/report/fields.hpp"

// Shared by `noise` and `drift`: whether the recording is at rest, and channels that cannot be
// analysed.
namespace proofmass::report {

/// Fraction of a recording at rest, and its longest rest.
struct RestShare {
  double share = 0.0;
  double longest_start_s = 0.0, longest_end_s = 0.0;  ///< on the recording's clock; equal if
                                                      ///< there is none

  /// The remainder, excluded around outliers and at the ends, is not motion.
  [[nodiscard]] bool is_at_rest() const { return share >= 0.9; }
};

/// "Not at rest: … The figures describe the motion, not the sensor's noise; …", or empty.
/// `what` is "noise" or "drift".
[[nodiscard]] std::string motion_sentence(const std::optional<RestShare>& rest,
                                          std::string_view what);

/// The same for several channels, abbreviated: "Not at rest (x, y): the figures describe the
/// motion."
[[nodiscard]] std::string motion_sentence_of_channels(const std::string& names);

/// The entry `rest` of a channel.
[[nodiscard]] Field rest_field(const std::optional<RestShare>& rest);

template <class Channel>
[[nodiscard]] std::string why_not_analysed(const Channel& channel) {
  return "not analysed: " + channel.refused;
}

/// Reason why no channel could be analysed; empty if at least one was.
template <class Channels>
[[nodiscard]] std::string why_no_channel(const Channels& channels) {
  const auto is_analysed = [](const auto& channel) { return channel.refused.empty(); };
  if (channels.empty() || std::ranges::any_of(channels, is_analysed)) return {};
  const auto& first = channels.front();
  return "no channel can be analysed: " + first.name + ": " + first.refused;
}

}  // namespace proofmass::report
