#include "proofmass/signal/audit/audit_notes.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <string_view>

#include "proofmass/core/number_words.hpp"

namespace proofmass::signal {
namespace {

/// "12.4 s (line 1490)", or "12.4 s … 12.43 s (lines 1490 … 1493)"
std::string span_of(const OddValues& seen, const PlaceWords& words) {
  const std::string_view word = words.first_line > 0 ? "line" : "sample";
  const auto number = [&](const Place& place) { return place.sample + words.first_line; };
  if (seen.first.sample == seen.last.sample) {
    const std::string place = fmt::format("{} {}", word, number(seen.first));
    return words.is_timed ? fmt::format("{:.6g} s ({})", seen.first.s, place) : place;
  }
  const std::string place = fmt::format("{}s {} … {}", word, number(seen.first), number(seen.last));
  return words.is_timed ? fmt::format("{:.6g} s … {:.6g} s ({})", seen.first.s, seen.last.s, place)
                        : place;
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// "-2 or 2 g"
std::string limits_of(const ChannelAudit& channel, int digits) {
  std::string out;
  if (channel.limit_low) out = compact(*channel.limit_low, digits);
  if (channel.limit_high) out += (out.empty() ? "" : " or ") + compact(*channel.limit_high, digits);
  return channel.unit.symbol.empty() ? out : out + " " + channel.unit.symbol;
}

Note note_on_clipping(const ChannelAudit& channel) {
  const double share =
      100.0 * static_cast<double>(channel.clipped) / static_cast<double>(channel.moments.count);
  const std::string samples =
      fmt::format("{} ({} %)", counted(channel.clipped, "sample"), compact(share, 2));
  switch (channel.clipping) {
    case Clipping::before_noise:
      return {Severity::bad,
              fmt::format("{}: {} at a limit of {} with noise added after it: clipped before the "
                          "converter or a filter",
                          channel.name, samples, limits_of(channel, 4))};
    case Clipping::soft:
      return {Severity::bad, fmt::format("{}: crests beyond {} are flattened, {}: soft clipping",
                                         channel.name, limits_of(channel, 3), samples)};
    case Clipping::undetermined:
      return {Severity::warning,
              fmt::format("{}: crests beyond {} are flatter than those of an oscillation, and all "
                          "alike: soft clipping or the shape of the motion, which a recording at "
                          "one amplitude cannot distinguish",
                          channel.name, limits_of(channel, 3))};
    default:
      return {Severity::bad, fmt::format("{}: {} at the rails ({}): it may be clipped",
                                         channel.name, samples, limits_of(channel, 6))};
  }
}

}  // namespace

void note_values(const std::string& name,
                 const RunningChannel& channel,
                 const PlaceWords& words,
                 std::vector<Note>& notes) {
  const auto report = [&](const OddValues& seen, Severity severity, std::string_view what) {
    if (seen.count == 0) return;
    notes.push_back({severity, fmt::format("{}: {} {} at {}", name, counted(seen.count, "value"),
                                           what, span_of(seen, words))});
  };
  report(channel.nan(), Severity::warning, "missing or no number (NaN)");
  report(channel.infinite(), Severity::bad, "infinite");
  report(channel.absurd(), Severity::bad, "of a size no measurement has (3e34 and the like)");
  report(channel.denormal(), Severity::bad, "denormal (as bytes read wrongly are)");
}

void note_channel(const ChannelAudit& channel, double rate_hz, std::vector<Note>& notes) {
  const std::size_t set_aside = channel.nonfinite + channel.absurd + channel.denormal;
  if (channel.absurd + channel.denormal > 0)
    notes.push_back({Severity::info, fmt::format("{}: mean, std, min and max leave {} out",
                                                 channel.name, counted(set_aside, "such value"))});
  if (channel.clipping != Clipping::none) notes.push_back(note_on_clipping(channel));
  const double taken_hz = rate_hz > 0.0 ? rate_hz : 100.0;
  const bool moves = channel.moments.max > channel.moments.min;
  const bool measures = channel.unit.quantity == Quantity::acceleration ||
                        channel.unit.quantity == Quantity::angular_rate;
  const std::size_t long_run = std::max<std::size_t>(100, static_cast<std::size_t>(taken_hz));
  if (measures && moves && channel.longest_stuck >= long_run)
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: reads one and the same value for {} from {:.6g} s on", channel.name,
                     counted(channel.longest_stuck, "sample"), channel.longest_stuck_start_s)});
}

void note_zero_rows(const OddValues& rows, const PlaceWords& words, std::vector<Note>& notes) {
  if (rows.count == 0) return;
  notes.push_back({Severity::warning,
                   fmt::format("{} in which every inertial channel is exactly zero, at {}: the "
                               "sensor gave no data",
                               counted(rows.count, "row"), span_of(rows, words))});
}

void note_timing(const TimingAudit& timing, std::vector<Note>& notes) {
  if (timing.gap_count > 0)
    notes.push_back({Severity::warning,
                     fmt::format("{} in the stamps, the longest {:.4g} s from {:.6g} s on",
                                 counted(timing.gap_count, "gap"), timing.longest_gap.duration_s,
                                 timing.longest_gap.start_s)});
  if (timing.stalls > 0)
    notes.push_back(
        {Severity::warning,
         fmt::format("{} in which no sample is missing, the longest {:.4g} s from {:.6g} s on: the "
                     "samples that follow were stamped late, as by a computer that was busy",
                     counted(timing.stalls, "pause") + " in the stamps", timing.longest_stall_s,
                     timing.longest_stall_start_s)});
  if (timing.backwards > 0)
    notes.push_back({timing.backwards > timing.mended ? Severity::bad : Severity::warning,
                     fmt::format("time runs backwards at {}", counted(timing.backwards, "stamp"))});
  if (timing.repeated > 0)
    notes.push_back(
        {Severity::warning,
         fmt::format("{} the one before", timing.repeated == 1
                                              ? std::string("1 stamp repeats")
                                              : fmt::format("{} stamps repeat", timing.repeated))});
  if (timing.lost.value_or(0) > 0)
    notes.push_back({Severity::warning, fmt::format("{} missing by the packet counter",
                                                    counted(*timing.lost, "row"))});
}

}  // namespace proofmass::signal
