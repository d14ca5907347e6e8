#include "proofmass/report/noise/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <numbers>

#include "proofmass/report/noise/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DeviationPoint;
using characterise::NoiseAnalysis;
using characterise::NoiseModelFit;
using characterise::Term;
using characterise::Verdict;

std::vector<double> even_in_log(double from, double to, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count - 1);
    values[k] = from * std::pow(to / from, part);
  }
  return values;
}

double middle(const std::vector<double>& values) {
  return values.empty() ? 0.0 : values[values.size() / 2];
}

// One term as drawn in the figure.
struct DrawnTerm {
  const NamedCoefficient* name;
  double read_at_s;
  Ink ink;
  std::function<double(double)> variance;
};

std::vector<DrawnTerm> drawn_terms(const NoiseAnalysis& analysis) {
  const NoiseModelFit& model = analysis.model;
  const auto of = [&model](Term term) {
    return [&model, term](double tau_s) { return model.allan_variance(term, tau_s); };
  };
  const double flat_s = flicker_tau_s(analysis).value_or(0.0);
  std::vector<DrawnTerm> terms{
      {&named_coefficients[0], 1.0, Ink::green, of(Term::white)},
      {&named_coefficients[1], flat_s, Ink::purple, of(Term::flicker)},
      {&named_coefficients[2], 3.0, Ink::red, of(Term::random_walk)},
      {&named_coefficients[3], std::numbers::sqrt3, Ink::grey, of(Term::quantisation)},
      {&named_coefficients[4], std::numbers::sqrt2, Ink::grey,
       [&model](double tau_s) { return model.ramp_allan_variance(tau_s); }}};
  std::erase_if(terms, [&model](const DrawnTerm& term) {
    return (model.*term.name->figure).verdict != Verdict::identified;
  });
  return terms;
}

struct Window {
  double first_s, last_s, floor;  // smallest and largest τ; smallest deviation shown
};

// The conventional τ of the term if it is within the figure, else the τ at which the term has its
// largest share of the sum.
double marked_tau_s(const DrawnTerm& term, const NoiseModelFit& model, const Window& window) {
  const bool inside = term.read_at_s >= window.first_s && term.read_at_s <= window.last_s &&
                      std::sqrt(term.variance(term.read_at_s)) >= window.floor;
  if (inside) return term.read_at_s;
  const std::vector<double> taus = even_in_log(window.first_s, window.last_s, 41);
  return *std::ranges::max_element(
      taus, {}, [&](double tau_s) { return term.variance(tau_s) / model.allan_variance(tau_s); });
}

std::string term_words(const DrawnTerm& term, const ChannelNoise& channel) {
  constexpr std::array<const char*, 5> read = {"at 1 s", "at 0.664 B", "at 3 s", "at √3 s",
                                               "at √2 s"};
  const auto index = static_cast<std::size_t>(term.name - named_coefficients.data());
  const std::string name = term.name->name;
  return fmt::format("{} = {}, read {}", name.substr(name.size() - 1),
                     noise_words((channel.analysis->model.*term.name->figure).value, channel.unit,
                                 term.name->scale),
                     read[index]);
}

