#include "proofmass/report/noise/wording.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::Coefficient;
using characterise::NoiseAnalysis;
using characterise::NoiseModelFit;

bool is_acceleration(const Unit& unit) {
  return unit.quantity == Quantity::acceleration && unit.to_si == 1.0;
}

bool is_angular_rate(const Unit& unit) {
  return unit.quantity == Quantity::angular_rate && unit.to_si == 1.0;
}

bool is_plain(const Unit& unit) {
  return unit.symbol.empty() || unit.symbol == "1";
}

// Unit to which a prefix can be added, and what NoiseScale appends to it.
struct Base {
  double per_si = 1.0;
  std::string symbol, after;
  bool takes_prefix = true;
};

std::string_view per_what(NoiseScale scale) {
  switch (scale) {
    case NoiseScale::density:
      return "/√Hz";
    case NoiseScale::walk:
      return "/√s";
    case NoiseScale::slope:
      return "/s";
    case NoiseScale::integral:
      return "·s";
    case NoiseScale::level:
      break;
  }
  return "";
}

// Gyroscope makers give N as angle random walk in °/√h, 1 °/s/√Hz being 60 °/√h, and B in °/h; K,
// the rate random walk, in °/h/√h.
Base base_of_rate(NoiseScale scale) {
  constexpr double s_per_h = 3600.0, root = 60.0;
  switch (scale) {
    case NoiseScale::density:
      return {root * deg_per_rad, "°/√h", "", false};
    case NoiseScale::walk:
      return {s_per_h * root * deg_per_rad, "°/h/√h", "", false};
    case NoiseScale::slope:
      return {s_per_h * s_per_h * deg_per_rad, "°/h²", "", false};
    case NoiseScale::integral:
      return {deg_per_rad, "°", "", false};
    case NoiseScale::level:
      break;
  }
  return {s_per_h * deg_per_rad, "°/h", "", false};
}

Base base_of(const Unit& unit, NoiseScale scale) {
  const bool integral = scale == NoiseScale::integral;
  const std::string after(per_what(scale));
  if (is_plain(unit)) {
    if (integral) return {1.0, "s", "", false};
    return {1.0, after.empty() ? "" : "1", after, false};
  }
  if (is_acceleration(unit)) {
    if (integral) return {1.0, "m/s", "", true};
    return {1.0 / standard_gravity_mps2, "g", after, true};
  }
  if (is_angular_rate(unit)) return base_of_rate(scale);
  const bool takes_prefix = unit.quantity == Quantity::voltage && unit.to_si == 1.0;
  return {1.0, print_unit(unit.symbol), after, takes_prefix};
}

std::string unless_enough(const Coefficient& coefficient) {
  if (!coefficient.record_needed_s) return "";
  return fmt::format("; identifying as much needs {} of recording",
                     duration_words(*coefficient.record_needed_s));
}

std::string white_sentence(const ChannelNoise& channel, const Coefficient& white) {
  if (is_identified(white)) {
    return fmt::format("White noise {}.",
                       coefficient_words(white, channel.unit, NoiseScale::density));
  }
  return fmt::format("White noise is not identifiable: below {} with 95 % confidence.",
                     noise_words(white.upper_95, channel.unit, NoiseScale::density));
}

std::string flicker_sentence(const ChannelNoise& channel, const Coefficient& flicker) {
  if (is_identified(flicker)) {
    return fmt::format(
        "Flicker noise (bias instability) {}; the flat part of the Allan deviation is 0.664 of it.",
        coefficient_words(flicker, channel.unit, NoiseScale::level));
  }
  return fmt::format("No flicker noise detected: below {} with 95 % confidence{}.",
                     noise_words(flicker.upper_95, channel.unit, NoiseScale::level),
                     unless_enough(flicker));
}

std::string walk_sentence(const ChannelNoise& channel, const Coefficient& walk) {
  if (is_identified(walk)) {
    const bool doubtful = walk.lower_95 == 0.0 && channel.analysis->model.slow_change;
    return fmt::format(
        "Random walk {}{}.", coefficient_words(walk, channel.unit, NoiseScale::walk),
        doubtful ? ", or a slow change: this recording does not distinguish them" : "");
  }
  return fmt::format("No random walk detected: below {} with 95 % confidence{}.",
                     noise_words(walk.upper_95, channel.unit, NoiseScale::walk),
                     unless_enough(walk));
}

