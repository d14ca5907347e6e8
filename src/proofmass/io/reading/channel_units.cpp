#include "proofmass/io/reading/channel_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <set>

#include "proofmass/core/statistics.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/text/wording.hpp"
#include "proofmass/signal/resample/counter.hpp"

namespace proofmass::io {
namespace {

/// Columns that an instrument names without a unit.
struct KnownColumn {
  std::string_view starts_with;
  std::string_view unit;
};
struct Instrument {
  std::string_view name;
  std::array<std::string_view, 2> signature;  ///< columns that identify it
  std::array<KnownColumn, 8> columns;
};
// One line per instrument; a column is matched by the beginning of its bare name.
constexpr std::array instruments = std::to_array<Instrument>({
    // Source: Xsens DOT user manual, "Data output"; MT Manager export.
    {"Xsens",
     {"packetcounter", "sampletimefine"},
     {{{"acc", "m/s^2"},
       {"freeacc", "m/s^2"},
       {"gyr", "deg/s"},
       {"euler", "deg"},
       {"roll", "deg"},
       {"pitch", "deg"},
       {"yaw", "deg"},
       {"dv", "m/s"}}}},
    // Source: Vieyra Software, Physics Toolbox Sensor Suite: G-Force Meter, Linear Accelerometer,
    // Gyroscope, Magnetometer.
    {"Physics Toolbox",
     {"gfx", "gfy"},
     {{{"gf", "g"},
       {"tgf", "g"},
       {"wx", "rad/s"},
       {"wy", "rad/s"},
       {"wz", "rad/s"},
       {"bx", "uT"},
       {"by", "uT"},
       {"bz", "uT"}}}},
    {"Physics Toolbox",
     {"ax", "at"},
     {{{"ax", "m/s^2"}, {"ay", "m/s^2"}, {"az", "m/s^2"}, {"at", "m/s^2"}}}},
});

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool is_unknown(const Channel& channel) {
  return channel.unit.quantity == Quantity::unknown;
}

bool is_accelerometer(const Channel& channel) {
  return channel.unit.quantity == Quantity::acceleration ||
         ((is_unknown(channel) || channel.unit.quantity == Quantity::voltage ||
           channel.unit.quantity == Quantity::counts) &&
          is_accelerometer_name(channel.name));
}

bool is_gyroscope(const Channel& channel) {
  const std::string name = bare_name(channel.name);
  return channel.unit.quantity == Quantity::angular_rate ||
         (channel.unit.quantity != Quantity::acceleration &&
          (name.starts_with("gyr") || name.starts_with("omega") || name == "gx" || name == "gy" ||
           name == "gz" || name == "wx" || name == "wy" || name == "wz"));
}

void apply_given_unit(Recording& recording, const ReadOptions& options) {
  std::string names;
  const auto is_meant =
      options.unit->quantity == Quantity::angular_rate ? is_gyroscope : is_accelerometer;
  const bool any = std::ranges::any_of(recording.channels, is_meant);
  for (Channel& channel : recording.channels) {
    const bool named = std::ranges::any_of(
        options.channels, [&](const std::string& n) { return lower(n) == lower(channel.name); });
    const bool meant = any ? is_meant(channel) : is_unknown(channel);
    if (!(options.channels.empty() ? meant : named)) continue;
    channel.unit = *options.unit;
    names += (names.empty() ? "" : ", ") + channel.name;
  }
  recording.notes.push_back(
      {Severity::info, fmt::format("{}: unit {} as given", names, options.unit->symbol)});
}

/// Some files have G for g: magnetic accelerometers do not exist.
void read_gauss_as_g(Recording& recording) {
  for (Channel& channel : recording.channels)
    if (channel.unit.quantity == Quantity::magnetic_field &&
        contains(bare_name(channel.name), "acc") && channel.unit.symbol == "G") {
      channel.unit = *parse_unit("g");
      recording.notes.push_back(
          {Severity::info,
           fmt::format("{}: unit G read as g, being an acceleration", channel.name)});
    }
}

/// The unit in which an instrument writes a column, by the beginning of the column's bare name.
std::string_view unit_of(const Instrument& instrument, const std::string& bare) {
  const auto matches = [&](const KnownColumn& column) {
    return !column.starts_with.empty() && bare.starts_with(column.starts_with);
  };
  const auto column = std::ranges::find_if(instrument.columns, matches);
  return column == instrument.columns.end() ? std::string_view{} : column->unit;
}

void apply_instrument(Recording& recording, const Instrument& instrument) {
  bool any = false;
  for (Channel& channel : recording.channels) {
    if (!is_unknown(channel)) continue;
    const std::string_view symbol = unit_of(instrument, bare_name(channel.name));
    if (symbol.empty()) continue;
    channel.unit = *parse_unit(symbol);
    any = true;
  }
  if (any)
    recording.notes.push_back(
        {Severity::info,
         fmt::format("units as {} writes them, recognised by its columns {} and {}",
                     instrument.name, instrument.signature[0], instrument.signature[1])});
}

void recognise_instrument(Recording& recording) {
  std::set<std::string> names{bare_name(recording.time.channel)};
  for (const Channel& channel : recording.channels) names.insert(bare_name(channel.name));
  for (const Instrument& instrument : instruments)
    if (names.contains(std::string(instrument.signature[0])) &&
        names.contains(std::string(instrument.signature[1])))
      apply_instrument(recording, instrument);
}

struct QuietWindow {
  double norm = 0.0;
  double start_s = 0.0;
  double spread = std::numeric_limits<double>::infinity();  ///< sum of the axes' variances
  bool whole_numbers = true;
};

std::vector<const Channel*> axes_of(const Recording& recording, const Triad& triad) {
  std::vector<const Channel*> axes;
  for (const auto& axis : {triad.x, triad.y, triad.z})
    if (axis) axes.push_back(&recording.channels[*axis]);
  return axes;
}

/// The second with the least variance, of at most a thousand complete ones spread over the
/// recording.
QuietWindow quietest_second(const Recording& recording, const std::vector<const Channel*>& axes) {
  const double rate_hz = recording.time.rate_hz > 0.0 ? recording.time.rate_hz : 100.0;
  const std::size_t samples = recording.samples();
  const auto wanted = static_cast<std::size_t>(std::clamp(rate_hz, 16.0, 1e4));
  const std::size_t length = std::min(samples, wanted);
  QuietWindow quietest;
  const std::size_t stride = length * (samples / std::max<std::size_t>(1000 * length, 1) + 1);
  for (std::size_t begin = 0; length > 0 && begin + length <= samples; begin += stride) {
    QuietWindow window;
    window.spread = 0.0;
    for (const Channel* axis : axes) {
      const auto values = std::span(axis->values).subspan(begin, length);
      const Moments seen = moments(values);
      const bool whole = seen.nonfinite == 0 && std::max(std::abs(seen.min), seen.max) < 1e9;
      window.spread += whole ? seen.std() * seen.std() : std::numeric_limits<double>::infinity();
      window.norm = std::hypot(window.norm, seen.mean);
      window.whole_numbers = window.whole_numbers && std::ranges::all_of(values, [](double x) {
                               return x == std::trunc(x);
                             });
    }
    window.start_s = recording.time.at(begin);
    // A sensor that has not started yet writes zeros: quieter than any, but without gravity.
    if (window.norm > 0.0 && window.spread < quietest.spread) quietest = window;
  }
  return quietest;
}

std::string_view unit_by_gravity(double norm) {
  const auto is_near = [&](double gravity) {
    return norm > 0.75 * gravity && norm < 1.3 * gravity;
  };
  if (is_near(standard_gravity_mps2)) return "m/s^2";
  if (is_near(1.0)) return "g";
  if (is_near(1000.0)) return "mg";
  return {};
}

void settle_by_gravity(Recording& recording, const Triad& triad) {
  const auto axes = axes_of(recording, triad);
  const QuietWindow quiet = quietest_second(recording, axes);
  std::string names;
  for (const Channel* axis : axes) names += (names.empty() ? "" : ", ") + axis->name;
  std::string_view symbol = std::isfinite(quiet.spread) ? unit_by_gravity(quiet.norm) : "";
  const bool timed = recording.time.source != TimeSource::none;
  std::string why = fmt::format("in the quietest {} they add up to {}",
                                timed ? fmt::format("second ({} s)", in_words(quiet.start_s))
                                      : fmt::format("stretch (sample {})", quiet.start_s),
                                in_words(quiet.norm));
  Severity severity = Severity::info;
  if (symbol.empty() && quiet.whole_numbers && std::isfinite(quiet.spread)) {
    symbol = "counts";
    why += ", which is neither g, mg nor m/s², in whole numbers";
  } else if (symbol == "mg" && quiet.whole_numbers) {
    severity = Severity::warning;
    why += " (counts of 1/1024 g would look alike)";
  }
  for (const auto& axis : {triad.x, triad.y, triad.z})
    if (axis) recording.channels[*axis].unit = parse_unit(symbol).value_or(Unit{});
  if (symbol.empty()) {
    recording.notes.push_back(
        {Severity::warning,
         fmt::format("{}: unit not known: {}, which is neither g, mg nor m/s²", names, why),
         {Advice{"unit"}}});
    return;
  }
  recording.notes.push_back(
      {severity, fmt::format("{}: unit taken to be {}: {}", names, symbol, why), {Advice{"unit"}}});
}

/// Checks a given unit against a header with another: at rest, gravity decides. Errors:
/// invalid_argument (the header's unit gives gravity, the given one does not).
Status check_given_unit(const Recording& recording, const Unit& given) {
  if (given.quantity != Quantity::acceleration) return Done{};
  for (const Triad& triad : accelerometer_triads(recording)) {
    const auto axes = axes_of(recording, triad);
    const Unit& unit = axes.front()->unit;
    const bool is_other = unit.quantity == Quantity::acceleration && unit.to_si != given.to_si;
    if (!is_other || axes.size() < 3) continue;
    const QuietWindow quiet = quietest_second(recording, axes);
    const auto is_gravity = [&](const Unit& one) {
      return std::abs(quiet.norm * one.to_si / standard_gravity_mps2 - 1.0) < 0.1;
    };
    if (std::isfinite(quiet.spread) && is_gravity(unit) && !is_gravity(given))
      return Error{
          Errc::invalid_argument,
          fmt::format("the unit {} contradicts the header's {} of {}: in the quietest second "
                      "the axes add up to {}, which is gravity in {}: omit it, or correct it",
                      given.symbol, unit.symbol, axes.front()->name, in_words(quiet.norm),
                      unit.symbol),
          {Advice{"unit", unit.symbol == "m/s^2" ? "m/s2" : unit.symbol}}};
  }
  return Done{};
}

/// A single column named only "y" may be anything: its magnitude is no evidence of gravity.
bool says_acceleration(const Recording& recording, const Triad& triad) {
  if (triad.axes() > 1) return true;
  for (const auto& axis : {triad.x, triad.y, triad.z})
    if (axis) return contains(bare_name(recording.channels[*axis].name), "acc");
  return false;
}

/// Groups the accelerometers of unknown unit into sensors and determines the unit of each.
void recognise_gravity(Recording& recording) {
  Recording sketch;  // names only: core decides which channels belong together
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    if (!is_unknown(channel) || !is_accelerometer_name(channel.name)) continue;
    sketch.channels.push_back({channel.name, *parse_unit("m/s^2"), {}});
    columns.push_back(i);
  }
  for (Triad triad : accelerometer_triads(sketch)) {
    for (auto* axis : {&triad.x, &triad.y, &triad.z})
      if (*axis) *axis = columns[**axis];
    if (says_acceleration(recording, triad)) settle_by_gravity(recording, triad);
  }
}

}  // namespace

bool is_accelerometer_name(std::string_view name) {
  std::string bare = bare_name(name);
  if (contains(bare, "acc") && !contains(bare, "accuracy")) return true;
  std::erase_if(bare, [](char c) { return c >= '0' && c <= '9'; });
  constexpr std::array<std::string_view, 3> stems{"", "a", "gf"};
  return !bare.empty() && bare.back() >= 'x' && bare.back() <= 'z' &&
         std::ranges::find(stems, std::string_view(bare).substr(0, bare.size() - 1)) != stems.end();
}

Status settle_units(Recording& recording, const ReadOptions& options) {
  for (Channel& channel : recording.channels)
    if (is_unknown(channel) && signal::is_counter_name(channel.name))
      channel.unit = *parse_unit("counts");
  read_gauss_as_g(recording);
  recognise_instrument(recording);
  if (options.unit) {
    const Status possible = check_given_unit(recording, *options.unit);
    if (!possible) return possible;
    apply_given_unit(recording, options);
  }
  recognise_gravity(recording);
  return Done{};
}

}  // namespace proofmass::io
