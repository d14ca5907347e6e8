#include "proofmass/signal/audit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/signal/channel_audit.hpp"
#include "proofmass/signal/timing_audit.hpp"

namespace proofmass::signal {
namespace {

/// "12.4 s (line 1490)", or "12.4 s … 12.43 s (lines 1490 … 1493)"
std::string span_of(const Recording& recording, std::size_t first, std::size_t last) {
  const auto number = [&](std::size_t k) {
    return k + (recording.first_line > 0 ? recording.first_line : 0);
  };
  const std::string_view word = recording.first_line > 0 ? "line" : "sample";
  const bool timed = recording.time.rate_hz > 0.0 || !recording.time.is_uniform();
  if (first == last) {
    const std::string place = fmt::format("{} {}", word, number(first));
    return timed ? fmt::format("{:.6g} s ({})", recording.time.at(first), place) : place;
  }
  const std::string place = fmt::format("{}s {} … {}", word, number(first), number(last));
  return timed ? fmt::format("{:.6g} s … {:.6g} s ({})", recording.time.at(first),
                             recording.time.at(last), place)
               : place;
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// Adds "<name>: <count> <what> at <where>" for the samples that `is_such` picks out.
template <class Predicate>
void tell_samples(const Recording& recording,
                  const Channel& channel,
                  const Note& what,
                  Predicate is_such,
                  std::vector<Note>& notes) {
  std::size_t count = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t k = 0; k < channel.values.size(); ++k) {
    if (!is_such(channel.values[k])) continue;
    if (count++ == 0) first = k;
    last = k;
  }
  if (count == 0) return;
  notes.push_back(
      {what.severity, fmt::format("{}: {} {} at {}", channel.name, counted(count, "value"),
                                  what.text, span_of(recording, first, last))});
}

void tell_values(const Recording& recording, const Channel& channel, std::vector<Note>& notes) {
  tell_samples(
      recording, channel, {Severity::warning, "missing or no number (NaN)"},
      [](double x) { return std::isnan(x); }, notes);
  tell_samples(
      recording, channel, {Severity::bad, "infinite"}, [](double x) { return std::isinf(x); },
      notes);
  tell_samples(
      recording, channel, {Severity::bad, "of a size no measurement has (3e34 and the like)"},
      [](double x) { return std::isfinite(x) && std::abs(x) > absurd_magnitude; }, notes);
  tell_samples(recording, channel, {Severity::bad, "denormal (as bytes read wrongly are)"},
               is_denormal, notes);
}

void tell_channel(const Recording& recording,
                  const ChannelAudit& channel,
                  std::vector<Note>& notes) {
  const std::size_t set_aside = channel.nonfinite + channel.absurd + channel.denormal;
  if (channel.absurd + channel.denormal > 0)
    notes.push_back({Severity::info, fmt::format("{}: mean, std, min and max leave {} out",
                                                 channel.name, counted(set_aside, "such value"))});
  if (channel.clipped > 0)
    notes.push_back({Severity::bad,
                     fmt::format("{}: {} at the rails ({:.6g} or {:.6g} {}): it may be clipped",
                                 channel.name, counted(channel.clipped, "sample"),
                                 channel.moments.min, channel.moments.max, channel.unit.symbol)});
  const double rate_hz = recording.time.rate_hz > 0.0 ? recording.time.rate_hz : 100.0;
  const bool moves = channel.moments.max > channel.moments.min;
  const bool measures = channel.unit.quantity == Quantity::acceleration ||
                        channel.unit.quantity == Quantity::angular_rate;
  const std::size_t long_run = std::max<std::size_t>(100, static_cast<std::size_t>(rate_hz));
  if (measures && moves && channel.longest_stuck >= long_run)
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: reads one and the same value for {} from {:.6g} s on", channel.name,
                     counted(channel.longest_stuck, "sample"), channel.longest_stuck_start_s)});
}

/// Samples at which all inertial channels, three at least, read exactly zero: gravity alone keeps
/// a sensor that works from doing so.
std::vector<std::size_t> find_zero_rows(const Recording& recording) {
  std::vector<const Channel*> inertial;
  for (const Channel& channel : recording.channels)
    if (channel.unit.quantity == Quantity::acceleration ||
        channel.unit.quantity == Quantity::angular_rate)
      inertial.push_back(&channel);
  std::vector<std::size_t> rows;
  if (inertial.size() < 3) return rows;
  for (std::size_t k = 0; k < recording.samples(); ++k)
    if (std::ranges::all_of(inertial, [&](const Channel* c) { return c->values[k] == 0.0; }))
      rows.push_back(k);
  return rows;
}

void tell_zero_rows(const Recording& recording,
                    const std::vector<std::size_t>& rows,
                    std::vector<Note>& notes) {
  if (rows.empty()) return;
  notes.push_back(
      {Severity::warning,
       fmt::format("{} in which every inertial channel is exactly zero, at {}: the "
                   "sensor had nothing to say",
                   counted(rows.size(), "row"), span_of(recording, rows.front(), rows.back()))});
}

void tell_timing(const TimingAudit& timing, std::vector<Note>& notes) {
  if (!timing.gaps.empty()) {
    const auto longest = std::ranges::max_element(timing.gaps, {}, &Gap::duration_s);
    notes.push_back(
        {Severity::warning,
         fmt::format("{} in the stamps, the longest {:.4g} s from {:.6g} s on",
                     counted(timing.gaps.size(), "gap"), longest->duration_s, longest->start_s)});
  }
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

}  // namespace

bool RecordingAudit::is_bad() const {
  return std::ranges::any_of(notes, [](const Note& n) { return n.severity == Severity::bad; });
}

RecordingAudit audit(const Recording& recording) {
  RecordingAudit out;
  out.format = recording.format;
  out.samples = recording.samples();
  out.duration_s = recording.duration_s();
  out.notes = recording.notes;
  out.timing = audit_timing(recording);
  tell_timing(out.timing, out.notes);
  for (const Channel& channel : recording.channels) {
    out.channels.push_back(audit_channel(channel, recording.time));
    tell_values(recording, channel, out.notes);
    tell_channel(recording, out.channels.back(), out.notes);
  }
  out.zero_rows = find_zero_rows(recording);
  tell_zero_rows(recording, out.zero_rows, out.notes);
  return out;
}

}  // namespace proofmass::signal