// Terms mentioned only if present.
void add_rarer_terms(const ChannelNoise& channel, std::vector<std::string>& sentences) {
  const NoiseModelFit& model = channel.analysis->model;
  const Unit& unit = channel.unit;
  if (model.slow_change && model.slow_change->taken_out) {
    sentences.push_back(fmt::format(
        "A slow change of {} peak to peak, like a sine with a period of {}, was removed "
        "before the fit: it is not noise, possibly temperature (--temperature).",
        noise_words(model.slow_change->peak_to_peak, unit, NoiseScale::level),
        duration_words(model.slow_change->period_s)));
  }
  if (is_identified(model.quantisation)) {
    sentences.push_back(
        fmt::format("Quantisation noise {}.",
                    coefficient_words(model.quantisation, unit, NoiseScale::integral)));
  }
  if (is_identified(model.ramp)) {
    const double whole = std::copysign(model.ramp.value, model.slope_per_s) * model.duration_s;
    sentences.push_back(
        fmt::format("A steady drift of {}, {} over the recording: warm-up or temperature.",
                    coefficient_words(model.ramp, unit, NoiseScale::slope),
                    noise_words(whole, unit, NoiseScale::level)));
  }
  if (model.markov) {
    sentences.push_back(
        fmt::format("First-order Markov noise of {} rms with a time constant of {}.",
                    noise_words(model.markov->std_of_process(), unit, NoiseScale::level),
                    with_std(model.markov->time_constant_s, "s")));
  }
  if (model.bandwidth_hz) {
    sentences.push_back(fmt::format(
        "A filter rolls the noise off at {}: averaging times below {} do not show the white noise.",
        with_std(*model.bandwidth_hz, "Hz"),
        duration_words(5.0 / (rad_per_turn * model.bandwidth_hz->value))));
  }
}

std::string line_words(const std::vector<const signal::SpectralLine*>& lines) {
  std::string text;
  for (const auto* line : lines) {
    text += (text.empty()           ? ""
             : line == lines.back() ? " and "
                                    : ", ") +
            compact(line->frequency_hz, 4);
  }
  return text;
}

void add_lines(const NoiseAnalysis& analysis, std::vector<std::string>& sentences) {
  constexpr double worth_a_word = 0.05;
  std::vector<const signal::SpectralLine*> quiet;
  for (const signal::SpectralLine& line : analysis.lines.lines) {
    const LineEffect effect = line_effect(analysis, line);
    if (!(effect.raise > worth_a_word)) {
      quiet.push_back(&line);
      continue;
    }
    const bool about_1_s = effect.tau_s > 0.3 && effect.tau_s < 3.0;
    sentences.push_back(fmt::format(
        "A line at {} Hz raises the deviation near {} by {} %{}.", compact(line.frequency_hz, 4),
        duration_words(effect.tau_s), significant(100.0 * effect.raise, 2),
        about_1_s ? ": do not read the white noise off the curve there" : ""));
  }
  constexpr std::size_t most_named = 6;
  if (quiet.empty()) return;
  const std::string more =
      quiet.size() > most_named ? fmt::format(", {} in all", quiet.size()) : "";
  if (quiet.size() > most_named) quiet.resize(most_named);
  sentences.push_back(fmt::format("{} at {} Hz{}.", quiet.size() == 1 ? "A line" : "Lines",
                                  line_words(quiet), more));
}

void add_judgement(const NoiseAnalysis& analysis, std::vector<std::string>& sentences) {
  const NoiseModelFit& model = analysis.model;
  if (model.misfit > 0.02 && model.misfit_p < 1e-3) {
    sentences.push_back(fmt::format(
        "The spectrum departs from the model by {} % of the density; the standard deviations "
        "include this.",
        significant(100.0 * model.misfit, 2)));
  }
  const auto outliers = static_cast<std::size_t>(
      std::count_if(analysis.events.begin(), analysis.events.end(),
                    [](const auto& event) { return event.kind == signal::EventKind::outlier; }));
  const std::size_t steps = analysis.events.size() - outliers;
  if (outliers > 0 || steps > 0) {
    std::string what = outliers > 0 ? count_words(outliers, "outlier") : "";
    if (steps > 0) what += (what.empty() ? "" : " and ") + count_words(steps, "step") + " of level";
    sentences.push_back(what + " in the recording: see the events.");
  }
}

std::vector<std::string> doubts_of(const ChannelNoise& channel) {
  std::vector<std::string> sentences;
  if (!channel.analysis) return sentences;
  if (std::string moving = motion_sentence(channel.rest, "noise"); !moving.empty())
    sentences.push_back(std::move(moving));
  const NoiseAnalysis& analysis = *channel.analysis;
  const characterise::Stationarity& found = analysis.stationarity;
  if (found.stationary) return sentences;
  const auto [least, most] = std::ranges::minmax(found.relative_level);
  std::string text = fmt::format(
      "Not stationary (p = {}): {} changes by a factor of {} over the recording",
      significant(found.p, 1),
      found.line_hz ? "the line at " + compact(*found.line_hz, 4) + " Hz"
                    : "the noise at averaging times near " + duration_words(found.averaging_s),
      significant(most / least, 3));
  if (!analysis.parts.empty()) {
    const auto white = [](const characterise::NoisePart& part) { return part.model.white.value; };
    const auto [low, high] = std::ranges::minmax(analysis.parts, {}, white);
    text += fmt::format(", white noise from {} to {} in its parts",
                        noise_words(white(low), channel.unit, NoiseScale::density),
                        noise_words(white(high), channel.unit, NoiseScale::density));
  }
  sentences.push_back(text + ". The figures are averages over the recording.");
  return sentences;
}

}  // namespace

