#include "proofmass/acquire/framing/time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/acquire/framing/clock.hpp"
#include "proofmass/acquire/framing/settings.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/stamp_unit.hpp"

namespace proofmass::acquire {
namespace {

/// Progress of a field over the first rows.
struct Pace {
  std::size_t up = 0, down = 0, level = 0;
  bool by_ones = true;
  std::vector<double> steps{};

  /// Except where it wraps, or repeats a value once or twice.
  [[nodiscard]] bool ascends() const { return up > 2 * down && up >= level / 9; }
};

Pace pace_of(const std::vector<double>& values) {
  Pace pace;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = values[k] - values[k - 1];
    if (!std::isfinite(step)) continue;
    ++(step > 0.0 ? pace.up : step < 0.0 ? pace.down : pace.level);
    pace.by_ones = pace.by_ones && step == 1.0;
    pace.steps.push_back(step);
  }
  return pace;
}

/// The unit in which the field advances with the host's clock; nullopt if the rows came too fast to
/// decide, or if no unit matches.
std::optional<std::int64_t> unit_by_host(const RowEvidence& rows, std::size_t field) {
  if (rows.first.empty() || rows.host_ns.size() < 4) return std::nullopt;
  constexpr std::int64_t shortest_ns = 100'000'000;
  const std::int64_t host_ns = rows.host_ns.back() - rows.host_ns.front();
  const double went = rows.first[field].back() - rows.first[field].front();
  if (host_ns < shortest_ns || !(went > 0.0)) return std::nullopt;
  // The first rows may have been buffered before they arrived; the units are far apart.
  constexpr double tolerance = 3.0;
  constexpr std::array<std::int64_t, 4> units_ns{1'000'000'000, 1'000'000, 1'000, 1};
  for (const std::int64_t unit_ns : units_ns) {
    const double ratio = went * static_cast<double>(unit_ns) / static_cast<double>(host_ns);
    if (ratio < tolerance && ratio > 1.0 / tolerance) return unit_ns;
  }
  return std::nullopt;
}

/// "millis" and "us" are names that contain the unit.
std::optional<std::int64_t> unit_by_name(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::int64_t>, 3> words{
      {{"millis", 1'000'000}, {"micros", 1'000}, {"nanos", 1}}};
  const std::string bare = io::bare_name(name);
  for (const auto& [word, unit_ns] : words)
    if (bare == word) return unit_ns;
  const auto unit = parse_unit(bare);
  return unit ? clock_unit_ns(*unit) : std::nullopt;
}

/// As for a file, from the magnitude of the values.
std::optional<std::int64_t> unit_by_size(const RowEvidence& rows,
                                         std::size_t field,
                                         std::vector<Note>& notes) {
  if (rows.first.empty()) return std::nullopt;
  Pace pace = pace_of(rows.first[field]);
  std::erase_if(pace.steps, [](double step) { return !(step > 0.0); });
  const double first = rows.first[field].front();
  const auto step = median(pace.steps);
  if (!step || !(std::abs(first) < 9e18)) return std::nullopt;
  const io::StampColumn stamps{.name = rows.fields[field].label.name,
                               .unit = {},
                               .origin = {std::llround(first), 0},
                               .values = {}};
  const io::StampUnit found = io::unit_of(stamps, *step);
  const auto unit_ns = std::llround(found.unit_s * 1e9);
  if (unit_ns > ns_per_s) return std::nullopt;
  if (found.note) notes.push_back(*found.note);
  return unit_ns;
}

Result<std::int64_t> unit_of_clock(const RowEvidence& rows,
                                   std::size_t field,
                                   const FramingOptions& options,
                                   std::vector<Note>& notes) {
  const RowField& clock = rows.fields[field];
  if (clock.is_calendar) return std::int64_t{1'000'000'000};
  if (!options.time_unit.empty()) return *clock_unit_ns(*parse_unit(options.time_unit));
  if (const auto unit_ns = clock_unit_ns(clock.label.unit)) return *unit_ns;
  if (const auto unit_ns = unit_by_name(clock.label.name)) return *unit_ns;
  if (const auto unit_ns = unit_by_host(rows, field)) {
    notes.push_back(
        {Severity::info, fmt::format("{}: unit taken to be {}, by the pace at which its rows came",
                                     clock.label.name, unit_word(*unit_ns))});
    return *unit_ns;
  }
  if (const auto unit_ns = unit_by_size(rows, field, notes)) return *unit_ns;
  return Error{Errc::invalid_argument,
               fmt::format("{}: the unit of this clock is unknown: add time-unit=s, ms, "
                           "us or ns, or time=none",
                           clock.label.name)};
}

/// The field with a name of time; a candidate that decreases is rejected, with a note.
std::optional<std::size_t> named_clock(const RowEvidence& rows, std::vector<Note>& notes) {
  std::optional<std::size_t> best;
  int best_likeness = 0;
  for (std::size_t f = 0; f < rows.fields.size(); ++f) {
    const RowField& field = rows.fields[f];
    if (!field.is_figures && !field.is_calendar) continue;
    const int likeness = io::likeness_to_time(field.label);
    // A unit of time alone may be that of a duration: only the values can decide.
    const bool is_enough = likeness >= (rows.first.empty() ? 2 : 1);
    if (is_enough && likeness > best_likeness) {
      best = f;
      best_likeness = likeness;
    }
  }
  const std::size_t seen = rows.first.empty() ? 0 : rows.first.front().size();
  if (!best || seen < 2 || rows.fields[*best].is_calendar) return best;
  if (pace_of(rows.first[*best]).ascends()) return best;
  if (best_likeness == 1) return std::nullopt;
  notes.push_back({Severity::warning,
                   fmt::format("{} does not go forward: not taken as the device's clock; time={} "
                               "says that it is",
                               rows.fields[*best].label.name, rows.fields[*best].label.name)});
  return std::nullopt;
}

/// A first field without a name that advances with time. One that increments by one may be a
/// counter.
std::optional<std::size_t> nameless_clock(const RowEvidence& rows,
                                          const FramingOptions& options,
                                          std::vector<Note>& notes) {
  constexpr std::size_t fewest = 4;
  if (rows.fields.size() < 2 || rows.first.empty() || rows.host_ns.size() < fewest)
    return std::nullopt;
  if (rows.fields[0].is_calendar) return 0;
  const Pace pace = pace_of(rows.first[0]);
  const std::string& name = rows.fields[0].label.name;
  if (!rows.fields[0].is_figures || pace.up + 1 < rows.host_ns.size()) return std::nullopt;
  if (pace.by_ones) {
    notes.push_back(
        {Severity::info, fmt::format("{} increases by one: give time={} if it is a clock, "
                                     "counter={} if it counts the rows",
                                     name, name, name)});
    return std::nullopt;
  }
  const bool came_at_once = options.carrier == Carrier::pipe && !unit_by_host(rows, 0) &&
                            rows.host_ns.back() - rows.host_ns.front() < 100'000'000;
  if (!unit_by_host(rows, 0) && !came_at_once) return std::nullopt;
  notes.push_back(
      {Severity::info,
       fmt::format("{} ascends: taken as the device's clock; time=none prevents this", name)});
  return 0;
}

}  // namespace

Result<std::optional<FoundClock>> find_clock(const RowEvidence& rows,
                                             const FramingOptions& options,
                                             std::vector<Note>& notes) {
  if (options.time == "none") return std::optional<FoundClock>();
  std::optional<std::size_t> field;
  if (!options.time.empty()) {
    field = find_field(rows.fields, options.time);
    if (!field || !(rows.fields[*field].is_figures || rows.fields[*field].is_calendar))
      return no_such_field(rows, "time", options.time);
  } else {
    field = rows.has_names ? named_clock(rows, notes) : nameless_clock(rows, options, notes);
  }
  if (!field) return std::optional<FoundClock>();
  const auto unit_ns = unit_of_clock(rows, *field, options, notes);
  if (!unit_ns) return unit_ns.error();
  const RowField& found = rows.fields[*field];
  return std::optional(FoundClock{*field, {found.label.name, *unit_ns, found.bits}});
}

}  // namespace proofmass::acquire
