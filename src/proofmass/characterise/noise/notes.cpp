#include "proofmass/characterise/noise/notes.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>

namespace proofmass::characterise {
namespace {

std::string counted(std::size_t n, const char* noun) {
  return n == 0 ? std::string() : fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

}  // namespace

void note_resolution(NoiseAnalysis& analysis, double spread) {
  if (!analysis.lsb) return;
  const double density = *analysis.lsb / std::sqrt(12.0 * analysis.rate_hz);
  const bool coarse = spread < 2.0 * *analysis.lsb;
  const double white = analysis.model.white.value;
  std::string text = fmt::format("the quantisation step is {:.2g} of the standard deviation",
                                 *analysis.lsb / spread);
  if (white > 0.0)
    text += fmt::format(": rounding alone has {:.0f} % of the density of the white noise",
                        100.0 * density / white);
  analysis.notes.push_back({coarse ? Severity::warning : Severity::info, std::move(text)});
}

void note_stationarity(NoiseAnalysis& analysis) {
  const Stationarity& found = analysis.stationarity;
  if (found.stationary) return;
  const auto [least, most] = std::ranges::minmax(found.relative_level);
  const std::string what =
      found.line_hz ? fmt::format("the line at {:.4g} Hz", *found.line_hz)
                    : fmt::format("the noise at averaging times near {:.2g} s", found.averaging_s);
  analysis.notes.push_back(
      {Severity::warning,
       fmt::format("not stationary: {} changes by a factor of {:.3g} over the recording (p = "
                   "{:.1g}): all figures are averages over it",
                   what, most / least, found.p)});
}

void note_events(NoiseAnalysis& analysis, bool excluded) {
  if (analysis.events.empty()) return;
  const auto steps = static_cast<std::size_t>(
      std::ranges::count(analysis.events, signal::EventKind::step, &signal::Event::kind));
  const std::size_t outliers = analysis.events.size() - steps;
  const std::string all = counted(outliers, "outlier") +
                          (outliers > 0 && steps > 0 ? " and " : "") + counted(steps, "step");
  if (excluded) {
    analysis.notes.push_back({Severity::warning, all + " excluded"});
    return;
  }
  const bool one = analysis.events.size() == 1;
  analysis.notes.push_back(
      {Severity::warning,
       fmt::format("{0} {1} included in the figures but {1} not noise of the sensor: exclude {2}",
                   all, one ? "is" : "are", one ? "it" : "them"),
       {Advice{"exclude-events"}}});
}

void note_missing(NoiseAnalysis& analysis, std::size_t left_out) {
  if (left_out > analysis.samples / 100)
    analysis.notes.push_back(
        {Severity::warning,
         fmt::format("this statistic needs an interval without gaps: {} of {} samples are excluded",
                     left_out, analysis.samples)});
  if (analysis.missing == 0) return;
  const double share =
      static_cast<double>(analysis.missing) / static_cast<double>(analysis.samples);
  analysis.notes.push_back(
      {share > 0.05 ? Severity::warning : Severity::info,
       fmt::format("{} of {} samples are missing: the deviation uses complete terms only",
                   analysis.missing, analysis.samples)});
}

void note_model(NoiseAnalysis& analysis) {
  const NoiseModelFit& model = analysis.model;
  if (model.ordinates == 0) {
    analysis.notes.push_back(
        {Severity::warning, "too short for coefficients: limits are those of white noise"});
    return;
  }
  if (model.misfit > 0.0)
    analysis.notes.push_back(
        {Severity::info, fmt::format("the spectrum differs from the model by {:.0f} % beyond its "
                                     "scatter; standard deviations are increased accordingly",
                                     100.0 * model.misfit)});
  if (model.slow_change) {
    analysis.notes.push_back(
        {Severity::warning,
         fmt::format("a slow change like a sine of {:.3g} s, of {:.3g} of its period within the "
                     "recording, {}",
                     model.slow_change->period_s, model.duration_s / model.slow_change->period_s,
                     model.slow_change->taken_out
                         ? "was removed: it is not noise but typical of temperature"
                         : "explains the recording as well as slow noise does: the intervals of "
                           "flicker noise and random walk therefore extend to zero")});
    if (!model.slow_change->taken_out) return;
  }
  const auto ambiguous = [](const Coefficient& c) {
    return c.verdict == Verdict::identified && c.lower_95 == 0.0;
  };
  if (ambiguous(model.random_walk) || ambiguous(model.flicker))
    analysis.notes.push_back(
        {Severity::warning,
         "there is slow noise, but this recording is too short to separate flicker from random "
         "walk: "
         "the simpler explanation is given, with an interval that extends to zero"});
}

}  // namespace proofmass::characterise
