#include "proofmass/io/time/notes.hpp"

#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/text/wording.hpp"

namespace proofmass::io {
namespace {

Note on_wraps(const MendedStamps& done, const NamedStamps& stamps) {
  std::string text =
      fmt::format("{}: counter ran over {} ({}, at {})", stamps.name, times(done.wraps.count),
                  done.wrapped, done.wraps.where(stamps.first_line));
  if (done.longest_wrap_gap > 0.0)
    text += fmt::format(", in a gap of {} s", in_words(done.longest_wrap_gap * stamps.unit_s));
  return {done.longest_wrap_gap > 0.0 ? Severity::warning : Severity::info, text};
}

Note on_hours(const MendedStamps& done, const NamedStamps& stamps) {
  const std::size_t on = done.hours.count - done.hours_back;
  std::string what = "went back an hour";
  if (on > 0) what = done.hours_back > 0 ? "leapt an hour and went back one" : "leapt an hour";
  return {Severity::warning,
          fmt::format("{}: {} at {}, with no row missing: interpreted as summer time and removed",
                      stamps.name, what, done.hours.where(stamps.first_line))};
}

Note on_restarts(const MendedStamps& done, const NamedStamps& stamps) {
  return {
      Severity::bad,
      fmt::format("{}: the clock fell back {} for good ({}; first from {} to {}): time goes on "
                  "one step later, how long it stood is not known",
                  stamps.name, times(done.restarts.count), done.restarts.where(stamps.first_line),
                  in_words(done.fell_from), in_words(done.fell_to))};
}

Note on_settings(const MendedStamps& done, const NamedStamps& stamps) {
  return {Severity::warning,
          fmt::format("{}: the clock leapt by more than ten years at {}: it was set there; time "
                      "goes on one step later",
                      stamps.name, done.settings.where(stamps.first_line))};
}

Note on_replaced(const MendedStamps& done, const NamedStamps& stamps) {
  const std::size_t count = done.samples.count;
  std::string how = "set evenly between their neighbours";
  if (done.by_counter == count)
    how = fmt::format("set from {}", stamps.counter_name);
  else if (done.by_counter > 0)
    how = fmt::format("{} set from {}, the others evenly between their neighbours", done.by_counter,
                      stamps.counter_name);
  return {Severity::warning,
          fmt::format("{}: {} no usable stamp ({}): {}", stamps.name,
                      count == 1 ? "1 sample has" : fmt::format("{} samples have", count),
                      done.samples.where(stamps.first_line), how)};
}

}  // namespace

std::vector<Note> notes_on_mending(const MendedStamps& done, const NamedStamps& stamps) {
  std::vector<Note> notes;
  if (done.wraps.count > 0) notes.push_back(on_wraps(done, stamps));
  if (done.hours.count > 0) notes.push_back(on_hours(done, stamps));
  if (done.restarts.count > 0) notes.push_back(on_restarts(done, stamps));
  if (done.settings.count > 0) notes.push_back(on_settings(done, stamps));
  if (done.samples.count > 0) notes.push_back(on_replaced(done, stamps));
  return notes;
}

std::vector<Note> notes_on_rate(const TimeBase& base,
                                const StampSteps& steps,
                                double unit_s,
                                std::optional<double> header_rate_hz) {
  std::vector<Note> notes;
  if (steps.in_bursts)
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: rows come in bursts (half of the steps are {} s or less, {:.0f} % repeat "
                     "the stamp before): the rate is that of the long run, {} Hz",
                     base.channel, in_words(steps.middle * unit_s), 100.0 * steps.repeated,
                     in_words(base.rate_hz))});
  if (!header_rate_hz || !(base.rate_hz > 0.0)) return notes;
  if (std::abs(base.rate_hz / *header_rate_hz - 1.0) < 0.05) return notes;
  notes.push_back(
      {Severity::warning,
       fmt::format("{}: the stamps say {} Hz, the file's preamble {} Hz: one of them is "
                   "wrong; the stamps are used",
                   base.channel, in_words(base.rate_hz), in_words(*header_rate_hz)),
       {Advice{"rate"}}});
  return notes;
}

std::vector<Note> notes_on_counter(const std::string& name, const CounterClock& clock) {
  std::vector<Note> notes;
  if (clock.lost() > 0)
    notes.push_back(
        {Severity::info,
         fmt::format("samples placed by {}, which shows where rows are missing", name)});
  if (clock.restarts() > 0)
    notes.push_back({Severity::bad,
                     fmt::format("{}: fell back {} for good: time goes on one step later, how many "
                                 "rows are missing is not known",
                                 name, times(clock.restarts()))});
  return notes;
}

}  // namespace proofmass::io