const std::array<NamedCoefficient, 5> named_coefficients{
    {{"white", "White noise N", NoiseScale::density, &NoiseModelFit::white},
     {"flicker", "Flicker B", NoiseScale::level, &NoiseModelFit::flicker},
     {"random_walk", "Random walk K", NoiseScale::walk, &NoiseModelFit::random_walk},
     {"quantisation", "Quantisation Q", NoiseScale::integral, &NoiseModelFit::quantisation},
     {"ramp", "Ramp R", NoiseScale::slope, &NoiseModelFit::ramp}}};

std::string noise_unit(const Unit& unit, NoiseScale scale) {
  const std::string u = is_plain(unit) ? "1" : unit.symbol;
  switch (scale) {
    case NoiseScale::density:
      return u + "/sqrt(Hz)";
    case NoiseScale::walk:
      return u + "/sqrt(s)";
    case NoiseScale::integral:
      if (is_acceleration(unit)) return "m/s";
      if (is_angular_rate(unit)) return "rad";
      return is_plain(unit) ? "s" : u + "*s";
    case NoiseScale::slope:
      if (is_acceleration(unit)) return "m/s^3";
      return is_angular_rate(unit) ? "rad/s^2" : u + "/s";
    case NoiseScale::level:
      break;
  }
  return u;
}

std::string squared_unit(const Unit& unit, NoiseScale scale) {
  const bool density = scale == NoiseScale::density, walk = scale == NoiseScale::walk;
  if (is_acceleration(unit)) return density ? "m^2/s^3" : walk ? "m^2/s^5" : "m^2/s^4";
  const std::string square = is_plain(unit) ? "1" : "(" + unit.symbol + ")^2";
  return square + (density ? "/Hz" : walk ? "/s" : "");
}

ShownUnit shown_unit(const Unit& unit, NoiseScale scale, double size) {
  const Base base = base_of(unit, scale);
  const std::string plain = base.symbol + base.after;
  const double micros = std::abs(size) * base.per_si * 1e6;
  // Instrument makers use parts per million; changed only if that is hard to read.
  if (!base.takes_prefix || micros >= 1e7) return {base.per_si, plain};
  if (micros >= 1e4) return {base.per_si * 1e3, "m" + plain};
  if (micros >= 0.1 || !(micros > 0.0)) return {base.per_si * 1e6, "µ" + plain};
  return {base.per_si * 1e9, "n" + plain};
}

std::string noise_words(const Uncertain& figure, const Unit& unit, NoiseScale scale) {
  const ShownUnit shown = shown_unit(unit, scale, figure.value != 0.0 ? figure.value : figure.std);
  return with_std({figure.value * shown.per_si, figure.std * shown.per_si}, shown.symbol);
}

std::string noise_words(double value, const Unit& unit, NoiseScale scale) {
  const ShownUnit shown = shown_unit(unit, scale, value);
  return significant(value * shown.per_si, 3) + (shown.symbol.empty() ? "" : " ") + shown.symbol;
}

bool has_coefficients(const ChannelNoise& channel) {
  return channel.analysis && channel.analysis->model.ordinates > 0;
}

bool has_spectrum(const ChannelNoise& channel) {
  return channel.analysis && channel.analysis->spectrum.frequency_hz.size() > 1;
}

std::string coefficient_words(const Coefficient& coefficient, const Unit& unit, NoiseScale scale) {
  if (is_identified(coefficient)) {
    return noise_words(Uncertain{coefficient.value, coefficient.std}, unit, scale);
  }
  return fmt::format("0, below {} (95 %)", noise_words(coefficient.upper_95, unit, scale));
}

std::string verdict_words(const Coefficient& coefficient, double duration_s) {
  if (is_identified(coefficient)) return "identified";
  if (!coefficient.record_needed_s || *coefficient.record_needed_s <= duration_s)
    return "not observable";
  return fmt::format("not observable; needs {}", duration_words(*coefficient.record_needed_s));
}

bool estimates_allan(characterise::Statistic statistic) {
  using characterise::Statistic;
  return statistic == Statistic::adev || statistic == Statistic::oadev ||
         statistic == Statistic::totdev || statistic == Statistic::theo1;
}

NoiseScale curve_scale(characterise::Statistic statistic) {
  const bool time =
      statistic == characterise::Statistic::tdev || statistic == characterise::Statistic::ttotdev;
  return time ? NoiseScale::integral : NoiseScale::level;
}

