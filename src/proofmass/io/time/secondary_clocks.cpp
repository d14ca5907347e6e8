#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/io/names.hpp"
#include "proofmass/io/stamp_unit.hpp"
#include "proofmass/io/text/wording.hpp"
#include "proofmass/io/time/clock_pair.hpp"
#include "proofmass/io/time/stamp_steps.hpp"
#include "proofmass/signal/resample/counter.hpp"

namespace proofmass::io {
namespace {

bool is_clock_name(const std::string& name) {
  constexpr std::array<std::string_view, 8> clocks{"t",     "epoch", "millis", "micros",
                                                   "clock", "utc",   "tick",   "ticks"};
  const std::string bare = bare_name(name);
  return is_one_of(name, clocks) || bare.find("time") != std::string::npos;
}

/// A channel as a clock: seconds, NaN if missing, and the time of its first row.
struct OtherClock {
  std::vector<double> seconds;
  std::optional<std::int64_t> start_ns;  ///< since 1970, if it is a calendar time
};

std::optional<OtherClock> as_clock(const Channel& channel) {
  const bool is_stated = channel.unit.quantity == Quantity::time;
  if (!is_stated && !(channel.unit.quantity == Quantity::unknown && is_clock_name(channel.name)))
    return std::nullopt;
  if (signal::is_counter_name(channel.name)) return std::nullopt;
  const StampSteps steps = measure_steps(channel.values);
  if (!(steps.median > 0.0) || steps.ascending < 0.95 || steps.repeated > 0.9) return std::nullopt;
  const auto first = std::ranges::find_if(channel.values, is_stamp);
  StampColumn column{channel.name, channel.unit, {}, {}};
  column.origin = std::abs(*first) < 9e9    ? StampOrigin{std::llround(*first * 1e9), -9}
                  : std::abs(*first) < 9e18 ? StampOrigin{std::llround(*first), 0}
                                            : StampOrigin{};
  const StampUnit unit = unit_of(column, steps.nominal());
  OtherClock out;
  for (const double value : channel.values)
    out.seconds.push_back(is_stamp(value) ? (value - *first) * unit.unit_s : std::nan(""));
  if (unit.is_calendar && first == channel.values.begin())
    out.start_ns = unit.origin.ns(unit.unit_s);
  return out;
}

bool is_steadier(const ClockPair& pair) {
  return pair.other_jitter_s < pair.base_jitter_s / 3.0;
}

std::string words_on(const std::string& base, const std::string& other, const ClockPair& pair) {
  std::string text = fmt::format(
      "{} against {}: {:+.3g} ppm (standard deviation {:.2g}), jitter of "
      "a step {} s against {} s",
      other, base, pair.drift_ppm, pair.drift_std_ppm, in_words(pair.other_jitter_s),
      in_words(pair.base_jitter_s));
  if (pair.outliers > 0)
    text += fmt::format(", {} of {} stretches off the line", pair.outliers, pair.blocks);
  if (is_steadier(pair)) text += "; it is the steadier clock";
  return text;
}

}  // namespace

void note_other_clocks(Recording& recording) {
  if (recording.time.source != TimeSource::stamps || recording.samples() < 64) return;
  std::vector<double> base_s;
  for (std::size_t k = 0; k < recording.samples(); ++k) base_s.push_back(recording.time.at(k));
  constexpr std::int64_t year_2000_ns = 946'684'800'000'000'000;
  for (const Channel& channel : recording.channels) {
    const auto clock = as_clock(channel);
    if (!clock) continue;
    const auto pair = compare_clocks(base_s, clock->seconds);
    if (!pair || std::abs(pair->drift_ppm) > 1e5) continue;  // not a clock of the same recording
    std::string text = words_on(recording.time.channel, channel.name, *pair);
    const bool is_dated = recording.time.start_ns && *recording.time.start_ns > year_2000_ns;
    if (!is_dated && clock->start_ns) {
      recording.time.start_ns = clock->start_ns;
      text += "; the date of the first sample is taken from it";
    }
    Note& note = recording.notes.emplace_back(Note{Severity::info, std::move(text)});
    if (is_steadier(*pair)) note.advice = {Advice{"time", channel.name}};
  }
}

}  // namespace proofmass::io
