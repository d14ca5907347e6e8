#include "proofmass/core/recording.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/repeated_rows.hpp"

namespace proofmass {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// A channel name split into stem and axis: "Acc_X" is axis x of "acc_"; axis is 0 if there is
/// none.
struct AxisName {
  std::string sensor;
  char axis = 0;
};

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// The axis letter is the last x, y or z that is not followed by a letter and that either starts a
/// word ("x1", "Acc_X", "Accelerometer Z") or ends the usual short forms ("ax", "accx", "AccelY").
AxisName axis_of(std::string_view name) {
  const std::string text = lower(name);
  for (std::size_t i = text.size(); i-- > 0;) {
    const char c = text[i];
    if (c < 'x' || c > 'z') continue;
    if (i + 1 < text.size() && is_letter(text[i + 1])) continue;
    std::size_t word = i;
    while (word > 0 && is_letter(text[word - 1])) --word;
    constexpr std::array<std::string_view, 9> stems{
        "", "a", "acc", "accel", "accelerometer", "acceleration", "f", "gf", "ch"};
    if (std::ranges::find(stems, std::string_view(text).substr(word, i - word)) == stems.end())
      continue;
    return {text.substr(0, i) + "?" + text.substr(i + 1), c};
  }
  return {};
}

bool may_be_accelerometer(const Channel& channel, bool any_acceleration) {
  const Quantity quantity = channel.unit.quantity;
  if (any_acceleration) return quantity == Quantity::acceleration;
  return quantity == Quantity::voltage || quantity == Quantity::counts;
}

std::string tidy(std::string sensor) {
  std::erase(sensor, '?');
  while (!sensor.empty() && !std::isalnum(static_cast<unsigned char>(sensor.back())))
    sensor.pop_back();
  return sensor.empty() ? "accelerometer" : sensor;
}

/// The labels of the samples `kept` (ascending), by their new numbers.
std::vector<Label> cut_labels(const std::vector<Label>& labels,
                              const std::vector<std::size_t>& kept) {
  std::vector<Label> parts;
  for (const Label& label : labels) {
    const auto first = std::ranges::lower_bound(kept, label.first) - kept.begin();
    const auto end = std::ranges::upper_bound(kept, label.last) - kept.begin();
    if (first == end) continue;
    parts.push_back(
        {label.text, static_cast<std::size_t>(first), static_cast<std::size_t>(end) - 1});
  }
  return parts;
}

/// The samples `kept` (at least one), with time counted from the first.
Recording samples_of(const Recording& recording, const std::vector<std::size_t>& kept) {
  Recording part{recording.source, recording.format, recording.time, {}, recording.notes, 0};
  const double origin_s = recording.time.at(kept.front());
  if (part.time.start_ns) *part.time.start_ns += static_cast<std::int64_t>(origin_s * 1e9);
  part.time.stamps_s.clear();
  if (!recording.time.is_uniform())
    for (const std::size_t k : kept) part.time.stamps_s.push_back(recording.time.at(k) - origin_s);
  for (const Channel& channel : recording.channels) {
    Channel& copy = part.channels.emplace_back(Channel{channel.name, channel.unit, {}});
    std::vector<double>& values = copy.values.edit();
    values.reserve(kept.size());
    for (const std::size_t k : kept) values.push_back(channel.values[k]);
  }
  if (recording.first_line > 0) part.first_line = recording.first_line + kept.front();
  part.labels = cut_labels(recording.labels, kept);
  part.label_channel = recording.label_channel;
  return part;
}

}  // namespace

const Channel* Recording::find(std::string_view name) const {
  for (const Channel& channel : channels)
    if (channel.name == name) return &channel;
  const std::string wanted = lower(name);
  for (const Channel& channel : channels)
    if (lower(channel.name) == wanted) return &channel;
  return nullptr;
}

Result<Recording> cut(const Recording& recording, double from_s, double to_s) {
  if (!(from_s < to_s))
    return Error{Errc::invalid_argument, "the window must begin before it ends"};
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < recording.samples(); ++k)
    if (recording.time.at(k) >= from_s && recording.time.at(k) < to_s) kept.push_back(k);
  if (kept.empty())
    return Error{Errc::too_few_samples, "no sample lies in the window; the recording lasts " +
                                            std::to_string(recording.duration_s()) + " s"};
  return samples_of(recording, kept);
}

Recording with_rising_stamps(const Recording& recording) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < recording.samples(); ++k)
    if (kept.empty() || recording.time.at(k) > recording.time.at(kept.back())) kept.push_back(k);
  return kept.size() == recording.samples() ? recording : samples_of(recording, kept);
}

Recording without_repeated_rows(Recording recording) {
  if (recording.time.is_uniform()) return recording;
  const auto equals_previous = [&](std::size_t k) {
    return std::ranges::all_of(recording.channels, [k](const Channel& channel) {
      const double value = channel.values[k], previous = channel.values[k - 1];
      return value == previous || (std::isnan(value) && std::isnan(previous));
    });
  };
  // Pairs of adjacent rows, and those with equal values.
  struct Pairs {
    std::size_t all = 0, equal = 0;
  };
  Pairs of_one_time, of_two;
  std::vector<std::size_t> kept{0};
  for (std::size_t k = 1; k < recording.samples(); ++k) {
    const bool same_time = recording.time.stamps_s[k] == recording.time.stamps_s[k - 1];
    const bool equal = equals_previous(k);
    Pairs& pairs = same_time ? of_one_time : of_two;
    ++pairs.all;
    pairs.equal += equal ? 1 : 0;
    if (!same_time || !equal) kept.push_back(k);
  }
  const std::size_t repeats = of_one_time.equal;
  const bool are_repeats =
      repeats > 0 && 10 * repeats >= 9 * of_one_time.all && 2 * of_two.equal < of_two.all;
  if (!are_repeats) return recording;
  Recording once = samples_of(recording, kept);
  const bool one = repeats == 1;
  once.notes.push_back({Severity::warning,
                        fmt::format("{} the one before, stamp and values, and {} left out",
                                    one ? "1 row repeats" : fmt::format("{} rows repeat", repeats),
                                    one ? "is" : "are")});
  return once;
}

std::vector<Triad> accelerometer_triads(const Recording& recording) {
  const bool any_acceleration = std::ranges::any_of(recording.channels, [](const Channel& c) {
    return c.unit.quantity == Quantity::acceleration;
  });
  std::vector<Triad> triads;
  std::vector<std::string> sensors;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    if (!may_be_accelerometer(recording.channels[i], any_acceleration)) continue;
    const AxisName name = axis_of(recording.channels[i].name);
    if (name.axis == 0) continue;
    auto at = static_cast<std::size_t>(std::ranges::find(sensors, name.sensor) - sensors.begin());
    if (at == sensors.size()) {
      sensors.push_back(name.sensor);
      triads.push_back({tidy(name.sensor), {}, {}, {}});
    }
    auto& slot = name.axis == 'x' ? triads[at].x : name.axis == 'y' ? triads[at].y : triads[at].z;
    if (!slot) slot = i;
  }
  return triads;
}

}  // namespace proofmass
