#include "input/channel_selection.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "input/gyroscope.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/signal/resample/counter.hpp"

namespace proofmass::app {
namespace {

std::vector<std::size_t> axes_in(const Recording& recording) {
  std::vector<std::size_t> axes;
  for (const Triad& triad : accelerometer_triads(recording)) {
    for (const auto& axis : {triad.x, triad.y, triad.z}) {
      if (axis) axes.push_back(*axis);
    }
  }
  std::ranges::sort(axes);
  return axes;
}

std::vector<std::size_t> choose(const Recording& recording,
                                const std::optional<std::size_t>& temperature,
                                bool named) {
  const std::vector<Channel>& channels = recording.channels;
  std::vector<std::size_t> all(channels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::erase_if(all, [&](std::size_t k) { return k == temperature; });
  if (named) return all;
  std::vector<std::size_t> accelerations = all;
  std::erase_if(accelerations,
                [&](std::size_t k) { return channels[k].unit.quantity != Quantity::acceleration; });
  if (!accelerations.empty()) return accelerations;
  if (std::vector<std::size_t> axes = axes_in(recording); !axes.empty()) return axes;
  const auto counter = signal::find_counter(recording);
  std::erase_if(all, [&](std::size_t k) {
    // Without values a counter can be recognised by its name only.
    const bool is_named_so = recording.samples() == 0 && signal::is_counter_name(channels[k].name);
    return k == counter || is_named_so;
  });
  return all;
}

std::vector<std::optional<std::size_t>> axes_of(const Recording& recording,
                                                const std::vector<std::size_t>& chosen) {
  std::vector<std::optional<std::size_t>> axes(chosen.size());
  const auto mark = [&](std::size_t axis, const std::optional<std::size_t>& place) {
    for (std::size_t k = 0; k < axes.size(); ++k)
      if (place == chosen[k]) axes[k] = axis;
  };
  const std::vector<Triad> triads = accelerometer_triads(recording);
  if (triads.size() == 1) {
    mark(0, triads[0].x);
    mark(1, triads[0].y);
    mark(2, triads[0].z);
  }
  const auto gyroscope = find_gyroscope(recording, triads.size() == 1 ? triads[0] : Triad{});
  for (std::size_t axis = 0; gyroscope && axis < 3; ++axis) mark(axis, (*gyroscope)[axis]);
  return axes;
}

// Unit of the rate whose integral has this unit.
Unit rate_unit(const Unit& unit) {
  if (unit.symbol == "m/s") return *parse_unit("m/s^2");
  if (unit.symbol == "rad") return *parse_unit("rad/s");
  if (unit.symbol == "s" || unit.symbol == "1") return {Quantity::unknown, 1.0, 0.0, "1"};
  return {Quantity::unknown, 1.0, 0.0, unit.symbol + "/s"};
}

}  // namespace

RestChoice choose_rest(const Recording& recording,
                       const std::optional<std::size_t>& temperature,
                       bool named) {
  RestChoice choice{choose(recording, temperature, named), {}};
  choice.axes = axes_of(recording, choice.channels);
  return choice;
}

Unit si_unit(const Unit& unit) {
  constexpr std::array<std::pair<Quantity, const char*>, 8> symbols{
      {{Quantity::acceleration, "m/s^2"},
       {Quantity::angular_rate, "rad/s"},
       {Quantity::angle, "rad"},
       {Quantity::voltage, "V"},
       {Quantity::speed, "m/s"},
       {Quantity::length, "m"},
       {Quantity::time, "s"},
       {Quantity::temperature, "K"}}};
  for (const auto& [known, symbol] : symbols) {
    if (unit.quantity == known) return *parse_unit(symbol);
  }
  return unit;
}

Unit series_unit(const Unit& unit, bool is_phase) {
  const Unit known = unit.symbol.empty() ? Unit{Quantity::unknown, 1.0, 0.0, "1"} : unit;
  return is_phase ? rate_unit(known) : known;
}

std::string clipping(const signal::ChannelAudit& audit, std::size_t samples) {
  constexpr std::size_t fewest = 3;
  constexpr double share = 1e-4;
  const auto clipped = static_cast<double>(audit.clipped);
  if (audit.clipped < fewest || clipped <= share * static_cast<double>(samples)) return {};
  const auto limit = [](std::optional<double> level) {
    return level ? report::significant(*level, 5) : std::string();
  };
  const char* between = audit.limit_low && audit.limit_high ? " or " : "";
  return fmt::format(
      "{} of {} are at the limits of the range ({}{}{} {}): clipped noise is not included in the "
      "figures",
      report::grouped(audit.clipped), report::count_words(samples, "sample"),
      limit(audit.limit_low), between, limit(audit.limit_high), audit.unit.symbol);
}

void note_grid(const signal::EvenGrid& grid,
               std::size_t places,
               const std::string& prefix,
               std::vector<Note>& notes) {
  if (grid.missing > 0) {
    notes.push_back(
        {Severity::warning, fmt::format("{}{} missing by the stamps, in {}: left blank", prefix,
                                        report::count_words(grid.missing, "sample"),
                                        report::count_words(places, "place"))});
  }
  constexpr double much = 0.1;
  if (grid.relative_jitter > much) {
    notes.push_back(
        {Severity::warning,
         fmt::format("{}the stamps jitter by {} % of a step: the samples are taken to be even, {} "
                     "Hz",
                     prefix, report::significant(100.0 * grid.relative_jitter, 2),
                     report::compact(grid.rate_hz, 6))});
  }
}

}  // namespace proofmass::app
