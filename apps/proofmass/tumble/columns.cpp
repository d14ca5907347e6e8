#include "tumble/columns.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "cli/exit_status.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/signal/resample/counter.hpp"

namespace proofmass::app {
namespace {

template <std::size_t N>
bool is_any(const std::string& name, const std::array<std::string_view, N>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 12> angle_names{
    "angle",    "theta",    "position", "tableangle",  "phi",     "angledeg",
    "anglerad", "thetadeg", "thetarad", "positiondeg", "encoder", "tilt"};
constexpr std::array<std::string_view, 7> std_names{"std",       "sigma",       "stdev",    "sem",
                                                    "stdofmean", "uncertainty", "outputstd"};
constexpr std::array<std::string_view, 4> direction_names{"direction", "dir", "way", "sense"};
constexpr std::array<std::string_view, 4> mount_names{"mount", "mounting", "mountdeg", "remount"};
constexpr std::array<std::string_view, 4> time_names{"time", "times", "t", "elapsed"};
constexpr std::array<std::string_view, 5> temperature_names{"temperature", "temp", "tempc",
                                                            "temperaturec", "temperaturedegc"};

std::optional<std::size_t> place_of(const Recording& recording, const std::string& name) {
  const Channel* channel = recording.find(name);
  if (channel == nullptr) return std::nullopt;
  return static_cast<std::size_t>(channel - recording.channels.data());
}

std::size_t named(const Recording& recording, const std::string& name, const char* flag) {
  const auto place = place_of(recording, name);
  if (!place)
    throw Failure(usage, fmt::format("{}: {}: no column '{}'", recording.source, flag, name));
  return *place;
}

template <std::size_t N>
std::optional<std::size_t> by_name(const Recording& recording,
                                   const std::array<std::string_view, N>& names) {
  for (std::size_t k = 0; k < recording.channels.size(); ++k)
    if (is_any(io::bare_name(recording.channels[k].name), names)) return k;
  return std::nullopt;
}

// By name, else the only column with a unit of angle.
std::optional<std::size_t> find_angle(const Recording& recording) {
  std::optional<std::size_t> found, only;
  std::size_t count = 0;
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    const Channel& channel = recording.channels[k];
    const bool fits = channel.unit.quantity == Quantity::angle ||
                      channel.unit.quantity == Quantity::unknown ||
                      channel.unit.quantity == Quantity::counts;
    if (!found && fits && is_any(io::bare_name(channel.name), angle_names)) found = k;
    if (channel.unit.quantity == Quantity::angle) {
      only = k;
      ++count;
    }
  }
  if (found) return found;
  return count == 1 ? only : std::nullopt;
}

// By unit, else by name.
std::optional<std::size_t> find_temperature(const Recording& recording) {
  for (std::size_t k = 0; k < recording.channels.size(); ++k)
    if (recording.channels[k].unit.quantity == Quantity::temperature) return k;
  const auto named = by_name(recording, temperature_names);
  if (!named || recording.channels[*named].unit.quantity != Quantity::unknown) return std::nullopt;
  return named;
}

bool can_be_output(const Channel& channel) {
  return channel.unit.quantity == Quantity::acceleration ||
         channel.unit.quantity == Quantity::voltage || channel.unit.quantity == Quantity::counts ||
         channel.unit.quantity == Quantity::unknown;
}

bool is_std_of(const std::string& name, const std::string& output) {
  return name == output + "std" || name == "std" + output || name == output + "sem" ||
         name == "sigma" + output;
}

// All other columns except counters; accelerations in preference to voltages and counts, those in
// preference to columns without a unit.
std::vector<std::size_t> find_outputs(const Recording& recording, const TumbleColumns& taken) {
  const auto counter = signal::find_counter(recording);
  const bool table = taken.angle.has_value() && recording.samples() < 50;
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    const auto at = std::optional(k);
    const bool used = at == taken.angle || at == taken.std || at == taken.direction ||
                      at == taken.mount || at == taken.plane || at == taken.time ||
                      at == taken.temperature;
    if (used || (!table && at == counter) || !can_be_output(recording.channels[k])) continue;
    all.push_back(k);
  }
  std::erase_if(all, [&](std::size_t k) {
    const std::string name = io::bare_name(recording.channels[k].name);
    return is_any(name, std::array<std::string_view, 6>{"n", "samples", "row", "index", "number",
                                                        "run"}) ||
           std::any_of(all.begin(), all.end(), [&](std::size_t j) {
             return is_std_of(name, io::bare_name(recording.channels[j].name));
           });
  });
  for (const Quantity best : {Quantity::acceleration, Quantity::voltage, Quantity::counts}) {
    const auto is = [&](std::size_t k) { return recording.channels[k].unit.quantity == best; };
    if (!std::any_of(all.begin(), all.end(), is)) continue;
    std::erase_if(all, [&](std::size_t k) { return !is(k); });
    break;
  }
  return all;
}

}  // namespace

TumbleColumns tumble_columns(const Recording& recording,
                             const std::string& angle,
                             const std::vector<std::string>& chosen) {
  TumbleColumns out;
  out.angle = angle.empty() ? find_angle(recording) : named(recording, angle, "--angle");
  out.std = by_name(recording, std_names);
  out.direction = by_name(recording, direction_names);
  out.mount = by_name(recording, mount_names);
  out.plane = by_name(recording, std::array<std::string_view, 1>{"plane"});
  out.time = by_name(recording, time_names);
  out.temperature = find_temperature(recording);
  if (chosen.empty()) out.outputs = find_outputs(recording, out);
  for (const std::string& name : chosen) out.outputs.push_back(named(recording, name, "--channel"));
  if (out.outputs.empty())
    throw Failure(usage, recording.source +
                             ": no output to analyse: expected a column of readings in V, mV, g, "
                             "m/s2 or counts; name it with --channel");
  for (const std::size_t k : out.outputs) {
    std::optional<std::size_t> own = out.std;
    for (std::size_t j = 0; j < recording.channels.size(); ++j)
      if (is_std_of(io::bare_name(recording.channels[j].name),
                    io::bare_name(recording.channels[k].name)))
        own = j;
    out.output_std.push_back(own);
  }
  return out;
}

std::vector<double> angles_rad(const Channel& channel) {
  const bool has_unit = channel.unit.quantity == Quantity::angle;
  std::vector<double> out = channel.values.copy();
  for (double& value : out) value *= has_unit ? channel.unit.to_si : rad_per_deg;
  return out;
}

}  // namespace proofmass::app