std::optional<double> flicker_tau_s(const NoiseAnalysis& analysis) {
  const NoiseModelFit& model = analysis.model;
  const auto& points = analysis.deviation.points;
  if (!is_identified(model.flicker) || points.empty()) return std::nullopt;
  const auto variance = [&](const auto& point) { return model.allan_variance(point.tau_s); };
  const auto lowest = std::ranges::min_element(points, {}, variance);
  const double end_s = points.back().tau_s;
  if (lowest->tau_s < end_s) return lowest->tau_s;
  const double flat = model.allan_variance(characterise::Term::flicker, end_s);
  const double white = model.allan_variance(characterise::Term::white, 1.0);
  const double meeting_s = std::clamp(white / flat, points.front().tau_s, end_s);
  return std::sqrt(meeting_s * end_s);
}

LineEffect line_effect(const NoiseAnalysis& analysis, const signal::SpectralLine& line) {
  const auto& points = analysis.deviation.points;
  if (points.empty()) return {};
  constexpr double at_largest = 0.3710;  // argument f τ of the maximum of sin²(π f τ)/(π f τ)
  const double tau_s =
      std::clamp(at_largest / line.frequency_hz, points.front().tau_s, points.back().tau_s);
  const double noise = analysis.model.allan_variance(tau_s);
  if (!(noise > 0.0)) return {};
  const double added = characterise::sine_allan_variance(line.amplitude, line.frequency_hz, tau_s);
  return {tau_s, std::sqrt(1.0 + added / noise) - 1.0};
}

std::vector<CurveReading> curve_readings(const characterise::DeviationCurve& curve) {
  constexpr double near = 0.03;
  const auto& points = curve.points;
  std::vector<CurveReading> readings;
  if (points.size() < 3) return readings;
  for (const double tau_s : {1.0, 10.0, 100.0}) {
    const auto nearest = std::ranges::min_element(
        points, {}, [=](const auto& point) { return std::abs(point.tau_s - tau_s); });
    if (std::abs(nearest->tau_s / tau_s - 1.0) < near) readings.push_back({*nearest, false});
  }
  const auto lowest = std::ranges::min_element(points, {}, &characterise::DeviationPoint::value);
  if (lowest != points.begin() && lowest != points.end() - 1) readings.push_back({*lowest, true});
  return readings;
}

std::vector<std::string> common_doubts(const NoiseReport& report) {
  std::string moving, changing;
  const auto add = [](std::string& names, const std::string& name) {
    names += (names.empty() ? "" : ", ") + name;
  };
  for (const ChannelNoise& channel : report.channels) {
    if (!channel.analysis) continue;
    if (!motion_sentence(channel.rest, "noise").empty()) add(moving, channel.name);
    if (!channel.analysis->stationarity.stationary) add(changing, channel.name);
  }
  std::vector<std::string> sentences;
  if (!moving.empty()) sentences.push_back(motion_sentence_of_channels(moving));
  if (!changing.empty())
    sentences.push_back("Not stationary (" + changing + "): the figures are averages.");
  return sentences;
}

std::vector<std::string> noise_findings(const ChannelNoise& channel) {
  if (!channel.analysis) return {"Not analysed: " + channel.refused + "."};
  std::vector<std::string> sentences = doubts_of(channel);
  if (has_coefficients(channel)) {
    const NoiseModelFit& model = channel.analysis->model;
    sentences.push_back(white_sentence(channel, model.white));
    sentences.push_back(flicker_sentence(channel, model.flicker));
    sentences.push_back(walk_sentence(channel, model.random_walk));
    add_rarer_terms(channel, sentences);
  } else {
    sentences.push_back("Too short for coefficients: only the deviation is given.");
  }
  add_lines(*channel.analysis, sentences);
  add_judgement(*channel.analysis, sentences);
  if (channel.temperature) {
    const ShownUnit shown =
        shown_unit(channel.unit, NoiseScale::level, channel.temperature->coefficient.value);
    const Uncertain& c = channel.temperature->coefficient;
    sentences.push_back(
        fmt::format("The dependence on {} was removed: {} per {}.", channel.temperature->channel,
                    with_std(Uncertain{c.value * shown.per_si, c.std * shown.per_si}, shown.symbol),
                    channel.temperature->per));
  }
  return sentences;
}

std::string event_time_words(const signal::Event& event, double rate_hz) {
  // Enough decimals to distinguish adjacent samples.
  const int decimals = std::max(0, static_cast<int>(std::ceil(std::log10(rate_hz))));
  const auto time = [&](std::size_t sample) {
    return fixed(static_cast<double>(sample) / rate_hz, decimals);
  };
  if (event.first == event.last) return time(event.first) + " s";
  return time(event.first) + " … " + time(event.last) + " s";
}

}  // namespace proofmass::report