void add_terms(const ChannelNoise& channel, const Window& window, double shown, Figure& figure) {
  const NoiseAnalysis& analysis = *channel.analysis;
  const std::vector<double> taus = even_in_log(window.first_s, window.last_s, 200);
  const auto curve = [&](const std::function<double(double)>& variance) {
    std::vector<double> y(taus.size());
    std::ranges::transform(taus, y.begin(),
                           [&](double tau_s) { return std::sqrt(variance(tau_s)) * shown; });
    return y;
  };
  const std::vector<DrawnTerm> terms = drawn_terms(analysis);
  for (const DrawnTerm& term : terms) {
    figure.curves.push_back({"", taus, curve(term.variance), term.ink, Mark::thin});
    const double tau_s = marked_tau_s(term, analysis.model, window);
    // Below the term's line, on the side away from the curve, where the figure is empty.
    const bool falls =
        term.name->scale == NoiseScale::density || term.name->scale == NoiseScale::integral;
    figure.callouts.push_back({.text = term_words(term, channel),
                               .x = tau_s,
                               .y = std::sqrt(term.variance(tau_s)) * shown,
                               .ink = term.ink,
                               .below = true,
                               .left = falls});
  }
  if (analysis.model.markov) {
    const auto& model = analysis.model;
    const auto markov = [&](double tau_s) { return model.allan_variance(Term::markov, tau_s); };
    const double top_s =
        std::clamp(1.89 * model.markov->time_constant_s.value, window.first_s, window.last_s);
    figure.curves.push_back({"", taus, curve(markov), Ink::grey, Mark::thin});
    figure.callouts.push_back(
        {.text = fmt::format("Markov, T = {} s", compact(model.markov->time_constant_s.value, 2)),
         .x = top_s,
         .y = std::sqrt(markov(top_s)) * shown,
         .ink = Ink::grey,
         .below = false,
         .left = false});
  }
  const auto sum = [&](double tau_s) { return analysis.model.allan_variance(tau_s); };
  figure.curves.push_back({"fitted sum", taus, curve(sum), Ink::orange});
  const bool lines = std::ranges::any_of(analysis.lines.lines, [&](const auto& line) {
    return line_effect(analysis, line).raise > 0.03;
  });
  if (!lines) return;
  figure.curves.push_back({"with the lines", taus, curve([&](double tau_s) {
                             double variance = sum(tau_s);
                             for (const auto& line : analysis.lines.lines) {
                               variance += characterise::sine_allan_variance(
                                   line.amplitude, line.frequency_hz, tau_s);
                             }
                             return variance;
                           }),
                           Ink::orange, Mark::dashes});
}

// Lower limit of the axis: includes the values read off the terms' lines, at most a decade and a
// half below the curve.
double least_shown(const NoiseAnalysis& analysis, double lowest) {
  double least = lowest;
  for (const DrawnTerm& term : drawn_terms(analysis)) {
    if (term.read_at_s <= 0.0) continue;
    const double read = std::sqrt(term.variance(term.read_at_s));
    if (read > lowest / 30.0) least = std::min(least, read);
  }
  return least / 1.6;
}

std::string sentence_case(std::string_view text) {
  std::string out(text);
  if (!out.empty() && out[0] >= 'a' && out[0] <= 'z')
    out[0] = static_cast<char>(out[0] - 'a' + 'A');
  return out;
}

void name_lines(const NoiseAnalysis& analysis, double shown, Figure& figure) {
  std::vector<signal::SpectralLine> lines = analysis.lines.lines;
  std::ranges::sort(lines, std::ranges::greater{}, &signal::SpectralLine::excess_db);
  constexpr std::size_t most_named = 6;
  if (lines.size() > most_named) lines.resize(most_named);
  const signal::Spectrum& spectrum = analysis.spectrum;
  for (const signal::SpectralLine& line : lines) {
    const auto at = std::ranges::lower_bound(spectrum.frequency_hz, line.frequency_hz);
    auto k = static_cast<std::size_t>(at - spectrum.frequency_hz.begin());
    if (k > 0 && k < spectrum.one_sided_psd.size() &&
        spectrum.one_sided_psd[k - 1] > spectrum.one_sided_psd[k]) {
      --k;
    }
    if (k >= spectrum.one_sided_psd.size()) continue;
    figure.callouts.push_back({compact(line.frequency_hz, 4) + " Hz", line.frequency_hz,
                               std::sqrt(spectrum.one_sided_psd[k]) * shown, Ink::red});
  }
}

}  // namespace

