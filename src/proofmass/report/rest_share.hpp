#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/report/fields.hpp"

// What `noise` and `drift` share: whether the recording is at rest, and channels that cannot be
// analysed.
namespace proofmass::report {

/// How much of a recording is at rest, and its longest rest.
struct RestShare {
  double share = 0.0;
  double longest_start_s = 0.0, longest_end_s = 0.0;  ///< on the recording's clock; equal if none

  /// What a knock or the ends leave out is not motion.
  [[nodiscard]] bool is_at_rest() const { return share >= 0.9; }
};

/// "Not at rest: … The figures describe the motion, not the sensor's noise; …", or empty.
/// `what` is "noise" or "drift".
[[nodiscard]] std::string motion_sentence(const std::optional<RestShare>& rest,
                                          std::string_view what);

/// The same for several channels, in short: "Not at rest (x, y): the figures describe the motion."
[[nodiscard]] std::string motion_sentence_of_channels(const std::string& names);

/// The entry `rest` of a channel.
[[nodiscard]] Field rest_field(const std::optional<RestShare>& rest);

template <class Channel>
[[nodiscard]] std::string why_not_analysed(const Channel& channel) {
  return "not analysed: " + channel.refused;
}

/// Why no channel could be analysed, or empty where one was.
template <class Channels>
[[nodiscard]] std::string why_no_channel(const Channels& channels) {
  const auto is_analysed = [](const auto& channel) { return channel.refused.empty(); };
  if (channels.empty() || std::ranges::any_of(channels, is_analysed)) return {};
  const auto& first = channels.front();
  return "no channel can be analysed: " + first.name + ": " + first.refused;
}

}  // namespace proofmass::report