Figure deviation_figure(const ChannelNoise& channel) {
  const NoiseAnalysis& analysis = *channel.analysis;
  const auto& points = analysis.deviation.points;
  Curve curve{sentence_case(characterise::title_of(analysis.deviation.statistic)), {}, {}};
  Band band{.label = fmt::format("{} % limits", compact(100.0 * analysis.deviation.confidence, 3)),
            .x = {},
            .lower = {},
            .upper = {}};
  double lowest = std::numeric_limits<double>::infinity();
  for (const DeviationPoint& point : points) {
    curve.x.push_back(point.tau_s);
    curve.y.push_back(point.value);
    band.lower.push_back(point.lower);
    band.upper.push_back(point.upper);
    if (point.lower > 0.0) lowest = std::min(lowest, point.lower);
  }
  const NoiseScale scale = curve_scale(analysis.deviation.statistic);
  const ShownUnit shown = shown_unit(channel.unit, scale, middle(curve.y));
  for (auto* values : {&curve.y, &band.lower, &band.upper}) {
    for (double& value : *values) value *= shown.per_si;
  }
  band.x = curve.x;
  const bool allan = estimates_allan(analysis.deviation.statistic);
  Figure figure{
      .title =
          fmt::format("{}: {}", channel.name, characterise::title_of(analysis.deviation.statistic)),
      .description =
          allan
              ? "Scatter of means over τ, with the terms identified in the recording."
              : "The terms are not drawn: fitted to the spectrum, they are Allan deviations, with "
                "which this statistic is not comparable.",
      .x = {.label = "Averaging time τ (s)", .scale = AxisScale::log},
      .y = {.label = "Deviation" + (shown.symbol.empty() ? "" : " (" + shown.symbol + ")"),
            .scale = AxisScale::log},
      .height = 400.0};
  figure.bands.push_back(std::move(band));
  if (allan && points.size() > 1 && std::isfinite(lowest)) {
    const Window window{points.front().tau_s, points.back().tau_s, least_shown(analysis, lowest)};
    figure.y.min = window.floor * shown.per_si;
    add_terms(channel, window, shown.per_si, figure);
  }
  figure.curves.push_back(std::move(curve));
  return figure;
}

Figure parts_figure(const ChannelNoise& channel) {
  const auto& parts = channel.analysis->parts;
  Curve level{"white noise of each part", {}, {}};
  Band band{.label = "95 % interval", .x = {}, .lower = {}, .upper = {}};
  for (const characterise::NoisePart& part : parts) {
    const characterise::Coefficient& white = part.model.white;
    for (const double at_s : {part.start_s, part.end_s}) {
      level.x.push_back(at_s);
      level.y.push_back(white.value);
      band.lower.push_back(white.lower_95);
      band.upper.push_back(white.upper_two_sided_95);
    }
  }
  const ShownUnit shown = shown_unit(channel.unit, NoiseScale::density, middle(level.y));
  for (auto* values : {&level.y, &band.lower, &band.upper}) {
    for (double& value : *values) value *= shown.per_si;
  }
  band.x = level.x;
  return {.title = channel.name + ": white noise over time",
          .description = "N of each part of the recording, with its 95 % interval.",
          .x = {.label = "Time (s)"},
          .y = {.label = "N (" + shown.symbol + ")"},
          .bands = {std::move(band)},
          .curves = {std::move(level)}};
}

Figure spectrum_figure(const ChannelNoise& channel) {
  const NoiseAnalysis& analysis = *channel.analysis;
  const signal::Spectrum& spectrum = analysis.spectrum;
  Curve curve{"spectrum", {}, {}};
  Curve fitted{"fitted density, without lines", {}, {}, Ink::orange};
  // The first and last bins are half as wide, so their densities are not comparable.
  for (std::size_t k = 1; k + 1 < spectrum.frequency_hz.size(); ++k) {
    curve.x.push_back(spectrum.frequency_hz[k]);
    curve.y.push_back(std::sqrt(spectrum.one_sided_psd[k]));
    fitted.y.push_back(std::sqrt(2.0 * analysis.model.density(spectrum.frequency_hz[k])));
  }
  fitted.x = curve.x;
  const ShownUnit shown = shown_unit(channel.unit, NoiseScale::density, middle(curve.y));
  for (auto* values : {&curve.y, &fitted.y}) {
    for (double& value : *values) value *= shown.per_si;
  }
  Figure figure{.title = channel.name + ": spectrum",
                .description = fmt::format(
                    "One-sided density as in data sheets, √2 N for white noise; mean over {} of {} "
                    "samples with a Hann window.",
                    count_words(spectrum.averaged, "segment"), grouped(spectrum.segment)),
                .x = {.label = "Frequency (Hz)", .scale = AxisScale::log},
                .y = {.label = "Density (" + shown.symbol + ")", .scale = AxisScale::log},
                .curves = {std::move(curve), std::move(fitted)},
                .height = 340.0};
  const signal::SpectralFloor& floor = analysis.lines.floor;
  if (floor.one_sided_density > 0.0) {
    figure.levels.push_back(
        {fmt::format("floor {}",
                     noise_words(floor.one_sided_density, channel.unit, NoiseScale::density)),
         floor.one_sided_density * shown.per_si});
  }
  name_lines(analysis, shown.per_si, figure);
  return figure;
}

}  // namespace proofmass::report
